#include "python/src/images.hpp"

#include <cstdint>
#include <string>
#include <utility>

#include "mjarm/core/file.hpp"
#include "mjarm/render/png.hpp"
#include "python/src/convert.hpp"

namespace mjarm::python {
namespace {

constexpr const char* kImageShape = "(height, width, 3)";

}  // namespace

render::Image image_of(nb::handle value, const char* name) {
  using Pixels = View<const std::uint8_t>;
  std::optional<Pixels> given = Pixels::of(value);
  if (!given) given = Pixels::of(nb::module_::import_("numpy").attr("ascontiguousarray")(value));
  if (!given) refuse(msg::python_image, name, kImageShape);
  const Pixels& pixels = *given;
  constexpr std::size_t kMost = 16384;  // [px]
  if (pixels.ndim() != 3 || pixels.shape(2) != 3 || pixels.size() == 0 || pixels.shape(0) > kMost ||
      pixels.shape(1) > kMost) {
    refuse(msg::python_image, name, kImageShape);
  }
  return {.width = static_cast<int>(pixels.shape(1)),
          .height = static_cast<int>(pixels.shape(0)),
          .rgb = {pixels.data(), pixels.data() + pixels.size()}};
}

nb::object array_of(const render::Image& image) {
  return array<std::uint8_t>(image.rgb, {static_cast<std::size_t>(image.height),
                                         static_cast<std::size_t>(image.width), 3});
}

void check_pixels(int width, int height) {
  if (width < 1 || height < 1 || width > 8192 || height > 8192) refuse(msg::python_pixels);
}

nb::object give(const render::Image& image, const std::optional<std::filesystem::path>& file) {
  if (!file) return png_of(image);
  if (file->extension() != ".png") refuse(msg::python_extension, "file", ".png");
  value_of(render::write_png(image, *file));
  return nb::none();
}

nb::object give(const render::Plot& page, const std::optional<std::filesystem::path>& file) {
  if (file && file->extension() != ".svg" && file->extension() != ".png") {
    refuse(msg::python_extension, "file", ".png, .svg");
  }
  if (!file || file->extension() == ".png") return give(value_of(render::plot_image(page)), file);
  value_of(render::plot_svg(page).and_then(
      [&](const std::string& svg) { return write_file(*file, svg); }));
  return nb::none();
}

nb::bytes png_of(const render::Image& image) {
  const std::string png = value_of(render::encode_png(image));
  return nb::bytes(png.data(), png.size());
}

}  // namespace mjarm::python
