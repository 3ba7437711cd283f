#pragma once

#include <array>
#include <limits>

namespace mjarm::detail {

/// One joint between two velocities and accelerations: how far can it get in a given time? Of all
/// motions of duration T that keep the limits, the farthest one has the jerk +, 0, -, 0, + (L. S.
/// Pontryagin et al., The Mathematical Theory of Optimal Processes, 1962: the sign of the jerk is
/// that of a convex parabola in time), with a cruise in its middle where the velocity limit is met,
/// and it follows from T in closed form. The nearest one is the farthest of the mirrored move.
///
/// All limits are > 0. A jerk limit of infinity is 1 / jerk = 0; velocity or acceleration limits
/// may be infinite, but not both of acceleration and jerk.
struct OneJoint {
  double v0, a0;        ///< [rad/s], [rad/s^2] start
  double v1, a1;        ///< end
  double way;           ///< [rad] to go
  double v_max, a_max;  ///< [rad/s], [rad/s^2]
  double inverse_jerk;  ///< [s^3/rad]

  [[nodiscard]] OneJoint mirrored() const noexcept {
    return {-v0, -a0, -v1, -a1, -way, v_max, a_max, inverse_jerk};
  }
};

/// A stretch of constant jerk.
struct JerkPhase {
  double duration;  ///< [s] >= 0
  double a;         ///< [rad/s^2] when it begins
  double jerk;      ///< [rad/s^3]
};

/// The farthest motion of one duration: acceleration up to `a_top`, held, down to `a_low`, held,
/// up to that of the end; on the way down a cruise while the acceleration is 0.
struct Farthest {
  double a_top, top_time;
  double a_low, low_time;
  double cruise;
};

/// The farthest motions of one joint, for all durations for which `Durations` has motions at all.
class Reach {
 public:
  explicit Reach(const OneJoint& joint) noexcept;

  struct Value {
    double way;    ///< [rad] farthest way to get in that time
    double speed;  ///< [rad/s] its derivative with respect to the time
  };
  [[nodiscard]] Value at(double duration) const noexcept;
  [[nodiscard]] std::array<JerkPhase, 7> phases(double duration) const noexcept;
  /// First duration in [from, until] in which the joint can go as far as it has to; infinity if
  /// none. `until` is infinite or the end of the durations that have motions.
  [[nodiscard]] double first_far_enough(double from, double until) const noexcept;

 private:
  [[nodiscard]] Farthest without_cruise(double duration) const noexcept;
  [[nodiscard]] Value measured(const Farthest& motion) const noexcept;
  [[nodiscard]] double first_on_convex(double from, double until, Value value) const noexcept;
  [[nodiscard]] double bend_time() const noexcept;

  OneJoint joint_;
  double gain_;         // [rad/s] velocity to gain beyond what the ends' own ramps bring
  double ramp_time_;    // [s] by which the jerk phases up outlast the ones down
  Farthest fastest_;    // the motion that just meets the velocity limit,
  double cruise_from_;  // [s] its duration,
  double cruise_way_;   // [rad] and its way
};

/// The durations for which the joint has motions between its velocities, whatever the way: all from
/// `from` on, but for an open gap.
struct Durations {
  explicit Durations(const OneJoint& joint) noexcept;

  double from;
  double gap_from = std::numeric_limits<double>::infinity();
  double gap_to = std::numeric_limits<double>::infinity();
};

/// Everything about one joint that finding a common duration takes.
class JointTimes {
 public:
  explicit JointTimes(const OneJoint& joint) noexcept;

  /// First duration >= `from` in which the joint can do its move.
  [[nodiscard]] double first_possible(double from) const noexcept;
  [[nodiscard]] const Reach& up() const noexcept { return up_; }
  [[nodiscard]] const Reach& down() const noexcept { return down_; }

 private:
  Durations durations_;
  Reach up_;
  Reach down_;
};

}  // namespace mjarm::detail
