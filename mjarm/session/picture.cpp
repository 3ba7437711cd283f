#include "mjarm/session/picture.hpp"

#include <algorithm>

#include "mjarm/core/messages/show.hpp"
#include "mjarm/render/png.hpp"

namespace mjarm::session {

OffscreenOptions offscreen_options(const PictureOptions& options) {
  OffscreenOptions out{.width = options.width, .height = options.height};
  if (options.quality) {
    out.quality = *options.quality;
  } else if (options.video) {
    out.software_quality = RenderQuality::low;
  }
  return out;
}

Camera default_camera(const Model& model) {
  Camera camera;
  if (std::ranges::count(camera_names(model), "overview") > 0) camera.name = "overview";
  return camera;
}

Result<std::string> write_picture(OffscreenRenderer& renderer, const PictureOptions& options,
                                  const Snapshot& snapshot, const Camera& camera,
                                  const Overlay& overlay) {
  const Result<Image> image = renderer.draw(snapshot, camera, overlay);
  if (!image) return fail(image.error());
  if (Result<void> written = write_png(*image, options.out); !written) {
    return fail(std::move(written.error()));
  }
  return text(msg::show_picture, options.out.string(), image->width, image->height);
}

}  // namespace mjarm::session
