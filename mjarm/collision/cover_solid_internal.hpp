#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "mjarm/collision/byte_key_internal.hpp"
#include "mjarm/core/pose.hpp"

namespace mjarm::detail {

/// All points p with normal . p <= offset.
struct Facet {
  Eigen::Vector3d normal;  ///< unit
  double offset = 0;       ///< [m]
};

/// What bounds a convex solid, kept so that several are looked at at once.
class Facets {
 public:
  void add(const Facet& facet);
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] Facet operator[](std::size_t index) const;
  /// [m] The largest normal . p - offset; minus infinity where there are none.
  [[nodiscard]] double farthest(const Eigen::Vector3d& p) const;

 private:
  std::size_t size_ = 0;
  std::vector<double> rows_;  ///< four normals along x, along y, along z, four offsets, ...
};

enum class SolidKind { ball, capsule, box, cylinder, ellipsoid, hull };

/// A convex solid of a link, in a frame S of its own, seen from the frame L of the link.
struct CoverSolid {
  SolidKind kind = SolidKind::ball;
  Pose X_LS;
  /// [m] radius; radius and half length along z; half extents; or semi-axes.
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  Facets facets;                              ///< of a hull, in S
  std::vector<Eigen::Vector3d> points;        ///< vertices of a hull, in S
  std::vector<std::array<int, 3>> triangles;  ///< of them, the surface of a hull

  /// Distance of a point in L to the surface: inside of the solid exact, and negative; outside
  /// exact or (hull) too small.
  [[nodiscard]] double signed_distance(const Eigen::Vector3d& p_L) const;
  /// Its direction of steepest rise, unit or 0.
  [[nodiscard]] Eigen::Vector3d outwards(const Eigen::Vector3d& p_L) const;
  /// A point of the solid no farther from `p_L` than `distance`, if there is one.
  [[nodiscard]] std::optional<Eigen::Vector3d> point_within(const Eigen::Vector3d& p_L,
                                                            double distance) const;
  /// Points and a radius such that the solid lies in the hull of the balls with that radius round
  /// them; in L.
  [[nodiscard]] std::vector<Eigen::Vector3d> skeleton() const;
  /// All that decides about it.
  void append_to(ByteKey& key) const { key.add(kind, X_LS, size, points, triangles); }
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
