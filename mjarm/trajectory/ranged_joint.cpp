#include <algorithm>
#include <cmath>

#include "mjarm/trajectory/ranged_joint_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
// Of the largest numbers in a motion, what rounding may leave beyond the room; turns keep away from
// its ends by more.
constexpr double kRoomRounding = 1e-13, kAway = 1e-11;
constexpr double kTimeRounding = 1e-14;  // of a duration

/// Joint `from` to a velocity and an acceleration somewhere else.
OneJoint leg(const OneJoint& joint, double v0, double a0, double v1, double a1, double way) {
  OneJoint out = joint;
  out.v0 = v0, out.a0 = a0, out.v1 = v1, out.a1 = a1, out.way = way;
  return out;
}

/// The most that full braking takes up, and the deceleration in the end.
struct Brake {
  double way, a;
};
Brake braking(const OneJoint& joint) noexcept {
  Phases phases;
  append_brake(joint, phases);
  if (phases.all().empty()) return {0, 0};
  const JerkPhase& last = phases.all().back();
  return {phases.way(joint.v0), last.a + last.duration * last.jerk};
}

/// To rest: as fast as possible, or else with full braking and back, away from the limit.
std::optional<Phases> stop_in(const OneJoint& joint, const Room& room) noexcept {
  Phases stop;
  append_change(joint, 0, stop);
  if (room.holds(stop, joint.v0, joint.noise)) return stop;
  for (const double sign : {1.0, -1.0}) {
    const OneJoint up = sign > 0 ? joint : joint.mirrored();
    Phases back;
    append_brake(up, back);
    if (back.all().empty()) continue;  // it goes the other way
    append_change(leg(up, 0, braking(up).a, 0, 0, 0), 0, back);
    if (sign < 0) back = back.mirrored();
    if (room.holds(back, joint.v0, joint.noise)) return back;
  }
  return std::nullopt;
}

/// Appends a blend of exactly that duration; false where there is none.
bool append_exactly(const OneJoint& joint, const JointTimes& times, double duration,
                    Phases& out) noexcept {
  const double possible = times.first_possible(duration);
  if (!(possible <= duration + kTimeRounding * (1 + std::abs(duration)))) return false;
  append_blend(times, joint.way, possible, out);
  return true;
}

}  // namespace

bool Room::holds(const Phases& motion, double v, double noise) const noexcept {
  const Extent extent = motion.extent(v);
  const double rounding = noise + kRoomRounding * (extent.high - extent.low);
  return extent.low >= below - rounding && extent.high <= above + rounding;
}

OneJoint reversed(const OneJoint& joint) noexcept {
  return leg(joint, -joint.v1, joint.a1, -joint.v0, joint.a0, -joint.way);
}

Room reversed(const OneJoint& joint, const Room& room) noexcept {
  return {room.below - joint.way, room.above - joint.way};
}

double overshoot(const OneJoint& joint, const Room& room) noexcept {
  const double up = braking(joint).way - room.above;
  const double down = braking(joint.mirrored()).way + room.below;
  const double over = std::max(up, down);
  return over > joint.noise + kRoomRounding * std::abs(joint.way) ? over : 0;
}

RangedJoint::RangedJoint(const OneJoint& joint, const JointTimes& times, const Room& room) noexcept
    : joint_(joint), times_(times), room_(room), stopping_from_(kNever) {
  stop_ = stop_in(joint, room);
  const OneJoint back = reversed(joint);
  if (const auto to_rest = stop_in(back, reversed(joint, room))) {
    go_.emplace().append_reversed(*to_rest);
  }
  if (!stop_ || !go_) return;
  const double way = joint.way - stop_->way(joint.v0) - go_->way(0);
  const JointTimes move(leg(joint, 0, 0, 0, 0, way));
  stopping_from_ = stop_->duration() + move.first_possible(0) + go_->duration();
}

bool RangedJoint::fits(const Phases& motion) const noexcept {
  return room_.holds(motion, joint_.v0, joint_.noise);
}

std::optional<Phases> RangedJoint::blended(double duration) const noexcept {
  Phases out;
  if (!append_exactly(joint_, times_, duration, out) || !fits(out)) return std::nullopt;
  return out;
}

/// @param left  [rad or m] missing in the end.
/// @return false where the changes of velocity alone take longer.
bool RangedJoint::cruise_at(double v, double duration, Phases& out, double& left) const noexcept {
  Phases back;
  out.clear();
  append_change(joint_, v, out);
  append_change(reversed(joint_), -v, back);
  const double time = duration - out.duration() - back.duration();
  if (time < 0) return false;
  out.add(time, 0, 0);
  out.append_reversed(back);
  left = joint_.way - out.way(joint_.v0);
  return true;
}

/// Of all cruises of one duration the faster one goes farther, as its velocity is larger at all
/// times: one that goes as far as it has to lies between one that does not and one that goes
/// farther or has no time for its changes of velocity. The search begins at a velocity that is
/// there with the least effort: regula falsi (the Illinois form of M. Dowell, P. Jarratt, BIT 11
/// (1971) 168), and halving where only one end is known.
std::optional<Phases> RangedJoint::cruising(double duration) const noexcept {
  constexpr double kExact = 1e-3;  // of what rounding may leave
  constexpr int kSteps = 80, kHalve = 8;
  const double r = 0.5 * joint_.inverse_jerk;
  const double flat[] = {joint_.v0 + r * joint_.a0 * std::abs(joint_.a0),
                         joint_.v1 - r * joint_.a1 * std::abs(joint_.a1)};
  for (const double near : flat) {
    double missing = 0;
    Phases out;
    if (!cruise_at(near, duration, out, missing)) continue;
    const double sign = missing > 0 ? 1 : -1;
    double low = near, high = std::isfinite(joint_.v_max)
                                  ? sign * joint_.v_max
                                  : near + 2 * missing / std::max(duration, 1e-300) + sign;
    const double scale = joint_.noise + 1e-12 * (std::abs(joint_.way) + duration * std::abs(low));
    double at_low = sign * missing, at_high = 0;  // the latter 0 where it is not known, else < 0
    int moved = 0;  // the end that moved last: 1 for `low`, -1 for `high`
    for (int i = 1; i <= kSteps && std::abs(missing) > kExact * scale; ++i) {
      const bool halve = at_high == 0 || i % kHalve == 0;
      const double share = halve ? 0.5 : at_low / (at_low - at_high);
      const double v = low + share * (high - low);
      if (v == low || v == high) break;
      double left = 0;
      const bool possible = cruise_at(v, duration, out, left);
      if (possible && sign * left >= 0) {
        if (moved == 1) at_high *= 0.5;
        low = v, at_low = sign * left, moved = 1;
        missing = left;
      } else {
        if (moved == -1) at_low *= 0.5;
        high = v, at_high = possible ? sign * left : 0, moved = -1;
      }
    }
    if (!(std::abs(missing) <= scale) || !cruise_at(low, duration, out, missing)) continue;
    if (fits(out)) return out;
  }
  return std::nullopt;
}

std::optional<Phases> RangedJoint::stopping(double duration) const noexcept {
  if (!(duration >= stopping_from_ * (1 - kTimeRounding))) return std::nullopt;
  const double way = joint_.way - stop_->way(joint_.v0) - go_->way(0);
  const OneJoint rest = leg(joint_, 0, 0, 0, 0, way);
  Phases out = *stop_;
  const double time = duration - stop_->duration() - go_->duration();
  if (!append_exactly(rest, JointTimes(rest), time, out)) return std::nullopt;
  out.append(*go_);
  if (!fits(out)) return std::nullopt;
  return out;
}

std::optional<RangedJoint::Turn> RangedJoint::turn_with(double sign, double way,
                                                        double a) const noexcept {
  const JointTimes to(leg(joint_, joint_.v0, joint_.a0, 0, a, way));
  const JointTimes on(leg(joint_, 0, a, joint_.v1, joint_.a1, joint_.way - way));
  const Turn turn{sign, way, a, to.first_possible(0), on.first_possible(0)};
  if (!(turn.before + turn.after < kNever)) return std::nullopt;
  if (!turning(turn, turn.before + turn.after)) return std::nullopt;
  return turn;
}

/// The more it decelerates at the limit, the shorter; but neither end allows all, and one too much
/// asks for a run-up.
std::optional<RangedJoint::Turn> RangedJoint::fastest_turn(double sign) const noexcept {
  const OneJoint up = sign > 0 ? joint_ : joint_.mirrored(), back = reversed(up);
  const Room room = sign > 0 ? room_ : room_.mirrored();
  if (!(room.above < kNever)) return std::nullopt;
  const Brake first = braking(up), last = braking(back);
  const double size = room.above + std::abs(up.way) + std::max(0.0, -room.below);
  const double away = kAway * (std::isfinite(size) ? size : room.above + std::abs(up.way));
  const double way =
      sign * std::min(room.above, std::max({room.above - away, first.way, up.way + last.way}));
  std::optional<Turn> best;
  const auto total = [](const std::optional<Turn>& t) { return t ? t->before + t->after : kNever; };
  const auto look = [&](double a) {
    const auto turn = turn_with(sign, way, sign * a);
    if (total(turn) < total(best)) best = turn;
    return total(turn);
  };
  look(0);
  const double r = joint_.inverse_jerk;
  if (r == 0) return best;
  look(first.a);
  look(last.a);
  const double run = std::isfinite(size) ? size : std::abs(up.way) + room.above;
  const double most = std::min({joint_.a_max, std::sqrt(2 * joint_.v_max / r) * (1 - 1e-9),
                                std::cbrt(6 * run / (r * r)) + std::abs(first.a)});
  constexpr int kGrid = 12, kSections = 24;
  for (int i = 1; i <= kGrid; ++i) look(-most * i * i / (kGrid * kGrid));
  if (!best) return best;
  double low = std::max(-most, sign * best->a - 2 * most / kGrid);
  double high = std::min(0.0, sign * best->a + 2 * most / kGrid);
  constexpr double kGolden = 0.6180339887498949;
  for (int i = 0; i < kSections; ++i) {
    const double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
    if (look(a) <= look(b)) {
      high = b;
    } else {
      low = a;
    }
  }
  return best;
}

/// Longer than the fastest: more time after the turn, or before it.
std::optional<Phases> RangedJoint::turning(const Turn& turn, double duration) const noexcept {
  const OneJoint to = leg(joint_, joint_.v0, joint_.a0, 0, turn.a, turn.way);
  const OneJoint on = leg(joint_, 0, turn.a, joint_.v1, joint_.a1, joint_.way - turn.way);
  const JointTimes to_times(to), on_times(on);
  for (const bool after : {true, false}) {
    const double before = after ? turn.before : duration - turn.after;
    Phases out;
    if (!append_exactly(to, to_times, before, out)) continue;
    if (append_exactly(on, on_times, duration - before, out) && fits(out)) return out;
  }
  return std::nullopt;
}

bool RangedJoint::find(double duration) noexcept {
  if (auto found = motion(duration)) {
    found_ = *found;
    found_for_ = duration;
  }
  return found_for_ == duration;
}

std::optional<Phases> RangedJoint::motion(double duration) const noexcept {
  if (duration == found_for_) return found_;
  if (auto out = blended(duration)) return out;
  if (auto out = cruising(duration)) return out;
  for (const std::optional<Turn>& turn : turns_) {
    if (!turn) continue;
    if (auto out = turning(*turn, duration)) return out;
  }
  return stopping(duration);
}

double RangedJoint::first_possible(double from) noexcept {
  if (find(from)) return from;
  if (!looked_for_turns_) {
    turns_ = {fastest_turn(1), fastest_turn(-1)};
    looked_for_turns_ = true;
    if (find(from)) return from;
  }
  double last = std::max(from, stopping_from_);
  for (const std::optional<Turn>& turn : turns_) {
    if (turn && turn->before + turn->after >= from) {
      last = std::min(last, turn->before + turn->after);
    }
  }
  if (!(last < kNever)) return kNever;
  constexpr int kSteps = 12, kHalvings = 24;
  double low = from, high = last;
  for (int i = 1; i < kSteps; ++i) {
    const double t = from + (last - from) * i * i / (kSteps * kSteps);
    if (motion(t)) {
      high = t;
      break;
    }
    low = t;
  }
  for (int i = 0; i < kHalvings; ++i) {
    const double t = 0.5 * (low + high);
    (motion(t) ? high : low) = t;
  }
  return high;
}

}  // namespace mjarm::detail
