#pragma once

#include <Eigen/Core>
#include <vector>

#include "mjarm/collision/link_balls.hpp"
#include "mjarm/model/arm.hpp"

namespace mjarm::detail {

/// Where the centre of a ball in a link can be at all, within the limits of the joints.
struct BallReach {
  /// All places p with normal . p <= offset.
  struct Side {
    Eigen::Vector3d normal;
    double offset = 0;  ///< [m]
  };
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double radius = 0;        ///< [m] round `middle`
  std::vector<Side> sides;  ///< at which it ends earlier
};

/// By the lengths of the chain and, along the axes of the world and of the first joints, as far as
/// joints move the ball there: not at all along the axis that all hinges of a flat arm have.
[[nodiscard]] BallReach reach_of(const Arm& arm, const LinkBall& ball);

}  // namespace mjarm::detail
