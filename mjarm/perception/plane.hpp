#pragma once

#include <Eigen/Core>

namespace mjarm::perception {

/// A plane in the world: the points p with normal_W . p = offset.
struct Plane {
  Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();  ///< unit length, towards what stands on it
  double offset = 0;                                    ///< [m]

  /// [m] above the plane.
  [[nodiscard]] double height(const Eigen::Vector3d& p_W) const {
    return normal_W.dot(p_W) - offset;
  }
};

}  // namespace mjarm::perception
