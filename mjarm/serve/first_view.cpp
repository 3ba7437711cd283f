#include "mjarm/render/scene.hpp"
#include "mjarm/serve/first_view_internal.hpp"

namespace mjarm::serve {

Result<render::CameraView> first_view(const Model& model, const render::Camera& camera) {
  if (camera.view) return *camera.view;
  if (camera.name.empty()) return render::default_view(model);
  render::Scene scene(model, render::RenderQuality::low);
  if (Result<void> set = scene.set_camera(camera); !set) return fail(std::move(set.error()));
  return scene.view();
}

}  // namespace mjarm::serve
