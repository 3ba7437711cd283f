#include "mjarm/render/free_camera.hpp"

#include <mujoco/mujoco.h>

#include <cmath>
#include <numbers>

namespace mjarm::render {

Pose camera_pose(const CameraView& view) {
  const double level = std::cos(view.elevation);
  const Eigen::Vector3d forward(level * std::cos(view.azimuth), level * std::sin(view.azimuth),
                                std::sin(view.elevation));
  const Eigen::Vector3d right(std::sin(view.azimuth), -std::cos(view.azimuth), 0);
  Pose X_WC{.p = view.lookat_W - view.distance * forward};
  X_WC.R.col(0) = right;
  X_WC.R.col(1) = right.cross(forward);
  X_WC.R.col(2) = -forward;
  return X_WC;
}

double free_camera_fovy(const Model& model) {
  return model.raw()->vis.global.fovy * std::numbers::pi / 180;
}

}  // namespace mjarm::render
