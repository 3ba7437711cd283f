#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <span>

#include "mjarm/trajectory/extremal_internal.hpp"

namespace mjarm::detail {

/// Lowest and highest way of a motion, and the state in which it ends.
struct Extent {
  double low, high;  ///< [rad or m] from where the motion starts
  double way, v;     ///< [rad or m], [rad/s or m/s] in the end
};

/// Stretches of constant jerk of one joint, one after another. The longest motion has two blends of
/// 7 stretches with 7.
class Phases {
 public:
  static constexpr std::size_t kMax = 26;

  /// Nothing for a duration that is not above 0.
  void add(double duration, double a, double jerk) noexcept {
    if (!(duration > 0)) return;
    assert(count_ < kMax);
    all_[count_++] = {duration, a, jerk};
  }
  void clear() noexcept { count_ = 0; }
  void append(const Phases& after) noexcept;
  /// The same way backwards in time: what led to a state when `before` starts in it with the
  /// opposite velocity.
  void append_reversed(const Phases& before) noexcept;

  [[nodiscard]] std::span<const JerkPhase> all() const noexcept { return {all_.data(), count_}; }
  [[nodiscard]] double duration() const noexcept;
  [[nodiscard]] Phases mirrored() const noexcept;
  /// @param v  [rad/s or m/s] velocity when they begin.
  [[nodiscard]] Extent extent(double v) const noexcept;
  /// [rad or m] How far they lead, as `extent` has it.
  [[nodiscard]] double way(double v) const noexcept;

 private:
  std::array<JerkPhase, kMax> all_;
  std::size_t count_ = 0;
};

/// Appends two motions of one joint laid over another, with weights that add up to 1: the farthest
/// and the nearest one of this duration [s], such that the joint goes `way`. The limits are convex,
/// so what keeps them twice keeps them in between.
void append_blend(const JointTimes& times, double way, double duration, Phases& out) noexcept;

/// Appends the fastest change of velocity to `v`, there without acceleration.
/// @param joint  starts with `v0` and `a0`; `a_max` and `inverse_jerk` hold.
void append_change(const OneJoint& joint, double v, Phases& out) noexcept;

/// Appends full braking of a joint that moves up, or will, until it does not.
void append_brake(const OneJoint& joint, Phases& out) noexcept;

}  // namespace mjarm::detail
