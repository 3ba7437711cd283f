#include <algorithm>
#include <charconv>

#include "mjarm/install/npm_archive_internal.hpp"

namespace mjarm::install {
namespace {

/// Of a field of a fixed width, up to its first zero byte.
std::string_view field(std::string_view header, std::size_t at, std::size_t width) {
  const std::string_view whole = header.substr(at, width);
  return whole.substr(0, whole.find('\0'));
}

}  // namespace

void for_each_file(
    std::string_view tar,
    const std::function<void(std::string_view name, std::string_view content)>& take) {
  constexpr std::size_t kBlock = 512, kName = 100, kSizeAt = 124, kSize = 12, kTypeAt = 156;
  while (tar.size() >= kBlock) {
    const std::string_view name = field(tar, 0, kName), digits = field(tar, kSizeAt, kSize);
    std::size_t size = 0;
    const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), size, 8);
    if (name.empty() || read.ec != std::errc{} || size > tar.size() - kBlock) return;
    if (tar[kTypeAt] == '0') take(name, tar.substr(kBlock, size));
    tar.remove_prefix(std::min(tar.size(), kBlock + (size + kBlock - 1) / kBlock * kBlock));
  }
}

}  // namespace mjarm::install
