#include "mjarm/install/http.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <thread>

#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/install.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/os_file.hpp"
#include "mjarm/core/progress.hpp"
#include "mjarm/install/curl_internal.hpp"

namespace mjarm::install {
namespace {

constexpr std::uint64_t kLargestPage = std::uint64_t{64} << 20;
constexpr int kMaxAttempts = 200;
constexpr std::uint64_t kWorthSaying = 4'000'000;  // bytes to be read past

struct FreeHandle {
  const Curl* curl;
  void operator()(CURL* handle) const { curl->easy_cleanup(handle); }
};
struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using Handle = std::unique_ptr<CURL, FreeHandle>;

/// An address in its parts; without libcurl an empty one.
class Url {
 public:
  explicit Url(const std::string& text) { set(CURLUPART_URL, text.c_str()); }
  ~Url() {
    if (curl_) (*curl_)->url_cleanup(url_);
  }
  Url(const Url&) = delete;
  Url& operator=(const Url&) = delete;

  bool set(CURLUPart part, const char* value, unsigned flags = 0) {
    return curl_ && (*curl_)->url_set(url_, part, value, flags) == CURLUE_OK;
  }
  /// Empty where it is none.
  [[nodiscard]] std::string whole() const {
    char* text = nullptr;
    if (!curl_ || (*curl_)->url_get(url_, CURLUPART_URL, &text, 0) != CURLUE_OK) return {};
    std::string out = text;
    (*curl_)->free(text);
    return out;
  }

 private:
  Result<const Curl*> curl_ = curl();
  CURLU* url_ = curl_ ? (*curl_)->url() : nullptr;
};

/// One request in progress, as the callbacks of curl see it.
struct Transfer {
  const Curl* curl = nullptr;
  CURL* handle = nullptr;
  std::uint64_t from = 0;                      ///< first byte that was asked for
  std::uint64_t left = 0;                      ///< bytes still wanted
  std::function<bool(std::string_view)> take;  ///< false ends the transfer
  std::optional<std::uint64_t> skip;           ///< bytes before `from` still to come
};

/// What a request came to.
struct Outcome {
  std::optional<Error> error;
  bool worth_retrying = false;
};

std::size_t on_body(char* data, std::size_t, std::size_t size, void* user) {
  auto& transfer = *static_cast<Transfer*>(user);
  if (!transfer.skip) {  // a server that knows no ranges sends everything
    long status = 0;
    transfer.curl->easy_getinfo(transfer.handle, CURLINFO_RESPONSE_CODE, &status);
    transfer.skip = status == 200 ? transfer.from : 0;
    if (*transfer.skip >= kWorthSaying)
      log_info(text(msg::install_no_ranges, *transfer.skip / 1000000));
  }
  std::string_view piece(data, size);
  const auto skipped = static_cast<std::size_t>(std::min<std::uint64_t>(*transfer.skip, size));
  *transfer.skip -= skipped;
  piece.remove_prefix(skipped);
  piece = piece.substr(0, std::min<std::uint64_t>(piece.size(), transfer.left));
  if (!piece.empty() && !transfer.take(piece)) return 0;
  transfer.left -= piece.size();
  return transfer.left == 0 ? 0 : size;  // whatever comes after the range is not read
}

int on_progress(void*, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
  return interrupted() ? 1 : 0;
}

void apply(const Curl& curl, CURL* handle, const HttpOptions& options) {
  const auto set = [&](CURLoption option, auto value) { curl.easy_setopt(handle, option, value); };
  set(CURLOPT_USERAGENT, "mjarm/" MJARM_VERSION);
  set(CURLOPT_NOSIGNAL, 1L);
  set(CURLOPT_FAILONERROR, 1L);
  set(CURLOPT_FOLLOWLOCATION, 1L);
  set(CURLOPT_MAXREDIRS, 10L);
  set(CURLOPT_PROTOCOLS_STR, "http,https,file");
  set(CURLOPT_REDIR_PROTOCOLS_STR, "http,https");
  set(CURLOPT_NETRC, static_cast<long>(CURL_NETRC_OPTIONAL));
  set(CURLOPT_CONNECTTIMEOUT, options.connect_timeout);
  set(CURLOPT_LOW_SPEED_LIMIT, 1L);
  set(CURLOPT_LOW_SPEED_TIME, options.stall_timeout);
  set(CURLOPT_NOPROGRESS, 0L);
  set(CURLOPT_XFERINFOFUNCTION, on_progress);
  if (!options.proxy.empty()) set(CURLOPT_PROXY, options.proxy.c_str());
  if (options.ca_bundle.empty()) return;
  std::error_code ignored;
  const bool folder = std::filesystem::is_directory(options.ca_bundle, ignored);
  set(folder ? CURLOPT_CAPATH : CURLOPT_CAINFO, options.ca_bundle.c_str());
}

/// A broken or slow connection may do better next time; what the server or the machine refuses
/// stays refused.
bool may_pass(CURLcode code, long status) {
  switch (code) {
    case CURLE_HTTP_RETURNED_ERROR:
      return status >= 500;
    case CURLE_PARTIAL_FILE:
    case CURLE_RECV_ERROR:
    case CURLE_SEND_ERROR:
    case CURLE_GOT_NOTHING:
    case CURLE_HTTP2:
    case CURLE_HTTP2_STREAM:
      return true;
    case CURLE_OPERATION_TIMEDOUT:
      return status != 0;  // it had begun to answer
    default:
      return false;
  }
}

Outcome explain(const Transfer& transfer, const std::string& url, CURLcode code,
                const char* detail) {
  const bool enough = code == CURLE_WRITE_ERROR && transfer.left == 0;
  if (code == CURLE_OK || enough) return {};
  if (code == CURLE_ABORTED_BY_CALLBACK && interrupted()) {
    return {.error = Error{Errc::impossible, text(msg::install_interrupted)}};
  }
  long status = 0;
  transfer.curl->easy_getinfo(transfer.handle, CURLINFO_RESPONSE_CODE, &status);
  std::string reason = *detail == '\0' ? transfer.curl->easy_strerror(code) : detail;
  if (code == CURLE_HTTP_RETURNED_ERROR) reason = "HTTP " + std::to_string(status);
  return {.error = Error{Errc::not_available,
                         text(msg::install_cannot_fetch, without_password(url), reason)},
          .worth_retrying = may_pass(code, status)};
}

struct Request {
  const std::string& url;
  ByteRange range;
  bool whole = false;  ///< everything, whatever its size, but no more than `range`
  std::function<bool(std::string_view)> take;
};

Outcome perform(const Request& request, const HttpOptions& options, std::string* final_url) {
  const Result<const Curl*> library = curl();
  if (!library) return {.error = library.error()};
  const Curl& curl = **library;
  const Handle handle(curl.easy_init(), {&curl});
  if (!handle) {
    return {.error = Error{Errc::system, text(msg::install_cannot_fetch, request.url, "libcurl")}};
  }
  Transfer transfer{.curl = &curl,
                    .handle = handle.get(),
                    .from = request.range.from,
                    .left = request.range.size(),
                    .take = request.take,
                    .skip = {}};
  char detail[CURL_ERROR_SIZE] = "";
  apply(curl, handle.get(), options);
  const auto set = [&](CURLoption option, auto value) {
    curl.easy_setopt(handle.get(), option, value);
  };
  set(CURLOPT_ERRORBUFFER, static_cast<char*>(detail));
  set(CURLOPT_URL, request.url.c_str());
  set(CURLOPT_WRITEFUNCTION, on_body);
  set(CURLOPT_WRITEDATA, &transfer);
  const std::string range =
      std::to_string(request.range.from) + "-" + std::to_string(request.range.to - 1);
  if (!request.whole) set(CURLOPT_RANGE, range.c_str());
  const CURLcode code = curl.easy_perform(handle.get());
  char* effective = nullptr;
  curl.easy_getinfo(handle.get(), CURLINFO_EFFECTIVE_URL, &effective);
  if (final_url != nullptr && effective != nullptr) *final_url = effective;
  return explain(transfer, request.url, code, detail);
}

std::uint64_t size_of(const std::filesystem::path& file) {
  std::error_code code;
  const std::uintmax_t size = std::filesystem::file_size(file, code);
  return code ? 0 : size;
}

/// One try to append the rest of `range` to `file`.
Outcome append_rest(const std::string& url, ByteRange range, const std::filesystem::path& file,
                    const HttpOptions& options, Progress& progress) {
  const std::unique_ptr<std::FILE, CloseFile> stream(open_file(file, "ab"));
  std::optional<Error> refused;
  const auto refuse = [&](int code) {
    refused =
        Error{Errc::system, text(msg::core_cannot_write, file.string(), system_message(code))};
    return false;
  };
  if (!stream) {
    refuse(errno);
    return {.error = refused};
  }
  // What has arrived must be in the file even if this process is killed.
  std::setvbuf(stream.get(), nullptr, _IONBF, 0);
  std::uint64_t have = size_of(file);
  const auto take = [&](std::string_view piece) {
    if (std::fwrite(piece.data(), 1, piece.size(), stream.get()) != piece.size()) {
      return refuse(errno);
    }
    progress.advance((have + piece.size()) / 1000 - have / 1000);
    have += piece.size();
    return true;
  };
  Outcome outcome =
      perform({.url = url, .range = {range.from + have, range.to}, .take = take}, options, nullptr);
  if (refused) return {.error = refused};
  return outcome;
}

}  // namespace

Result<void> download(const std::string& url, ByteRange range, const std::filesystem::path& file,
                      const std::string& label, const HttpOptions& options) {
  if (size_of(file) > range.size()) {
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
  }
  Progress progress(label, range.size() / 1000);
  progress.advance(size_of(file) / 1000);
  int idle = 0;
  for (int attempt = 0; attempt < kMaxAttempts; ++attempt) {
    const std::uint64_t before = size_of(file);
    if (before == range.size()) return {};
    const Outcome outcome = append_rest(url, range, file, options, progress);
    if (outcome.error && !outcome.worth_retrying) return fail(*outcome.error);
    const std::uint64_t after = size_of(file);
    idle = after > before ? 0 : idle + 1;
    if (idle >= options.idle_attempts) {
      if (outcome.error) return fail(*outcome.error);
      break;
    }
    if (after < range.size()) std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  if (size_of(file) == range.size()) return {};
  return fail(Errc::not_available,
              text(msg::install_short, without_password(url), size_of(file), range.size()));
}

Result<Page> get_page(const std::string& url, const HttpOptions& options) {
  Page page;
  for (int attempt = 1;; ++attempt) {
    page.body.clear();
    const auto take = [&](std::string_view piece) {
      page.body += piece;
      return true;
    };
    const Outcome outcome = perform(
        {.url = url, .range = {0, kLargestPage}, .whole = true, .take = take}, options, &page.url);
    if (!outcome.error) return page;
    if (!outcome.worth_retrying || attempt >= options.idle_attempts) return fail(*outcome.error);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
}

std::string resolve_link(const std::string& base, const std::string& link) {
  Url url(base);
  return url.set(CURLUPART_URL, link.c_str()) ? url.whole() : std::string();
}

std::string without_password(const std::string& text) {
  Url url(text);
  for (const CURLUPart part : {CURLUPART_USER, CURLUPART_PASSWORD, CURLUPART_OPTIONS}) {
    url.set(part, nullptr);
  }
  const std::string shown = url.whole();
  return shown.empty() ? text : shown;
}

std::string file_url(const std::filesystem::path& file) {
  Url url("file:///");
  url.set(CURLUPART_PATH, std::filesystem::absolute(file).generic_string().c_str(),
          CURLU_URLENCODE);
  return url.whole();
}

}  // namespace mjarm::install
