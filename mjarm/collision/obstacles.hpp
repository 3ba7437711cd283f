#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
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
/// A cylinder with half a ball at either end.
struct CapsuleShape {
  double radius = 0;       ///< [m] > 0
  double half_length = 0;  ///< [m] >= 0, of the segment along z that the radius is put round
};
/// A box about the origin, its edges along the axes.
struct BoxShape {
  Eigen::Vector3d half = Eigen::Vector3d::Zero();  ///< [m] > 0, half extents
};
/// A cylinder about z, its middle at the origin.
struct CylinderShape {
  double radius = 0;       ///< [m] > 0, about z
  double half_length = 0;  ///< [m] > 0, flat ends
};
struct HalfSpaceShape {};  ///< all points with z <= 0
/// A convex solid: the points that are below every plane. See make_polytope().
struct PolytopeShape {
  /// (n, d): n . p <= d [m], n of length 1; 1 to kMaxPlanes
  std::vector<Eigen::Vector4d> planes{};
  /// [m] box round it, with sides along the axes; cuts off what the planes leave open
  Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = Eigen::Vector3d::Zero();
};
/// Triangles without thickness. Where they close a solid its inside can count as well.
struct MeshShape {
  std::vector<Eigen::Vector3d> vertices{};  ///< [m]
  std::vector<std::array<int, 3>> faces{};  ///< indices of vertices; at least one face
  bool solid = false;                       ///< what is inside counts; only where is_closed()
};
/// Ground whose height is given at the crossings of a grid: a column for each cell, as high as the
/// highest of its four corners. So it covers what triangles between the corners would make, and is
/// higher by at most the range of a cell's corners.
struct HeightFieldShape {
  int rows = 0, cols = 0;                          ///< crossings along y and x, >= 2
  Eigen::Vector2d half = Eigen::Vector2d::Zero();  ///< [m] > 0, half extents along x and y
  double bottom = 0;                               ///< [m] where the columns begin
  std::vector<double> heights{};                   ///< [m] (rows, cols), row by row, > bottom
};
using ObstacleShape = std::variant<BallShape, CapsuleShape, BoxShape, CylinderShape, HalfSpaceShape,
                                   PolytopeShape, MeshShape, HeightFieldShape>;

/// Whether every edge belongs to an even number of faces; corners in one place count as one.
[[nodiscard]] bool is_closed(const MeshShape& mesh);

/// A solid that stands still.
struct Obstacle {
  std::string name;  ///< for messages; may be empty
  Pose X_WO;
  ObstacleShape shape;
  std::string movable = {};  ///< body of a free joint that it is a part of, which could be carried
                             ///< away; mostly empty
};

/// Points that a camera saw, say: each stands for a ball.
struct PointCloud {
  std::string name;                         ///< for messages; may be empty
  std::vector<Eigen::Vector3d> points_W{};  ///< [m] may be none
  double radius = 0;                        ///< [m] > 0, round every point
};

/// A link and an obstacle that are not held against each other.
struct IgnoredPair {
  int link = -1;      ///< index into the sphere set
  int obstacle = -1;  ///< index into the obstacles
  auto operator<=>(const IgnoredPair&) const = default;
};

/// What stands round an arm. A plain value. Where an obstacle is named by an index, the clouds
/// follow the solids.
struct Obstacles {
  std::vector<Obstacle> solids{};
  std::vector<PointCloud> clouds{};
  std::vector<IgnoredPair> ignored{};  ///< of links and solids, in any order
};

/// Most obstacles that a checker takes, most faces, planes and cells of all of them together, most
/// planes of one, and most points of all clouds together.
inline constexpr std::size_t kMaxObstacles = 200'000;
inline constexpr std::size_t kMaxPieces = 200'000;
inline constexpr std::size_t kMaxPlanes = 256;
inline constexpr std::size_t kMaxPoints = 100'000;

/// The solid as few planes round points, each of which touches one of them: the faces of their
/// convex hull, planes along its edges, and some in all directions. The solid holds all points.
/// What is D [m] away from their hull is at least 0.9 D away from one of the planes, as long as the
/// hull has no more than 40 faces; for more the faces of similar direction share planes.
/// @param points  [m] 1 to 10,000, finite, within 1e4 m; may be on a plane or a line.
[[nodiscard]] Result<PolytopeShape> make_polytope(std::span<const Eigen::Vector3d> points);

/// [m] from point `p_W` to the surface of the solid; 0 inside of it. Exact to rounding, but for a
/// polytope: there the largest distance from a plane, which is less beyond edges and corners.
[[nodiscard]] double distance(const Obstacle& obstacle, const Eigen::Vector3d& p_W) noexcept;
/// The same of the balls round all points of a cloud; infinite where it has none.
[[nodiscard]] double distance(const PointCloud& cloud, const Eigen::Vector3d& p_W) noexcept;

/// Name of an obstacle, by its index among solids and clouds.
[[nodiscard]] const std::string& obstacle_name(const Obstacles& obstacles, int index) noexcept;

/// Looks whether every number is finite, every size in range (1e-9 to 1e4 m, places up to 1e4 m),
/// every rotation one (to 1e-6), that nothing is more than the numbers above, and that ignored
/// pairs are of solids that are there and of one of `links` links.
/// @return bad_input: one line that names the first faulty obstacle, its faulty part, and what is
/// wrong with it.
[[nodiscard]] Result<void> check_obstacles(const Obstacles& obstacles,
                                           int links = std::numeric_limits<int>::max());

}  // namespace mjarm
