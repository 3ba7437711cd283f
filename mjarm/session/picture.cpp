#include "mjarm/session/picture.hpp"

#include <algorithm>

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

Result<std::string> write_picture(render::OffscreenRenderer& renderer,
                                  const PictureOptions& options, const Snapshot& snapshot,
                                  const render::Camera& camera, const render::Overlay& overlay) {
  Result<render::Image> image = renderer.draw(snapshot, camera, overlay);
  if (!image) return fail(image.error());
  (void)render::add_legend(*image, options.legend);
  if (Result<void> written = render::write_png(*image, options.out); !written) {
    return fail(std::move(written.error()));
  }
  return text(msg::show_picture, options.out.string(), image->width, image->height);
}

}  // namespace mjarm::session
