#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>

#include "mjarm/view/camera_control_internal.hpp"

namespace mjarm::view {
namespace {

constexpr double kDegPerHeight = 180;  // a drag over the height of the view turns this far
constexpr double kZoomPerNotch = 0.1;

}  // namespace

void CameraControl::begin() {
  first_ = scene_.view();
  to_first_view();
}

void CameraControl::to_first_view() {
  // A view that was taken from a camera is never refused.
  (void)scene_.set_camera({.view = first_});
}

void CameraControl::make_free() {
  if (scene_.camera().type != mjCAMERA_FIXED) return;
  (void)scene_.set_camera({.view = scene_.view()});
}

void CameraControl::turn(double dx, double dy) {
  make_free();
  mjvCamera& camera = scene_.camera();
  camera.azimuth = std::remainder(camera.azimuth - kDegPerHeight * dx, 360);
  camera.elevation = std::clamp(camera.elevation + kDegPerHeight * dy, -89.9, 89.9);
}

void CameraControl::pan(double dx, double dy) {
  make_free();
  mjv_moveCamera(&scene_.model(), mjMOUSE_MOVE_V, dx, -dy, &scene_.camera());
}

void CameraControl::zoom(double notches) {
  make_free();
  double& distance = scene_.camera().distance;
  const double extent = scene_.model().stat.extent;
  distance = std::clamp(distance * std::exp(-kZoomPerNotch * notches), 0.01 * extent, 100 * extent);
}

void CameraControl::cycle(int by) {
  const int count = static_cast<int>(scene_.model().ncam);
  if (count == 0) return;
  mjvCamera& camera = scene_.camera();
  int next = by > 0 ? 0 : count - 1;
  if (camera.type == mjCAMERA_FIXED) next = (camera.fixedcamid + by + count) % count;
  mjv_defaultCamera(&camera);
  camera.type = mjCAMERA_FIXED;
  camera.fixedcamid = next;
}

std::string CameraControl::name() const {
  const mjvCamera& camera = scene_.camera();
  if (camera.type != mjCAMERA_FIXED) return {};
  const char* name = mj_id2name(&scene_.model(), mjOBJ_CAMERA, camera.fixedcamid);
  return name != nullptr ? name : "camera " + std::to_string(camera.fixedcamid);
}

}  // namespace mjarm::view
