#include "mjarm/session/picture.hpp"

#include <algorithm>
#include <cstddef>

#include "mjarm/core/messages/show.hpp"
#include "mjarm/render/png.hpp"

namespace mjarm::session {

render::OffscreenOptions offscreen_options(const PictureOptions& options) {
  render::OffscreenOptions out{.width = options.width, .height = options.height};
  if (options.quality) {
    out.quality = *options.quality;
  } else if (options.video) {
    out.software_quality = render::RenderQuality::low;
  }
  if (!options.video && out.quality == render::RenderQuality::high) out.supersampling = 2;
  return out;
}

render::Camera default_camera(const Model& model) {
  constexpr const char* kName = "overview";
  render::Camera camera;
  if (std::ranges::count(render::camera_names(model), kName) > 0) camera.name = kName;
  return camera;
}

render::Image strip_of(const std::vector<render::Image>& pictures) {
  constexpr std::size_t kMostInRow = 4;
  constexpr std::size_t kGap = 4;  // [px] white between them
  if (pictures.empty()) return {};
  const std::size_t count = pictures.size();
  const std::size_t columns = count <= kMostInRow ? count : (count + 1) / 2;
  const std::size_t rows = (count + columns - 1) / columns;
  const auto width = static_cast<std::size_t>(pictures.front().width);
  const auto height = static_cast<std::size_t>(pictures.front().height);
  const std::size_t across = columns * (width + kGap) - kGap;
  const std::size_t down = rows * (height + kGap) - kGap;
  render::Image out{.width = static_cast<int>(across),
                    .height = static_cast<int>(down),
                    .rgb = std::vector<std::uint8_t>(3 * across * down, 255)};
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t left = i % columns * (width + kGap);
    const std::size_t top = i / columns * (height + kGap);
    for (std::size_t y = 0; y < height; ++y) {
      const auto from = pictures[i].rgb.begin() + static_cast<std::ptrdiff_t>(3 * y * width);
      const std::size_t to = 3 * ((top + y) * across + left);
      std::copy_n(from, 3 * width, out.rgb.begin() + static_cast<std::ptrdiff_t>(to));
    }
  }
  return out;
}

Result<std::string> write_image(render::Image image, const PictureOptions& options) {
  (void)render::add_legend(image, options.legend);
  if (Result<void> written = render::write_png(image, options.out); !written) {
    return fail(std::move(written.error()));
  }
  return text(msg::show_picture, options.out.string(), image.width, image.height);
}

Result<std::string> write_picture(render::OffscreenRenderer& renderer,
                                  const PictureOptions& options, const Snapshot& snapshot,
                                  const render::Camera& camera, const render::Overlay& overlay) {
  Result<render::Image> image = renderer.draw(snapshot, camera, overlay);
  if (!image) return fail(image.error());
  return write_image(std::move(*image), options);
}

}  // namespace mjarm::session
