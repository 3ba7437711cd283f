#pragma once

#include <Eigen/Core>
#include <optional>

#include "mjarm/core/pose.hpp"
#include "mjarm/model/arm.hpp"

namespace mjarm {

struct AxisChain;

/// The shapes a proof of unreachability speaks of.
enum class ReachShape {
  none,
  outer_sphere,     ///< farther from a base point than the links can stretch
  inner_sphere,     ///< nearer to a base point than the links can fold
  cylinder,         ///< nearer to the base axis than the constant side offset of the arm
  elbow_stretched,  ///< in this orientation, farther from joint 2 than both links stretch
  elbow_folded,     ///< in this orientation, nearer to joint 2 than both links fold
  wrist_cone,       ///< a direction outside the cone of a slanting wrist; amounts are sines
};

/// Why no joint values whatever can reach a pose.
struct ReachBreach {
  ReachShape shape = ReachShape::none;
  double amount = 0;  ///< [m] how far beyond the bound, > 0
  double bound = 0;   ///< [m] the radius that is broken
};

/// What an arm cannot reach, as proofs from its geometry; valid for every serial chain of hinges
/// and slides. A pose of the tool fixes every point of the last link. For hinges, a chain of
/// points, one on each joint axis, has constant distances between neighbours, so the triangle
/// inequality bounds the distance from a point of the first axis (fixed in the world) to one of the
/// last (fixed in the tool) from above and below. The points are placed so that the upper bound is
/// smallest, which puts them where axes meet: the shoulder and the wrist centre. Where a limited
/// joint lies between two links, the range of the distance across both is used instead. Slides add
/// half of their travel.
class Reach {
 public:
  explicit Reach(const Arm& arm);

  /// A proof that X_WT is out of reach, else nothing (which proves nothing). The largest breach is
  /// returned, outer sphere first.
  [[nodiscard]] std::optional<ReachBreach> check(const Pose& X_WT) const noexcept;

  /// The same for the tool's origin at `p_WT` in every orientation; spheres and cylinder are wider
  /// or narrower by the distance of the tool's fixed points from its origin.
  [[nodiscard]] std::optional<ReachBreach> check_position(
      const Eigen::Vector3d& p_WT) const noexcept;

  /// [m] farthest the tool's fixed point gets from the base point; infinite for endless slides.
  [[nodiscard]] double outer() const noexcept { return outer_; }
  /// [m] nearest the same two points get; 0 where no bound is known.
  [[nodiscard]] double inner() const noexcept { return inner_; }
  /// [m] radius of the cylinder round the base axis; 0 where there is none.
  [[nodiscard]] double cylinder() const noexcept { return cylinder_; }
  /// [m] the base point in the world.
  [[nodiscard]] const Eigen::Vector3d& base_point() const noexcept { return p_WA_; }

 private:
  void set_cylinder(const AxisChain& chain);
  /// `p_WB`, `p_WC`: the tool's points, each known to within its slack [m].
  [[nodiscard]] std::optional<ReachBreach> check_points(const Eigen::Vector3d& p_WB, double slack_B,
                                                        const Eigen::Vector3d& p_WC,
                                                        double slack_C) const noexcept;

  Eigen::Vector3d p_WA_ = Eigen::Vector3d::Zero();  // base point, in the world
  Eigen::Vector3d p_TB_ = Eigen::Vector3d::Zero();  // tool point, in the tool
  double outer_ = 0;
  double inner_ = 0;
  double cylinder_ = 0;
  Eigen::Vector3d axis_W_ = Eigen::Vector3d::UnitZ();  // base axis through p_WC_
  Eigen::Vector3d p_WC_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_TC_ = Eigen::Vector3d::Zero();  // the point that stays out of the cylinder
};

}  // namespace mjarm
