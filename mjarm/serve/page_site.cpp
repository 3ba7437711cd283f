#include "mjarm/serve/page_site.hpp"

#include <algorithm>
#include <cctype>
#include <system_error>

#include "mjarm/core/file.hpp"
#include "mjarm/core/messages/serve.hpp"
#include "mjarm/core/os_random.hpp"
#include "mjarm/core/sha256.hpp"
#include "mjarm/core/share.hpp"

namespace mjarm::serve {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxPageFile = std::size_t{32} << 20;  // [bytes]
constexpr std::size_t kMaxHost = 80;
constexpr const char* kAskAgain = "no-cache";
/// The address of a mesh holds the token, which no other run has.
constexpr const char* kKeep = "private, max-age=86400, immutable";
constexpr const char* kPlain = "text/plain; charset=utf-8";

struct PageFile {
  const char* name;
  const char* type;
};
constexpr PageFile kPageFiles[] = {
    {"index.html", "text/html; charset=utf-8"},
    {"page.js", "text/javascript; charset=utf-8"},
    {"page.css", "text/css; charset=utf-8"},
};

bool only_has(std::string_view word, std::string_view letters) {
  return !word.empty() && word.find_first_not_of(letters) == std::string_view::npos;
}

/// A numeric address as a browser writes it in `Host`.
bool is_number_address(std::string_view name) {
  if (name.starts_with('[') && name.ends_with(']')) {
    return only_has(name.substr(1, name.size() - 2), "0123456789abcdefABCDEF:.");
  }
  return only_has(name, "0123456789.") && std::ranges::count(name, '.') == 3;
}

/// Entries of a header that is a list.
bool lists(std::string_view header, std::string_view etag) {
  if (header == "*") return true;
  for (std::size_t at = header.find(etag); at != std::string_view::npos;
       at = header.find(etag, at + 1)) {
    const std::size_t end = at + etag.size();
    if (end == header.size() || header[end] == ',' || header[end] == ' ') return true;
  }
  return false;
}

std::string in_brackets(const std::string& address) {
  return address.find(':') == std::string::npos ? address : "[" + address + "]";
}

/// What a browser may do with the page: nothing but ask this server.
std::vector<std::pair<std::string, std::string>> common_headers(std::string_view host, int port) {
  const std::string end = ":" + std::to_string(port);
  std::string sockets = "ws://127.0.0.1" + end + " ws://localhost" + end;
  if (sockets.find("ws://" + std::string(host)) == std::string::npos) {
    sockets += " ws://" + std::string(host);
  }
  return {
      {"Content-Security-Policy",
       "default-src 'self'; connect-src 'self' " + sockets +
           "; img-src 'self' blob: data:; style-src 'self'; object-src 'none'; base-uri 'none'; "
           "frame-ancestors 'none'"},
      {"X-Content-Type-Options", "nosniff"},
      {"Referrer-Policy", "no-referrer"},
      {"Cross-Origin-Resource-Policy", "same-origin"},
  };
}

}  // namespace

bool is_loopback(std::string_view address) noexcept {
  return address == "::1" || (address.starts_with("127.") && is_number_address(address));
}

std::optional<fs::path> page_folder() {
  for (const fs::path& folder : share_folders()) {
    std::error_code ignored;
    if (fs::is_regular_file(folder / "page" / "index.html", ignored)) return folder / "page";
  }
  return std::nullopt;
}

PageSite::PageSite(std::string token, std::string address)
    : token_(std::move(token)), address_(std::move(address)) {}

void PageSite::add(const std::string& path, std::string body, const char* type, const char* cache) {
  std::string etag = "\"" + sha256(body).substr(0, 32) + "\"";
  files_[path] = {std::make_shared<const std::string>(std::move(body)), type, std::move(etag),
                  cache};
}

bool PageSite::add_page(const fs::path& folder) {
  bool whole = !folder.empty();
  for (const PageFile& file : kPageFiles) {
    if (folder.empty()) break;
    Result<std::string> body = read_file(folder / file.name, kMaxPageFile);
    if (!body) {
      whole = whole && file.name == std::string_view("page.css");
      continue;
    }
    if (file.name == std::string_view("index.html")) add("", *body, file.type, kAskAgain);
    add(file.name, std::move(*body), file.type, kAskAgain);
  }
  if (!whole) add("", text(msg::serve_no_page) + "\n", kPlain, kAskAgain);
  return whole;
}

void PageSite::add_run(std::string html) {
  add("", std::move(html), kPageFiles[0].type, kAskAgain);
  files_[""].has_policy = true;
}

void PageSite::add_scene(const DrawnModel& model, const SceneFacts& facts) {
  lives_ = true;
  add("scene.json", scene_json(model, facts), "application/json", kAskAgain);
  for (std::size_t i = 0; i < model.meshes.size(); ++i) {
    add("mesh/" + std::to_string(i), mesh_bytes(model.meshes[i]), "application/octet-stream",
        kKeep);
  }
}

std::string PageSite::url() const {
  const bool everywhere = address_ == "0.0.0.0" || address_ == "::";
  return "http://" + in_brackets(everywhere ? "127.0.0.1" : address_) + ":" +
         std::to_string(port_) + "/" + token_ + "/";
}

bool PageSite::is_host(std::string_view host) const {
  if (host.empty() || host.size() > kMaxHost) return false;
  const std::string end = ":" + std::to_string(port_);
  std::string_view name = host;
  if (name.ends_with(end)) {
    name.remove_suffix(end.size());
  } else if (port_ != 80) {  // which a browser leaves out
    return false;
  }
  if (name == "localhost" || name == "127.0.0.1") return true;
  if (name == in_brackets(address_)) return is_number_address(name);
  return !is_loopback(address_) && is_number_address(name);
}

SiteAnswer PageSite::say(int status, std::string_view line, std::string_view host) const {
  SiteAnswer out{.status = status,
                 .headers = common_headers(host, port_),
                 .body = std::make_shared<const std::string>(std::string(line) + "\n")};
  out.headers.emplace_back("Content-Type", kPlain);
  out.headers.emplace_back("Cache-Control", "no-store");
  if (status == 405) out.headers.emplace_back("Allow", "GET, HEAD");
  return out;
}

SiteAnswer PageSite::refusal(int status) const {
  if (status == 503) return say(status, text(msg::serve_too_many), "localhost");
  return say(status, status == 431 ? "Request header too large" : "Bad request", "localhost");
}

SiteAnswer PageSite::answer_found(const SiteRequest& request, const File& file) const {
  SiteAnswer out{.headers = common_headers(request.host, port_), .body = file.body};
  if (file.has_policy) out.headers.front().second = "frame-ancestors 'none'";
  out.headers.emplace_back("ETag", file.etag);
  out.headers.emplace_back("Cache-Control", file.cache);
  out.headers.emplace_back("Content-Type", file.type);
  if (lists(request.if_none_match, file.etag)) {
    out.status = 304;
    out.body = std::make_shared<const std::string>();
  }
  return out;
}

SiteAnswer PageSite::answer(const SiteRequest& request) const {
  // Without the right name of this machine the page of somebody else may be asking, through a name
  // that leads here.
  if (!is_host(request.host)) return say(403, "Forbidden: Host", "localhost");
  if (request.origin && *request.origin != "http://" + std::string(request.host)) {
    return say(403, "Forbidden: Origin", request.host);
  }
  std::string_view path = request.target.substr(0, request.target.find('?'));
  const std::string_view::size_type end = path.find('/', 1);
  if (!path.starts_with('/') || end == std::string_view::npos ||
      !equal_in_constant_time(path.substr(1, end - 1), token_)) {
    return say(404, "Not found", request.host);
  }
  path.remove_prefix(end + 1);
  const auto file = files_.find(path);
  const bool is_live = lives_ && path == "live";
  if (!is_live && file == files_.end()) return say(404, "Not found", request.host);
  if (request.method != "GET" && (request.method != "HEAD" || is_live)) {
    return say(405, "Method not allowed", request.host);
  }
  if (!is_live) return answer_found(request, file->second);
  if (!request.upgrade) return say(426, "Upgrade required: WebSocket", request.host);
  SiteAnswer out = say(101, "", request.host);
  out.is_live = true;
  return out;
}

}  // namespace mjarm::serve
