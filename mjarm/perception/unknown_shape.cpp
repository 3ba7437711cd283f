#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "mjarm/perception/image_fit_internal.hpp"
#include "mjarm/perception/unknown_shape_internal.hpp"

namespace mjarm::perception {
namespace {

constexpr double kLargest = 1;  // [m] across

/// The table's frame F in the camera's: its origin below the cluster, z up.
Pose table_frame(const DepthScene& scene, const Eigen::Vector3d& above_C) {
  const Eigen::Vector3d z = -scene.table_a.normalized();
  const double height = z.dot(above_C) + 1 / scene.table_a.norm();
  Pose X_CF{.p = above_C - height * z};
  const Eigen::Vector3d x = z.unitOrthogonal();
  X_CF.R << x, z.cross(x), z;
  return X_CF;
}

std::vector<Eigen::Vector3d> points_of(const DepthScene& scene, int cluster) {
  constexpr int kMost = 2000;
  const Cluster& box = scene.clusters[static_cast<std::size_t>(cluster)];
  const int stride = 1 + static_cast<int>(std::sqrt(box.pixels / kMost));
  std::vector<Eigen::Vector3d> out;
  for (int y = box.y0; y <= box.y1; y += stride) {
    for (int x = box.x0; x <= box.x1; x += stride) {
      const auto at = static_cast<std::size_t>(y * scene.lens.width + x);
      if (scene.label[at] == cluster) out.emplace_back(scene.lens.ray({x, y}) / scene.inverse[at]);
    }
  }
  return out;
}

/// A box's numbers: middle x, y and yaw in F, then length, width, height.
using Numbers = Eigen::Matrix<double, 6, 1>;

/// The upright box of least footprint round points of F.
Numbers box_round(const std::vector<Eigen::Vector3d>& points_F) {
  constexpr int kAngles = 30;
  Numbers best = Numbers::Zero();
  double least = 1e9;
  double height = 0;
  for (const Eigen::Vector3d& p : points_F) height = std::max(height, p.z());
  for (int i = 0; i < kAngles; ++i) {
    const double yaw = 0.5 * std::numbers::pi * i / kAngles;
    const Eigen::Matrix2d R = Eigen::Rotation2Dd(yaw).toRotationMatrix();
    Eigen::Array2d low = Eigen::Array2d::Constant(1e9);
    Eigen::Array2d high = -low;
    for (const Eigen::Vector3d& p : points_F) {
      const Eigen::Array2d at = (R.transpose() * p.head<2>()).array();
      low = low.min(at);
      high = high.max(at);
    }
    const double area = (high - low).prod();
    if (area >= least) continue;
    least = area;
    const Eigen::Vector2d middle = R * ((low + high) / 2).matrix();
    best << middle, yaw, high - low, height;
  }
  return best;
}

/// Sizes stay positive.
double positive(double size) { return std::max(size, 1e-3); }

Pose upright(const Pose& X_CF, double x, double y, double yaw, double height) {
  return X_CF * Pose{.p = {x, y, height / 2},
                     .R = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix()};
}

/// Fits coarsely, then finely.
ImageFit fit(const DepthScene& scene, int cluster, const DrawWith& draw, Eigen::VectorXd x,
             const Eigen::VectorXd& step_of_pixel, Raster& raster) {
  Cluster box = scene.clusters[static_cast<std::size_t>(cluster)];
  const int rim = 8;
  box = {box.pixels, box.middle, box.x0 - rim, box.y0 - rim, box.x1 + rim, box.y1 + rim};
  ImageFit out;
  for (const int side : {40, 120}) {
    const FitView view = view_of(scene, cluster, box, side);
    const double pixel = 1 / (view.middle * view.lens.fx);
    const float limit = side == 40 ? 12 : 4;
    out = fit_image(view, draw, x, {.limit = limit, .step = pixel * step_of_pixel, .steps = 12},
                    raster);
    x = out.x;
  }
  return out;
}

}  // namespace

std::optional<UnknownObject> measure_unknown(const DepthScene& scene, int cluster, Raster& raster) {
  if (!scene.table || scene.table_a.isZero()) return {};
  std::vector<Eigen::Vector3d> points = points_of(scene, cluster);
  if (points.empty()) return {};
  const Pose X_CF = table_frame(scene, points.front());
  const Pose X_FC = X_CF.inverse();
  for (Eigen::Vector3d& p : points) p = X_FC * p;
  const Numbers first = box_round(points);
  if (first.tail<3>().maxCoeff() > kLargest) return {};

  const auto box = [&](const Eigen::VectorXd& x, Raster& into) {
    const Eigen::Vector3d size(positive(x[3]), positive(x[4]), positive(x[5]));
    into.draw(box_surface(size / 2), upright(X_CF, x[0], x[1], x[2], size.z()));
    return 0.0F;
  };
  const auto cylinder = [&](const Eigen::VectorXd& x, Raster& into) {
    const double height = positive(x[3]);
    into.draw(cylinder_surface(positive(x[2]), height / 2), upright(X_CF, x[0], x[1], 0, height));
    return 0.0F;
  };
  Eigen::VectorXd box_step = Eigen::VectorXd::Ones(6);
  box_step[2] = 2 / std::max(first[3], first[4]);  // a pixel at the end of the longer side
  const ImageFit as_box = fit(scene, cluster, box, first, box_step, raster);
  Eigen::VectorXd round(4);
  round << first[0], first[1], (first[3] + first[4]) / 4, first[5];
  const ImageFit as_cylinder =
      fit(scene, cluster, cylinder, round, Eigen::VectorXd::Ones(4), raster);

  UnknownObject out;
  if (as_box.cost <= as_cylinder.cost) {
    const Eigen::VectorXd& x = as_box.x;
    out.size = {positive(x[3]), positive(x[4]), positive(x[5])};
    out.X_WO = scene.X_WC * upright(X_CF, x[0], x[1], x[2], out.size.z());
  } else {
    const Eigen::VectorXd& x = as_cylinder.x;
    out.kind = UnknownObject::Kind::cylinder;
    out.size = {2 * positive(x[2]), 2 * positive(x[2]), positive(x[3])};
    out.X_WO = scene.X_WC * upright(X_CF, x[0], x[1], 0, out.size.z());
  }
  return out;
}

}  // namespace mjarm::perception
