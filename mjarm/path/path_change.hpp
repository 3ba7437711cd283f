#pragma once

#include <Eigen/Core>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/rotation.hpp"

namespace mjarm {

/// A change of a whole path: shifted in the world, the tool turned in its own frame.
struct PathChange {
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< [m] world
  Eigen::Vector3d tilt = Eigen::Vector3d::Zero();   ///< [rad] rotation vector in the tool frame
  [[nodiscard]] bool is_none() const { return shift.isZero(0) && tilt.isZero(0); }
  [[nodiscard]] Pose operator()(const Pose& X_WT) const {
    return {X_WT.p + shift, X_WT.R * rotation_exp(tilt)};
  }
};

}  // namespace mjarm
