#include "apps/mjarm/install/package_index.hpp"

#include <nlohmann/json.hpp>
#include <optional>

#include "mjarm/core/messages/install.hpp"

namespace mjarm::app {
namespace {

using Json = nlohmann::json;

constexpr const char* kAccept =
    "application/vnd.pypi.simple.v1+json, application/vnd.pypi.simple.v1+html;q=0.2, "
    "text/html;q=0.1";

std::string string_of(const Json& object, const char* key) {
  if (!object.is_object()) return {};
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

IndexEntry find_in_json(const Page& page, std::string_view file) {
  const Json document = Json::parse(page.body, nullptr, false);
  if (!document.is_object() || !document.contains("files")) return {};
  for (const Json& entry : document["files"]) {
    if (string_of(entry, "filename") != file) continue;
    const std::string hash =
        entry.contains("hashes") ? string_of(entry["hashes"], "sha256") : std::string();
    return {resolve_link(page.url, string_of(entry, "url")), hash};
  }
  return {};
}

/// The value of the `href` that stands next at or after `at`; moves `at` behind it.
std::optional<std::string> next_link(std::string_view html, std::size_t& at) {
  at = html.find("href=", at);
  if (at == std::string_view::npos || at + 6 > html.size()) return std::nullopt;
  at += 5;
  const char quote = html[at];
  if (quote != '"' && quote != '\'') return std::string();
  const std::size_t end = html.find(quote, at + 1);
  if (end == std::string_view::npos) return std::nullopt;
  std::string link(html.substr(at + 1, end - at - 1));
  at = end + 1;
  for (std::size_t i = 0; (i = link.find("&amp;", i)) != std::string::npos; ++i) {
    link.erase(i + 1, 4);
  }
  return link;
}

IndexEntry find_in_html(const Page& page, std::string_view file) {
  std::size_t at = 0;
  while (std::optional<std::string> link = next_link(page.body, at)) {
    const std::size_t hash_mark = std::min(link->find('#'), link->size());
    const std::string fragment = link->substr(hash_mark);
    link->resize(hash_mark);
    const std::string path = link->substr(0, link->find('?'));
    if (path.substr(path.rfind('/') + 1) != file) continue;  // npos + 1 = 0: the whole of it
    constexpr std::string_view kHash = "#sha256=";
    const bool hashed = fragment.starts_with(kHash);
    return {resolve_link(page.url, *link), hashed ? fragment.substr(kHash.size()) : std::string()};
  }
  return {};
}

}  // namespace

IndexEntry find_entry(const Page& page, std::string_view file) {
  const std::size_t first = page.body.find_first_not_of(" \t\r\n");
  const bool json = first != std::string::npos && page.body[first] == '{';
  return json ? find_in_json(page, file) : find_in_html(page, file);
}

Result<std::string> find_in_index(const IndexSettings& index, const std::string& project,
                                  const std::string& file, const std::string& sha256) {
  const Result<Page> page = get_page(index.url + "/" + project + "/", kAccept, index.http);
  if (!page) return fail(page.error());
  const IndexEntry entry = find_entry(*page, file);
  const std::string shown = without_password(page->url);
  if (entry.url.empty()) {
    return fail(Errc::not_available, text(msg::install_not_in_index, shown, file));
  }
  if (!entry.sha256.empty() && entry.sha256 != sha256) {
    return fail(Errc::not_available, text(msg::install_other_hash, shown, file, sha256));
  }
  return entry.url;
}

}  // namespace mjarm::app
