#include <zlib.h>

#include <algorithm>

#include "mjarm/install/inflate_internal.hpp"

namespace mjarm::install {

std::string inflated(std::string_view packed, Packing packing, std::size_t most) {
  z_stream stream{};
  const int window = packing == Packing::gzip ? 16 + MAX_WBITS : -MAX_WBITS;
  if (inflateInit2(&stream, window) != Z_OK) return {};
  // zlib does not change what it reads.
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  std::string content;
  int state = Z_OK;
  // Room for one more byte, so that the end is seen of what fills all there may be.
  while (state == Z_OK && content.size() <= most) {
    const std::size_t done = content.size();
    content.resize(std::min(most + 1, std::max<std::size_t>(2 * done, std::size_t{1} << 20)));
    stream.next_out = reinterpret_cast<Bytef*>(content.data() + done);
    stream.avail_out = static_cast<uInt>(content.size() - done);
    state = inflate(&stream, Z_NO_FLUSH);
    content.resize(content.size() - stream.avail_out);
  }
  inflateEnd(&stream);
  return state == Z_STREAM_END && content.size() <= most ? content : std::string();
}

}  // namespace mjarm::install
