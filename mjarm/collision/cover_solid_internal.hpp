#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "mjarm/collision/byte_key_internal.hpp"
#include "mjarm/collision/facets_internal.hpp"
#include "mjarm/core/pose.hpp"

namespace mjarm::detail {

enum class SolidKind { ball, capsule, box, cylinder, ellipsoid, hull };

/// A triangle of the surface of a hull.
struct HullTriangle {
  std::array<int, 3> corners;  ///< among the vertices
  double reach = 0;            ///< [m] farthest corner from the first
};
[[nodiscard]] HullTriangle hull_triangle(std::span<const Eigen::Vector3d> points,
                                         const std::array<int, 3>& corners);

/// A convex solid of a link, in a frame S of its own, seen from the frame L of the link.
struct CoverSolid {
  SolidKind kind = SolidKind::ball;
  Pose X_LS;
  /// [m] radius; radius and half length along z; half extents; or semi-axes.
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  Facets facets;                        ///< of a hull, in S
  std::vector<Eigen::Vector3d> points;  ///< vertices of a hull, in S
  std::vector<HullTriangle> triangles;  ///< of them, the surface of a hull

  /// Distance of a point in L to the surface: inside of the solid exact, and negative; outside
  /// exact or (hull) too small.
  [[nodiscard]] double signed_distance(const Eigen::Vector3d& p_L) const;
  /// Whether that is no more than `distance`.
  [[nodiscard]] bool is_within(const Eigen::Vector3d& p_L, double distance) const;
  [[nodiscard]] Eigen::Vector3d in_own_frame(const Eigen::Vector3d& p_L) const;  ///< in S
  /// Its direction of steepest rise, unit or 0.
  [[nodiscard]] Eigen::Vector3d outwards(const Eigen::Vector3d& p_L) const;
  /// A point of the solid no farther from `p_L` than `distance`, if there is one.
  [[nodiscard]] std::optional<Eigen::Vector3d> point_within(const Eigen::Vector3d& p_L,
                                                            double distance) const;
  /// Points and a radius such that the solid lies in the hull of the balls with that radius round
  /// them; in L.
  [[nodiscard]] std::vector<Eigen::Vector3d> skeleton() const;
  /// All that decides about it.
  void append_to(ByteKey& key) const;
  /// Corners and points of edges, in L: what a cover must not miss; none of what is round.
  [[nodiscard]] std::vector<Eigen::Vector3d> sharp_points(double spacing) const;
};

/// A box along the axes of L that contains the solids (at least one).
struct CoverBounds {
  Eigen::Vector3d low, high;
};
[[nodiscard]] CoverBounds bounds_of(std::span<const CoverSolid> solids);
/// A box along the axes of the world round one along those of O.
[[nodiscard]] CoverBounds bounds_in_world(const Pose& X_WO, const CoverBounds& box_O);

/// Depth of a point in the solid it is deepest in; negative outside of all.
[[nodiscard]] double depth_in(std::span<const CoverSolid> solids, const Eigen::Vector3d& p_L);

}  // namespace mjarm::detail
