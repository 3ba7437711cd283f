#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/planning/task_region.hpp"

namespace mjarm::detail {

/// [rad or m, L2] the longest steps of searches within regions.
inline constexpr double kKeptRange = 0.3;

/// What a straight edge between two configurations moves, summed over its joints.
struct EdgeMotion {
  double turn = 0;   ///< [rad] L of RegionProof
  double place = 0;  ///< [m] A of RegionProof
  double speed = 0;  ///< [m] S of RegionProof
};

/// The tool as a region sees it.
struct SeenTool {
  Pose X_RF;         ///< with R where the mechanism has it
  double value = 0;  ///< [rad] or [m] of the mechanism
  double off = 0;    ///< [m] of F from the axis of a hinge
};

/// Proves that the tool keeps within one region. All bounds are read off numbers that change slowly
/// along an edge: the place of F, and what a unit vector of F has along a unit vector of R. Along
/// an edge, of which the parameter runs from 0 to 1, such a vector has a second derivative of at
/// most L^2, where L sums the angles of the joints (it is a product of rotations about fixed axes
/// times a fixed vector), and the place one of at most A, the sum over two joints of both angles
/// times the lever of the later one. So between two places each number is within h^2 L^2 / 8, or
/// h^2 A / 8, of the straight line between its values there.
///
/// Where R hangs on a mechanism, this stands at value_for() at the ends of a part, and moves evenly
/// between them: so it stays in its range, and never jumps. Seen from a door the arm has one more
/// joint, at its base, that turns back by the angle d of the door in this part. A place is then
/// y'' - 2 d k x y' + d^2 k x (k x y) turned back, with y from the axis k to F in the world: its
/// second derivative is at most h^2 A + 2 d h S + d^2 D, where S, the sum of the angles of the
/// joints times their levers, bounds how fast F goes, and D how far it is from the axis, at most
/// half of what it is at both ends and h S. Of a unit vector it is at most (h L + d)^2. A drawer
/// that moves evenly adds nothing.
class RegionProof {
 public:
  /// @param region  is_sound().
  RegionProof(const TaskRegion& region, const Arm& arm);

  [[nodiscard]] const TaskRegion& region() const noexcept { return region_; }
  /// [rad or m, L2] edges that are no longer mostly bulge by less than what there is room for.
  [[nodiscard]] double range() const noexcept { return range_; }
  [[nodiscard]] SeenTool see(const Pose& X_WT) const;
  [[nodiscard]] EdgeMotion motion(std::span<const double> q0, std::span<const double> q1) const;

  /// The room that is left on a part of an edge; 0 and more where the region is kept.
  /// @param a, b    the ends of the part.
  /// @param motion  of the edge.
  /// @param part    share of the edge, h above.
  [[nodiscard]] RegionRoom room(const SeenTool& a, const SeenTool& b, const EdgeMotion& motion,
                                double part) const;

  /// Appends what brings X_RF back: rows of a Jacobian, and by how much each has to grow. The
  /// mechanism stands where it is.
  /// @param at  the arm, at X_RF.
  void add_rows(const FkJacobian& at, std::vector<JointVec>& rows,
                std::vector<double>& needs) const;

 private:
  void find_idle_joints(const Arm& arm);
  [[nodiscard]] RegionRoom between(const Pose& a, const Pose& b, double place, double turn) const;
  [[nodiscard]] double room_to_turn(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b,
                                    double bulge) const;

  TaskRegion region_;
  Pose X_RW_, X_TF_;
  bool leans_ = false;  // whether the lean is bounded
  bool hangs_on_hinge_ = false;
  int dof_ = 0;
  std::array<bool, kMaxDof> hinge_{};
  std::array<double, kMaxDof> lever_{};  // [m] from the joint to F, without the slides between
  int first_turn_ = 0, last_turn_ = 0;   // joints first <= k < last can change what is bounded
  int first_place_ = 0;
  double range_ = 0;
};

}  // namespace mjarm::detail
