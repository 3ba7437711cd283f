#include "mjarm/render/png.hpp"

#include <png.h>

#include "mjarm/core/file.hpp"
#include "mjarm/core/messages/render.hpp"

namespace mjarm::render {

Result<std::string> encode_png(const Image& image) {
  const auto needed = image.width > 0 && image.height > 0
                          ? 3 * static_cast<std::size_t>(image.width) * image.height
                          : std::size_t{0};
  if (needed == 0 || image.rgb.size() != needed) {
    return fail(Errc::bad_input,
                text(msg::render_bad_image, image.width, image.height, needed, image.rgb.size()));
  }
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = PNG_FORMAT_RGB;
  // Asked without memory, libpng tells the size; an upper bound saves compressing twice.
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&header, bytes.data(), &size, 0, image.rgb.data(), 0, nullptr) ==
      0) {
    return fail(Errc::system, text(msg::render_png_failed, header.message));
  }
  bytes.resize(size);
  return bytes;
}

Result<void> write_png(const Image& image, const std::filesystem::path& path) {
  const Result<std::string> bytes = encode_png(image);
  if (!bytes) return fail(bytes.error());
  return write_file(path, *bytes);
}

}  // namespace mjarm::render
