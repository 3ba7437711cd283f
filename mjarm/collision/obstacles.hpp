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

/// Points that a camera saw, say: each stands for a ball.
struct PointCloud {
  std::string name;                         ///< for messages; may be empty
  std::vector<Eigen::Vector3d> points_W{};  ///< [m] may be none
  double radius = 0;                        ///< [m] > 0, round every point
};

/// What stands round an arm. A plain value. Where an obstacle is named by an index, the clouds
/// follow the solids.
struct Obstacles {
  std::vector<Obstacle> solids{};
  std::vector<PointCloud> clouds{};
};

/// Most obstacles that a checker takes, and most points of all clouds together.
inline constexpr std::size_t kMostObstacles = 200'000;
inline constexpr std::size_t kMostPoints = 100'000;

/// [m] from point `p_W` to the surface of the solid; 0 inside of it. Exact to rounding.
[[nodiscard]] double distance(const Obstacle& obstacle, const Eigen::Vector3d& p_W) noexcept;
/// The same of the balls round all points of a cloud; infinite where it has none.
[[nodiscard]] double distance(const PointCloud& cloud, const Eigen::Vector3d& p_W) noexcept;

/// Name of an obstacle, by its index among solids and clouds.
[[nodiscard]] const std::string& obstacle_name(const Obstacles& obstacles, int index) noexcept;

/// Looks whether every number is finite, every size in range (1e-9 to 1e4 m, places up to 1e4 m),
/// every rotation one (to 1e-6), and that there are at most kMostObstacles and kMostPoints.
/// @return bad_input: one line that names the first faulty obstacle or point and what is wrong with
/// it.
[[nodiscard]] Result<void> check_obstacles(const Obstacles& obstacles);

}  // namespace mjarm
