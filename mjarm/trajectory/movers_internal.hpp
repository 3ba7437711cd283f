#pragma once

#include <array>
#include <optional>

#include "mjarm/trajectory/point_to_point.hpp"
#include "mjarm/trajectory/ranged_joint_internal.hpp"
#include "mjarm/trajectory/recovery_internal.hpp"

namespace mjarm::detail {

/// One joint: the motion back within the limits, and all fastest ones from there; those that stay
/// in its range once they are asked for.
class Mover {
 public:
  /// @param room  around the start.
  Mover(const OneJoint& joint, const Room& room) noexcept;

  /// First duration >= `from` [s] in which the joint can do its move, whatever its range.
  [[nodiscard]] double first_possible(double from) const noexcept;
  /// The same of motions in the range, of a joint that does not have to leave it.
  [[nodiscard]] double first_in_range(double from) noexcept;
  /// The motion so long: in the range, if `first_in_range` had to look for one.
  [[nodiscard]] Phases motion(double duration) const noexcept;
  /// Whether that motion stays in the range.
  [[nodiscard]] bool stays(double duration) const noexcept;
  /// Why joint `i` has no motion in its range, but for one that is over before it leaves it.
  [[nodiscard]] std::optional<PointToPointFailure> leaves(int i) const noexcept;

 private:
  [[nodiscard]] Phases return_phases() const noexcept;
  static OneJoint after(OneJoint joint, const Recovery& recovery) noexcept;

  Recovery recovery_;
  OneJoint joint_;  // after the recovery
  JointTimes times_;
  double v0_;        // [rad/s or m/s] before the recovery
  Room room_;        // around the start
  Room room_after_;  // around where the recovery ends
  std::optional<RangedJoint> ranged_;
};

/// All joints of a problem.
class Movers {
 public:
  /// @return why there is no motion.
  std::optional<PointToPointFailure> set(const JointState& start, const JointState& end,
                                         const JointLimits& limits) noexcept;
  /// Makes `duration`, the common one, one in which all joints have motions in their ranges:
  /// nothing to do where they stay in them anyway. @return why there is none.
  std::optional<PointToPointFailure> keep_ranges(double& duration) noexcept;

  [[nodiscard]] const Mover& operator[](int i) const noexcept {
    return *movers_[static_cast<std::size_t>(i)];
  }
  /// The shortest duration in which all joints can do their moves, whatever their ranges.
  [[nodiscard]] double common_duration() const noexcept;

 private:
  int dof_ = 0;
  std::array<std::optional<Mover>, kMaxDof> movers_;
};

}  // namespace mjarm::detail
