#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "mjarm/core/result.hpp"

namespace mjarm::install {

/// How to reach servers. Proxies come from the environment (`https_proxy`, `no_proxy`, ...) as
/// well.
struct HttpOptions {
  std::string ca_bundle;      ///< file or folder of certificates; empty = the system's
  std::string proxy;          ///< empty = as the environment says
  long connect_timeout = 10;  ///< [s] until a server answers, > 0
  long stall_timeout = 30;    ///< [s] without a single byte, > 0
  int idle_attempts = 2;      ///< tries in a row that bring nothing before it is given up, > 0
};

/// Bytes from `from` up to, but not including, `to`.
struct ByteRange {
  std::uint64_t from = 0;
  std::uint64_t to = 0;  ///< > from
  [[nodiscard]] std::uint64_t size() const { return to - from; }
};

/// Appends to `file` what it lacks of the bytes `range` of `url` (http, https or file). What is in
/// `file` already is believed, so an interrupted download goes on where it was; the caller checks a
/// hash. A server that knows no ranges is read from its beginning.
/// @param label  what the progress bar says.
/// @return one line that names the address, without any password in it.
[[nodiscard]] Result<void> download(const std::string& url, ByteRange range,
                                    const std::filesystem::path& file, const std::string& label,
                                    const HttpOptions& options);

/// A page, and the address it came from in the end.
struct Page {
  std::string url;
  std::string body;
};

/// A whole page of at most 64 MB.
[[nodiscard]] Result<Page> get_page(const std::string& url, const HttpOptions& options);

/// The address that `link` means on the page `base`; empty where it is none.
[[nodiscard]] std::string resolve_link(const std::string& base, const std::string& link);

/// `url` without user name and password.
[[nodiscard]] std::string without_password(const std::string& url);

/// Address of a file of this machine.
[[nodiscard]] std::string file_url(const std::filesystem::path& file);

}  // namespace mjarm::install
