#pragma once

#include <array>
#include <span>
#include <vector>

#include "mjarm/collision/fast_world_internal.hpp"

namespace mjarm::detail {

/// Where the spheres of a robot can be.
struct CrowdSpace {
  std::span<const Eigen::Matrix3d> R_WF;  ///< of all frames; frame 0 first
  Eigen::Vector3d middle_F;               ///< [m] in frame 0
  double reach = 0;                       ///< [m] from there
  double least_radius = 0;                ///< [m] of any sphere that moves
  std::size_t max_cubes = 0;              ///< that fill one mesh
};

/// Collects what goes into trees; what is out of reach by more than kMaxClearance is left out.
class CrowdBuilder {
 public:
  CrowdBuilder(const CrowdSpace& space, FastWorld& out) : space_(space), out_(out) {}

  /// A box or cylinder that `out` has.
  void add(const FastItem& item);
  /// A polytope or a mesh. The inside of a solid mesh is filled with cubes.
  void add(const Obstacle& solid, int id);
  /// Makes the trees and the grid, of everything that was added and of the clouds.
  void build(std::span<const PointCloud> clouds, int first_id);

 private:
  void add_polytope(const PolytopeShape& shape, const Pose& X_FO, int id);
  void add_mesh(const MeshShape& shape, const Pose& X_FO, int id);
  void build_grid();
  [[nodiscard]] FastBounds bounds_of(const FastItem& item) const;
  [[nodiscard]] double gap_of(const FastItem& item, const Eigen::Vector3d& p_F) const;

  const CrowdSpace& space_;
  FastWorld& out_;
  std::vector<FastItem> items_;
  std::vector<FastBounds> bounds_;
  std::vector<FastBounds> polytope_bounds_;  // of all that were added
};

/// The inside of a closed mesh as cubes.
struct SolidFill {
  struct Cube {
    Eigen::Vector3d center;
    double half;  ///< [m]
  };
  std::vector<Cube> cubes;
  /// [m] what is inside of the mesh and of no cube is less than this and `least_radius` from its
  /// surface.
  double thickness = 0;
};

/// Cuts the space round a mesh in eight, over and over, until the surface is in cells whose
/// diagonal is below `least_radius`, or there would be too many.
[[nodiscard]] SolidFill fill_solid(std::span<const Eigen::Vector3d> vertices,
                                   std::span<const std::array<int, 3>> faces,
                                   const CrowdSpace& space);

/// The triangle as the kernels take it, `thickness` [m] to either side.
[[nodiscard]] FastTriangle fast_triangle(const std::array<Eigen::Vector3d, 3>& corners,
                                         double thickness);

}  // namespace mjarm::detail
