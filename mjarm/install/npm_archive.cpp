#include <zlib.h>

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

std::string gunzipped(std::string_view packed, std::size_t most) {
  z_stream stream{};
  if (inflateInit2(&stream, 16 + MAX_WBITS) != Z_OK) return {};
  // zlib does not change what it reads.
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  std::string content;
  int state = Z_OK;
  while (state == Z_OK && content.size() < most) {
    const std::size_t done = content.size();
    content.resize(std::min(most, std::max<std::size_t>(2 * done, std::size_t{1} << 20)));
    stream.next_out = reinterpret_cast<Bytef*>(content.data() + done);
    stream.avail_out = static_cast<uInt>(content.size() - done);
    state = inflate(&stream, Z_NO_FLUSH);
    content.resize(content.size() - stream.avail_out);
  }
  inflateEnd(&stream);
  return state == Z_STREAM_END ? content : std::string();
}

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
