#include "mjarm/view/ray.hpp"

#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <cmath>

#include "mjarm/render/free_camera.hpp"

namespace mjarm::view {

using Eigen::Vector2d;
using Eigen::Vector3d;

double Eye::height_at(const Vector3d& point_W) const {
  return (upper - lower) * (orthographic ? 1 : (point_W - p_W).dot(forward_W));
}

Eye eye_of(const render::CameraView& view, double fovy) {
  const Pose X_WC = render::camera_pose(view);
  Eye eye;
  eye.forward_W = -X_WC.R.col(2);
  eye.up_W = X_WC.R.col(1);
  eye.p_W = X_WC.p;
  eye.upper = std::tan(fovy / 2);
  eye.lower = -eye.upper;
  return eye;
}

Eye eye_of(render::Scene& scene) {
  const mjvScene& raw = scene.raw();
  const mjvGLCamera camera = mjv_averageCamera(&raw.camera[0], &raw.camera[1]);
  const auto vector = [](const float* v) { return Vector3d(v[0], v[1], v[2]); };
  Eye eye;
  eye.p_W = vector(camera.pos);
  eye.forward_W = vector(camera.forward).normalized();
  eye.up_W = vector(camera.up);
  eye.up_W = (eye.up_W - eye.up_W.dot(eye.forward_W) * eye.forward_W).normalized();
  eye.near = camera.frustum_near;
  eye.orthographic = camera.orthographic != 0;
  // MuJoCo's frustum is measured where it begins.
  const double distance = eye.orthographic ? 1 : eye.near;
  eye.lower = camera.frustum_bottom / distance;
  eye.upper = camera.frustum_top / distance;
  eye.middle = camera.frustum_center / distance;
  return eye;
}

Ray ray_of_pixel(const Eye& eye, int width, int height, double x, double y) {
  return ray_of_share(eye, static_cast<double>(width) / height, x / width, 1 - y / height);
}

Ray ray_of_share(const Eye& eye, double aspect, double x, double y) {
  const double height = eye.upper - eye.lower;
  const double right = eye.middle + height * aspect * (x - 0.5);
  const double up = eye.lower + height * y;
  const Vector3d aside = right * eye.right_W() + up * eye.up_W;
  if (eye.orthographic) return {eye.p_W + aside, eye.forward_W};
  return {eye.p_W, (eye.forward_W + aside).normalized()};
}

std::optional<Vector2d> pixel_of_point(const Eye& eye, int width, int height, const Vector3d& p_W) {
  const Vector3d way = p_W - eye.p_W;
  const double depth = way.dot(eye.forward_W);
  if (!(depth > 0)) return std::nullopt;
  const double share = eye.orthographic ? 1 : 1 / depth;
  const double scale = height / (eye.upper - eye.lower);
  return Vector2d(0.5 * width + scale * (share * way.dot(eye.right_W()) - eye.middle),
                  scale * (eye.upper - share * way.dot(eye.up_W)));
}

}  // namespace mjarm::view
