#include "mjarm/perception/tag_pose.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "mjarm/perception/depth_model_internal.hpp"
#include "mjarm/perception/fit_poses_internal.hpp"

namespace mjarm::perception {
namespace {

constexpr double kCornerSigma = 0.15;     // [px] of a corner that the detector tells
constexpr double kSizeTolerance = 0.1;    // of the size
constexpr double kMostCornerError = 1.5;  // [px] root mean square of the corners
constexpr int kFewestPixels = 30;

using Corners = std::array<Eigen::Vector2d, 4>;

/// A plane of the camera's frame: 1/z = a . (x/z, y/z, 1).
struct SeenPlane {
  Eigen::Vector3d a;
  Eigen::Matrix3d information;  ///< inverse covariance of `a`
};

/// True on one side of all four edges, whichever way round the corners go.
bool is_inside(const Corners& corners, const Eigen::Vector2d& at) {
  int left = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d edge = corners[(i + 1) % 4] - corners[i];
    const Eigen::Vector2d way = at - corners[i];
    left += edge.x() * way.y() - edge.y() * way.x() > 0 ? 1 : 0;
  }
  return left == 0 || left == 4;
}

struct Sample {
  Eigen::Vector3d ray;
  double inverse;
};

/// Pixels on the tag that have depth; `all` counts the others as well.
std::vector<Sample> samples_on(const Corners& corners, const render::RgbdFrame& frame, int& all) {
  Eigen::Array2d low = corners[0], high = corners[0];
  for (const Eigen::Vector2d& corner : corners) {
    low = low.min(corner.array());
    high = high.max(corner.array());
  }
  const auto& lens = frame.intrinsics;
  std::vector<Sample> out;
  for (int y = std::max(0, static_cast<int>(low.y())); y <= std::min(lens.height - 1.0, high.y());
       ++y) {
    for (int x = std::max(0, static_cast<int>(low.x())); x <= std::min(lens.width - 1.0, high.x());
         ++x) {
      if (!is_inside(corners, {x, y})) continue;
      ++all;
      const float inverse = inverse_depth(
          frame.depth[static_cast<std::size_t>(y) * static_cast<std::size_t>(lens.width) +
                      static_cast<std::size_t>(x)]);
      if (inverse > 0) out.push_back({lens.ray({x, y}), inverse});
    }
  }
  return out;
}

/// The plane of most samples: those that lie off it by more than three sigma are left out, again
/// and again. Nothing where too few are left.
std::optional<SeenPlane> plane_of(const std::vector<Sample>& samples, const DepthModel& model) {
  constexpr int kRounds = 6;
  constexpr double kLeastShare = 0.7;
  std::optional<SeenPlane> plane;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    std::size_t used = 0;
    // Wider at first, when the outliers still pull.
    const double gate = 3.5 * model.sigma * (1 << std::max(0, 3 - round));
    for (const auto& [ray, inverse] : samples) {
      if (plane && std::abs(plane->a.dot(ray) - inverse) > gate) continue;
      A += ray * ray.transpose();
      b += inverse * ray;
      ++used;
    }
    if (static_cast<double>(used) < kLeastShare * static_cast<double>(samples.size())) return {};
    plane = SeenPlane{A.inverse() * b, A / (model.sigma * model.sigma)};
  }
  return plane;
}

/// As the rays through the corners meet the plane; its mean edge [m] tells the size.
Pose first_pose(const Corners& corners, const render::CameraIntrinsics& lens,
                const Eigen::Vector3d& plane, double& edge) {
  std::array<Eigen::Vector3d, 4> p_C;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3d ray = lens.ray(corners[i]);
    p_C[i] = ray / plane.dot(ray);
  }
  edge = 0;
  for (std::size_t i = 0; i < 4; ++i) edge += (p_C[(i + 1) % 4] - p_C[i]).norm() / 4;
  const Eigen::Vector3d z = -plane.normalized();  // towards the camera
  const Eigen::Vector3d along = p_C[1] - p_C[0] + p_C[2] - p_C[3];
  const Eigen::Vector3d x = (along - along.dot(z) * z).normalized();
  Pose X_CT{.p = (p_C[0] + p_C[1] + p_C[2] + p_C[3]) / 4};
  X_CT.R << x, z.cross(x), z;
  return X_CT;
}

}  // namespace

std::array<Eigen::Vector3d, 4> tag_corners(double size) {
  const double h = size / 2;
  return {Eigen::Vector3d(-h, -h, 0), {h, -h, 0}, {h, h, 0}, {-h, h, 0}};
}

Result<TagPose, FindErrc> tag_pose(const SeenTag& tag, double size, const render::RgbdFrame& frame,
                                   double depth_sigma) {
  const DepthModel model(depth_sigma);
  const render::CameraIntrinsics& lens = frame.intrinsics;
  int all = 0;
  const std::vector<Sample> samples = samples_on(tag.corners, frame, all);
  const auto enough = static_cast<std::size_t>(std::max(all / 2, kFewestPixels));
  if (samples.size() < enough) return fail(FindErrc::no_depth);
  const std::optional<SeenPlane> plane = plane_of(samples, model);
  if (!plane || !(plane->a.norm() > 0)) return fail(FindErrc::disagrees);
  double edge = 0;
  const Pose first = first_pose(tag.corners, lens, plane->a, edge);
  if (!(std::abs(edge / size - 1) < kSizeTolerance)) return fail(FindErrc::wrong_size);

  const Eigen::Matrix3d root = plane->information.llt().matrixU();
  const auto residuals = [&](std::span<const Pose> at) {
    Eigen::VectorXd r(11);
    const Pose& X_CT = at[0];
    const std::array<Eigen::Vector3d, 4> p_T = tag_corners(size);
    for (std::size_t i = 0; i < 4; ++i) {
      r.segment<2>(static_cast<Eigen::Index>(2 * i)) =
          (lens.project(X_CT * p_T[i]) - tag.corners[i]) / kCornerSigma;
    }
    const Eigen::Vector3d n = X_CT.R.col(2);
    r.tail<3>() = root * (n / n.dot(X_CT.p) - plane->a);
    return r;
  };
  const PoseFit fit = fit_poses({first}, residuals);
  const double corners = residuals(fit.poses).head<8>().squaredNorm() / 4;
  const double residual = kCornerSigma * std::sqrt(corners);
  if (!(residual < kMostCornerError)) return fail(FindErrc::disagrees);
  return TagPose{.X_CT = fit.poses[0], .residual = residual};
}

}  // namespace mjarm::perception
