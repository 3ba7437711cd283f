#pragma once

#include <Eigen/Core>
#include <limits>
#include <span>
#include <vector>

#include "mjarm/collision/byte_key_internal.hpp"
#include "mjarm/collision/cover_solid_internal.hpp"
#include "mjarm/collision/sphere_set.hpp"
#include "mjarm/core/pose.hpp"

namespace mjarm::detail {

/// A convex solid, made ready for many questions about its distance: a core, and a radius that is
/// put round it. It has a frame L of its own.
class Convex {
 public:
  explicit Convex(const CoverSolid& solid);
  /// The hull of a few points (at least one), which are in L.
  explicit Convex(std::span<const Eigen::Vector3d> points);

  [[nodiscard]] double radius() const noexcept { return radius_; }  ///< [m] round the core
  /// A ball round the core.
  [[nodiscard]] const Eigen::Vector3d& center() const noexcept { return center_; }  ///< in L
  [[nodiscard]] double reach() const noexcept { return reach_; }                    ///< [m]

  /// Where its own frame S is; that of a hull is L.
  [[nodiscard]] const Pose& frame() const noexcept { return X_LS_; }
  /// The point of the core that is farthest along `n`; both in S.
  /// @param hint  of a call before, or 0; makes the search short.
  [[nodiscard]] Eigen::Vector3d farthest(const Eigen::Vector3d& n, int& hint) const noexcept;
  /// Directions in L that faces look to: along one of them the solid is thin.
  [[nodiscard]] const std::vector<Eigen::Vector3d>& normals() const noexcept { return normals_; }
  /// All that decides about distances from it.
  void append_to(ByteKey& key) const;
  /// A ball in the solid, in L: the largest, but in a hull, where it may be a few percent less. Of
  /// a few points it has no radius.
  [[nodiscard]] Sphere inscribed_ball() const;

 private:
  [[nodiscard]] int climb(const Eigen::Vector3d& n, int from) const noexcept;
  void join(const std::vector<HullTriangle>& triangles);
  [[nodiscard]] Sphere ball_between_faces() const;

  SolidKind kind_ = SolidKind::hull;
  Pose X_LS_;
  Eigen::Vector3d size_ = Eigen::Vector3d::Zero();
  double radius_ = 0;
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero();
  double reach_ = 0;
  std::vector<Eigen::Vector3d> points_;  // of a hull, in L
  std::vector<int> first_, neighbours_;  // of each point, where there are many
  std::vector<Eigen::Vector3d> normals_;
};

/// How far two cores A and B are apart.
struct Separation {
  /// [m] Along `normal` all of A is at least so far beyond all of B, which does not depend on how
  /// the normal was found. Negative: nothing is proved.
  double gap = -std::numeric_limits<double>::infinity();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  ///< unit, from B to A, in the world
  /// [m] Two of their points are no farther apart than that; 0: they overlap.
  double distance = std::numeric_limits<double>::infinity();
};

/// What is asked of separate().
struct SeparateLimits {
  double enough = std::numeric_limits<double>::infinity();  ///< [m] a larger gap ends the search
  double too_near = 0;                                      ///< [m] >= 0, so does less distance
};

/// The distance of two cores (E. G. Gilbert, D. W. Johnson and S. S. Keerthi, A fast procedure for
/// computing the distance between complex objects in three-dimensional space, IEEE Journal of
/// Robotics and Automation 4 (1988) 193), to a part in 1e6 where neither limit ends it.
[[nodiscard]] Separation separate(const Convex& a, const Pose& X_WA, const Convex& b,
                                  const Pose& X_WB, const SeparateLimits& limits = {}) noexcept;

/// [m] How far A has to be moved to be out of B, as far as the directions of their faces and some
/// others tell: exact where a face is in the way, else a little too much. Radii count.
[[nodiscard]] double depth_of_overlap(const Convex& a, const Pose& X_WA, const Convex& b,
                                      const Pose& X_WB) noexcept;

}  // namespace mjarm::detail
