#include "mjarm/execution/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mjarm/core/rotation.hpp"

namespace mjarm {
namespace {

double squared_distance_to_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                   const Eigen::Vector3d& b) {
  const Eigen::Vector3d ab = b - a;
  const double length2 = ab.squaredNorm();
  const double t = length2 > 0 ? std::clamp(ab.dot(p - a) / length2, 0.0, 1.0) : 0.0;
  return (a + t * ab - p).squaredNorm();
}

bool is_covered(const Eigen::Vector3d& p, std::span<const Eigen::Vector3d> executed, double near) {
  const double near2 = near * near;
  if (executed.size() == 1) return (executed[0] - p).squaredNorm() <= near2;
  for (std::size_t i = 0; i + 1 < executed.size(); ++i) {
    if (squared_distance_to_segment(p, executed[i], executed[i + 1]) <= near2) return true;
  }
  return false;
}

}  // namespace

PathError path_error(const Curve& curve, std::span<const Eigen::Vector3d> p_W, double near,
                     double spacing) {
  PathError error;
  if (p_W.empty()) return error;
  double sum2 = 0;
  for (const Eigen::Vector3d& p : p_W) {
    const Curve::Nearest nearest = curve.nearest(p);
    sum2 += nearest.distance * nearest.distance;
    if (nearest.distance > error.max) {
      error.max = nearest.distance;
      error.at = nearest.s;
    }
  }
  error.rms = std::sqrt(sum2 / static_cast<double>(p_W.size()));

  const std::vector<double> stations =
      curve.stations(spacing, std::numeric_limits<double>::infinity());
  const auto covered = std::count_if(stations.begin(), stations.end(), [&](double s) {
    return is_covered(curve.at(s).p, p_W, near);
  });
  error.coverage = static_cast<double>(covered) / static_cast<double>(stations.size());
  return error;
}

PoseError pose_error(const Pose& X_goal, const Pose& X_WT) {
  return {(X_goal.p - X_WT.p).norm(), angle_between(X_goal.R, X_WT.R)};
}

}  // namespace mjarm
