#include <algorithm>
#include <cmath>
#include <limits>

#include "mjarm/trajectory/movers_internal.hpp"
#include "mjarm/trajectory/sound_state_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr double kNoise = 8 * std::numeric_limits<double>::epsilon();  // of both ends

/// Room of a joint within its range, which is widened to hold both ends.
Room room_of(const JointLimits& limits, const JointState& start, const JointState& end, int i) {
  if (limits.lower.size() == 0) return {};
  const double way = end.q[i] - start.q[i];
  return {std::min({limits.lower[i] - start.q[i], 0.0, way}),
          std::max({limits.upper[i] - start.q[i], 0.0, way})};
}

bool has_ranges(const JointLimits& limits, int dof) {
  if (limits.lower.size() == 0 && limits.upper.size() == 0) return true;
  return limits.lower.size() == dof && limits.upper.size() == dof &&
         (limits.lower.array() <= limits.upper.array()).all();
}

std::optional<PointToPointErrc> fault(const OneJoint& joint) noexcept {
  const double r = joint.inverse_jerk;
  const bool limited = std::isfinite(joint.a_max) || r > 0;
  if (!(joint.v_max > 0 && joint.a_max > 0 && r >= 0 && std::isfinite(r) && limited)) {
    return PointToPointErrc::bad_limits;
  }
  // The velocity it comes from when it arrives with an acceleration.
  const double before = joint.v1 - 0.5 * r * joint.a1 * std::abs(joint.a1);
  constexpr double kSlack = 1 + kLimitSlack;
  if (std::max(std::abs(joint.v1), std::abs(before)) > joint.v_max * kSlack ||
      std::abs(joint.a1) > joint.a_max * kSlack) {
    return PointToPointErrc::end_outside;
  }
  return std::nullopt;
}

}  // namespace

Mover::Mover(const OneJoint& joint, const Room& room) noexcept
    : recovery_(joint),
      joint_(after(joint, recovery_)),
      times_(joint_),
      v0_(joint.v0),
      room_(room),
      room_after_{room.below - recovery_.way, room.above - recovery_.way} {}

/// Limits are widened to hold what rounding leaves of the ends.
OneJoint Mover::after(OneJoint joint, const Recovery& recovery) noexcept {
  joint.v0 = recovery.v;
  joint.a0 = recovery.a;
  joint.way -= recovery.way;
  const double r = joint.inverse_jerk;
  joint.a_max = std::max({joint.a_max, std::abs(joint.a0), std::abs(joint.a1)});
  joint.v_max = std::max({joint.v_max, std::abs(joint.v0 + 0.5 * r * joint.a0 * std::abs(joint.a0)),
                          std::abs(joint.v1 - 0.5 * r * joint.a1 * std::abs(joint.a1))});
  return joint;
}

double Mover::first_possible(double from) const noexcept {
  const double rest = times_.first_possible(from - recovery_.duration);
  return rest > from - recovery_.duration ? std::max(from, recovery_.duration + rest) : from;
}

double Mover::first_in_range(double from) noexcept {
  if (stays(from) && (ranged_ || first_possible(from) == from)) return from;
  if (!ranged_) ranged_.emplace(joint_, times_, room_after_);
  const double first = ranged_->first_possible(std::max(0.0, from - recovery_.duration));
  return std::max(from, recovery_.duration + first);
}

Phases Mover::return_phases() const noexcept {
  Phases out;
  for (const JerkPhase& phase : recovery_.phases) out.add(phase.duration, phase.a, phase.jerk);
  return out;
}

Phases Mover::motion(double duration) const noexcept {
  Phases out = return_phases();
  const double rest = duration - recovery_.duration;
  if (ranged_) {
    if (const auto in_range = ranged_->motion(rest)) {
      out.append(*in_range);
      return out;
    }
  }
  append_blend(times_, joint_.way, rest, out);
  return out;
}

bool Mover::stays(double duration) const noexcept {
  return !room_.limited() || room_.holds(motion(duration), v0_, joint_.noise);
}

std::optional<PointToPointFailure> Mover::leaves(int i) const noexcept {
  const Extent back = return_phases().extent(v0_);
  const double over =
      std::max({back.high - room_.above, room_.below - back.low, overshoot(joint_, room_after_)});
  if (over > joint_.noise) {
    return PointToPointFailure{PointToPointErrc::start_leaves_range, i, over};
  }
  const double before = overshoot(reversed(joint_), reversed(joint_, room_after_));
  if (before > 0) return PointToPointFailure{PointToPointErrc::end_leaves_range, i, before};
  return std::nullopt;
}

std::optional<PointToPointFailure> Movers::set(const JointState& start, const JointState& end,
                                               const JointLimits& limits) noexcept {
  dof_ = static_cast<int>(start.q.size());
  if (!is_sound(start, dof_) || !is_sound(end, dof_)) {
    return PointToPointFailure{PointToPointErrc::bad_states, 0};
  }
  if (limits.velocity.size() != dof_ || limits.acceleration.size() != dof_ ||
      limits.jerk.size() != dof_ || !has_ranges(limits, dof_)) {
    return PointToPointFailure{PointToPointErrc::bad_limits, 0};
  }
  for (int i = 0; i < dof_; ++i) {
    const double r = 1 / limits.jerk[i], way = end.q[i] - start.q[i];
    // Without a jerk limit the acceleration jumps, whatever it was.
    const double a0 = r == 0 ? 0 : start.a[i], a1 = r == 0 ? 0 : end.a[i];
    const OneJoint joint{start.v[i],
                         a0,
                         end.v[i],
                         a1,
                         way,
                         limits.velocity[i],
                         limits.acceleration[i],
                         r,
                         kNoise * (std::abs(start.q[i]) + std::abs(end.q[i]))};
    if (const auto code = fault(joint)) return PointToPointFailure{*code, i};
    movers_[static_cast<std::size_t>(i)].emplace(joint, room_of(limits, start, end, i));
  }
  return std::nullopt;
}

/// Whatever a joint asks for bounds all from below; the first duration that suits all is the
/// answer. Each asks for a few later ones at most, one for each of its gaps.
double Movers::common_duration() const noexcept {
  double duration = 0;
  for (int i = 0, content = 0; content < dof_; i = (i + 1) % dof_) {
    const double asked = (*this)[i].first_possible(duration);
    content = asked > duration ? 1 : content + 1;
    duration = std::max(duration, asked);
  }
  return duration;
}

std::optional<PointToPointFailure> Movers::keep_ranges(double& duration) noexcept {
  bool stay = true;
  for (int i = 0; i < dof_; ++i) {
    if ((*this)[i].stays(duration)) continue;
    stay = false;
    if (const auto failure = (*this)[i].leaves(i)) return failure;
  }
  if (stay) return std::nullopt;
  constexpr int kMaxRounds = 64;
  for (int n = 0, content = 0; content < dof_; ++n) {
    const int i = n % dof_;
    if (!(*this)[i].stays(duration)) {
      if (const auto failure = (*this)[i].leaves(i)) return failure;
    }
    const double asked = movers_[static_cast<std::size_t>(i)]->first_in_range(duration);
    const bool found = std::isfinite(asked) && (*this)[i].stays(asked);
    if (!found || n > kMaxRounds * dof_) return PointToPointFailure{PointToPointErrc::no_room, i};
    content = asked > duration ? 1 : content + 1;
    duration = std::max(duration, asked);
  }
  return std::nullopt;
}

}  // namespace mjarm::detail
