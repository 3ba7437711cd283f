#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "mjarm/collision/fast_check.hpp"
#include "mjarm/collision/obstacles.hpp"

namespace mjarm {

/// A ball that a moving link contains: where the link is free, so is the ball.
struct LinkBall {
  int link = -1;                                     ///< index into the sphere set
  int joint = 0;                                     ///< that moves it
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< [m] in the frame J of the joint
  double radius = 0;                                 ///< [m] > 0
};

/// A piece of what stands still: a solid, a triangle of a mesh, a column of a height field or a
/// ball of a cloud.
struct StandingPiece {
  Eigen::Vector3d low, high;  ///< [m] a box round it in the world, may be infinite
  int obstacle = -1;          ///< that it is of
  /// [m] A point of the piece is no farther than this from a place in the world; infinite where
  /// that is not known, or more than `enough`. Exact to a part in 1e6, but for polytopes beyond
  /// their edges.
  std::function<double(const Eigen::Vector3d& p_W, double enough)> distance;
};

/// Balls in links and what stops them, in exact geometry and without margins: a configuration that
/// the checker of the same things calls free has every ball clear of every piece, but for those of
/// `ignored` pairs.
struct BallScene {
  std::vector<LinkBall> balls;  ///< a few of each moving link: large ones, those of the tip first
  std::vector<StandingPiece> pieces;
  std::vector<IgnoredPair> ignored;
};

/// Those of a checker: of its exact solids where it looks closer, else of its spheres.
/// @param obstacles  that the checker was made of; must outlive what comes back, as must `checker`.
[[nodiscard]] BallScene ball_scene(const FastChecker& checker, const Obstacles& obstacles);

}  // namespace mjarm
