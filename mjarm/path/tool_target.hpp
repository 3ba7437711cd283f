#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mjarm/collision/exact.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/kinematics/singularity.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// Whether and how well the target of a tool is reached.
enum class TargetGrade {
  good,
  near_limit,     ///< a joint is nearer than 0.1 rad or m to its limit
  near_singular,  ///< `Singularity::kind` is not none
  jump,           ///< only from another branch, which is not taken by itself
  unreachable,
};

/// Along the axes of what the target is jogged. The axes of the base are those of the first joint's
/// frame at 0: for a robot that stands turned, those of its own foot.
enum class JogFrame { world, tool, base };

/// What a target asks about contact of the arm at `q`, shape (dof,) [rad or m]. Empty functions:
/// contact does not count.
struct TargetContact {
  std::function<bool(std::span<const double> q)> is_free = {};
  /// What is_free() is about; none where that cannot be told.
  std::function<std::optional<CollisionReport>(std::span<const double> q)> look = {};
};
/// By an exact checker, which copies share. Contact counts where the arm is free of it at home;
/// else nothing could be reached. `arm` must come from `model`.
[[nodiscard]] TargetContact exact_contact(const Model& model, const Arm& arm);

/// A target for a tool that the arm is to follow: it is led from pose to pose in small steps, so
/// that the joints never jump, without contact (unless the arm stands in contact at home). Six
/// joints and more take position and orientation, fewer the position alone. Knows no window.
class ToolTarget {
 public:
  /// The target is where the tool is at home.
  explicit ToolTarget(const Arm& arm, TargetContact contact = {});
  /// With exact_contact(). `arm` must come from `model`.
  ToolTarget(const Model& model, const Arm& arm) : ToolTarget(arm, exact_contact(model, arm)) {}

  /// The target is where the tool is at `q`, shape (dof,) [rad or m].
  void set_goal(const JointVec& q);
  /// Leads the target to X_WT, as straight as can be. The goal goes along as far as it can; where
  /// that is not to the end, it stays at the edge and `failure` or `jump` tell why.
  void move_to(const Pose& X_WT);
  /// Moves the target along (axis 0 to 2, `amount` [m]) or turns it about (3 to 5, [rad]) an axis
  /// of a frame; turning leaves its origin where it is. One that cannot be reached begins anew at
  /// the tool, where the arm stays.
  /// @return false where that could not be reached: then the target is where it was, and `line`
  ///         tells why.
  bool jog(JogFrame frame, int axis, double amount);
  /// Takes the answer that needs a jump as the goal; nothing where there is none.
  void take_jump();
  /// The postures that reach the target without contact, the nearest to the goal first (the goal
  /// itself is one of them where it does): all branches of a closed form, else those that random
  /// starts find; samples for a redundant arm. Takes microseconds in closed form, milliseconds
  /// else.
  /// @param max  so many at most, > 0.
  [[nodiscard]] std::vector<JointVec> postures(int max) const;
  /// Takes a posture that reaches the target as the goal.
  void take_posture(const JointVec& q);
  /// Which gives any answer, and the reasons.
  [[nodiscard]] const IkSolver& solver() const noexcept { return any_; }

  /// X_WT as it was asked for.
  [[nodiscard]] const Pose& pose() const noexcept { return X_WT_; }
  /// Where the arm shall go, shape (dof,) [rad or m]: the answer for the target, else for the last
  /// pose on the way to it that could be reached.
  [[nodiscard]] const JointVec& goal() const noexcept { return goal_; }
  [[nodiscard]] TargetGrade grade() const noexcept { return standing_.grade; }
  [[nodiscard]] bool is_reached() const noexcept { return grade() < TargetGrade::jump; }
  /// Why the target is not reached, where it is not.
  [[nodiscard]] const std::optional<IkFailure>& failure() const noexcept {
    return standing_.failure;
  }
  /// The answer that needs a jump, where there is only that one.
  [[nodiscard]] const std::optional<JointVec>& jump() const noexcept { return standing_.jump; }
  /// [rad or m] from the goal to the nearest limit, infinite where there is none, and the joint
  /// that it belongs to; how near the goal is to a singularity. Of the goal also where
  /// the target is not reached.
  [[nodiscard]] double room() const noexcept { return standing_.room; }
  [[nodiscard]] int tightest() const noexcept { return standing_.tightest; }
  [[nodiscard]] const Singularity& singular() const noexcept { return standing_.singular; }
  /// One line for people in the language in use: how near to a limit and a singularity, or why not.
  [[nodiscard]] std::string line() const;
  /// Axes of a frame as columns, in the world.
  [[nodiscard]] Eigen::Matrix3d axes(JogFrame frame) const;
  [[nodiscard]] bool turns() const noexcept { return task_ == IkTask::pose; }
  [[nodiscard]] const Arm& arm() const noexcept { return near_.arm(); }

 private:
  /// How a pose is reached, or why not.
  struct Standing {
    TargetGrade grade = TargetGrade::good;
    double room = 0;   ///< [rad or m] from the joint `tightest` to its limit
    int tightest = 0;  ///< the joint that is nearest to a limit
    Singularity singular = {};
    std::optional<IkFailure> failure = {};
    std::optional<CollisionReport> contact = {};  ///< of the best attempt, where that touches
    std::optional<JointVec> jump = {};
  };
  [[nodiscard]] bool lead(const Pose& X_to);
  void turn_with_tool();
  [[nodiscard]] bool is_connected(const JointVec& from, const JointVec& to);
  [[nodiscard]] Standing rate() const;
  [[nodiscard]] Standing refuse(IkFailure failure);
  [[nodiscard]] std::string line_of(const Standing& standing) const;
  [[nodiscard]] std::string jump_line(const JointVec& to) const;

  IkTask task_;
  TargetContact contact_;
  IkSolver near_;  ///< answers next to the last one
  IkSolver any_;   ///< any answer, and the reasons
  Pose X_WT_;
  JointVec goal_;
  Standing standing_;
  std::optional<Standing> refused_;  ///< of a pose that the last jog did not reach
};

}  // namespace mjarm
