#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <vector>

#include "mjarm/core/pose.hpp"

namespace mjarm::perception {

/// What is to become small, as a vector that is as long at every call.
using Residuals = std::function<Eigen::VectorXd(std::span<const Pose>)>;

struct PoseFit {
  std::vector<Pose> poses;
  double squares = 0;  ///< sum of the squared residuals
};

/// Moves poses from a start to where the sum of squared residuals is least (K. Levenberg, 1944;
/// derivatives by central differences).
/// @param start  all finite, near enough
[[nodiscard]] PoseFit fit_poses(std::vector<Pose> start, const Residuals& residuals);

/// A pose moved by (v, w): the origin by v [m], the axes by the rotation vector w [rad] in the
/// frame in which the pose is told.
[[nodiscard]] Pose moved(const Pose& X, const Eigen::Ref<const Eigen::Matrix<double, 6, 1>>& by);

}  // namespace mjarm::perception
