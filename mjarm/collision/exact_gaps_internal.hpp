#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace mjarm::detail {

/// Two geoms as MuJoCo numbers them.
struct GeomIds {
  int geom1 = -1;
  int geom2 = -1;
  auto operator<=>(const GeomIds&) const = default;
};

/// Where two geoms are nearest, or deepest in each other.
struct GeomGap {
  double distance = 0;       ///< [m] between the surfaces, negative where they overlap
  Eigen::Vector3d point_W;   ///< [m] midway between the two surfaces
  Eigen::Vector3d normal_W;  ///< unit, from geom 1 to geom 2
};

/// True for a capsule and a box, and for a plane and a cylinder, in MuJoCo's order of the two. The
/// first collider (MuJoCo 4.0.1) takes a capsule whose axis runs through the box for a free one in
/// about 1 of 100 such cases, and errs on depth and distance by up to the size of the geoms; the
/// checker measures these pairs with MuJoCo's convex collider (GJK and EPA) instead. The second has
/// a cylinder that stands upright to the last bit overlap a plane by up to its radius where it is
/// that far above it; these pairs are measured here.
[[nodiscard]] bool is_measured_here(const mjModel& m, int geom1, int geom2);

/// All such pairs that may collide by MuJoCo's rules (contype and conaffinity, same body, parent
/// and child, excludes, explicit pairs) and of which one moves; `moves` is per body.
[[nodiscard]] std::vector<GeomIds> pairs_measured_here(const mjModel& m,
                                                       const std::vector<bool>& moves);

/// True where MuJoCo's rules let the two geoms collide, whatever their shape.
[[nodiscard]] bool may_collide(const mjModel& m, int geom1, int geom2);

/// Gap between two such geoms at the poses in `d`; none above `margin` [m].
[[nodiscard]] std::optional<GeomGap> gap_measured_here(const mjModel& m, mjData* d, GeomIds ids,
                                                       double margin);

/// Distance between any two geoms at the poses in `d`, at most `max` [m].
[[nodiscard]] double geom_distance(const mjModel& m, mjData* d, GeomIds ids, double max);

}  // namespace mjarm::detail
