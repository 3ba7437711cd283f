#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm {

/// The solids that an arm must keep clear of, each in a frame O of its own.
struct BallShape {
  double radius = 0;  ///< [m] > 0, round the origin
};
struct CapsuleShape {
  double radius = 0;       ///< [m] > 0
  double half_length = 0;  ///< [m] >= 0, of the segment along z that the radius is put round
};
struct BoxShape {
  Eigen::Vector3d half = Eigen::Vector3d::Zero();  ///< [m] > 0, half extents
};
struct CylinderShape {
  double radius = 0;       ///< [m] > 0, about z
  double half_length = 0;  ///< [m] > 0, flat ends
};
struct HalfSpaceShape {};  ///< all points with z <= 0
using ObstacleShape =
    std::variant<BallShape, CapsuleShape, BoxShape, CylinderShape, HalfSpaceShape>;

/// A solid that stands still.
struct Obstacle {
  std::string name;  ///< for messages; may be empty
  Pose X_WO;
  ObstacleShape shape;
};

/// What stands round an arm. A plain value.
struct Obstacles {
  std::vector<Obstacle> solids;
};

/// Most obstacles that a checker takes.
inline constexpr std::size_t kMostObstacles = 200'000;

/// [m] from point `p_W` to the surface of the solid; 0 inside of it. Exact to rounding.
[[nodiscard]] double distance(const Obstacle& obstacle, const Eigen::Vector3d& p_W) noexcept;

/// Looks whether every number is finite, every size in range (1e-9 to 1e4 m, places up to 1e4 m),
/// every rotation one (to 1e-6), and that there are at most kMostObstacles.
/// @return bad_input: one line that names the first faulty obstacle and what is wrong with it.
[[nodiscard]] Result<void> check_obstacles(const Obstacles& obstacles);

}  // namespace mjarm
