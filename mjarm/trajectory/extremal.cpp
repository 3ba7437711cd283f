#include <algorithm>
#include <cmath>

#include "mjarm/trajectory/extremal_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
// What comes out of a calculation, such as a state on the way of another motion, is that far from
// where it should be, relative to the largest numbers in it.
constexpr double kRounding = 1e-12;
constexpr int kMaxSteps = 100;  // bisection alone needs fewer

double square(double x) { return x * x; }

/// The smaller and the larger root of x^2 - 2 b x + c, b > 0 and b^2 >= c.
struct Roots {
  double low, high;
};
Roots roots(double b, double c) {
  const double high = b + std::sqrt(b * b - c);
  return {c / high, high};
}

/// Acceleration phase, shortest for a change of velocity: the peak, and how long it is held.
struct Peak {
  double a, held;
};
/// @param gain  twice the jerk time times the peak, plus what is held: > 0.
Peak peak(double gain, double a_max, double inverse_jerk) {
  const double ramps = inverse_jerk * a_max * a_max;
  if (gain >= ramps) return {a_max, (gain - ramps) / a_max};
  return {std::sqrt(std::max(0.0, gain) / inverse_jerk), 0};
}

}  // namespace

FarthestMotions::FarthestMotions(const OneJoint& joint) noexcept : joint_(joint) {
  const double r = joint.inverse_jerk;
  gain_ = joint.v1 - joint.v0 - 0.5 * r * (square(joint.a1) - square(joint.a0));
  ramp_time_ = r * (joint.a1 - joint.a0);
  cruise_from_ = kInf;
  cruise_way_ = kInf;
  fastest_ = {};
  if (joint.v_max == kInf) return;
  const Peak top = peak(joint.v_max - joint.v0 + 0.5 * r * square(joint.a0), joint.a_max, r);
  const Peak low = peak(joint.v_max - joint.v1 + 0.5 * r * square(joint.a1), joint.a_max, r);
  fastest_ = {top.a, top.held, -low.a, low.held, 0};
  cruise_from_ = r * (2 * (top.a + low.a)) + ramp_time_ + top.held + low.held;
  cruise_way_ = measured(fastest_).way;
}

/// With x half the time of the jerk phases down (and of those up, less what the ends need): the
/// durations of the phases add up to T and their gains to that of the velocity. Both are linear in
/// the sum and the difference of the two peaks.
Farthest FarthestMotions::without_cruise(double duration) const noexcept {
  const double r = joint_.inverse_jerk, a = joint_.a_max;
  const double x = std::max(0.0, 0.5 * (duration - ramp_time_));
  // No phase up is shorter than nothing, whatever rounding says where x is next to 0.
  const double least = 2 * r * joint_.a0 - x, max = 2 * r * joint_.a1 + x;
  const double sum = std::max(least, std::min(max, x > 0 ? r * gain_ / x : 0));
  if (x + std::abs(sum) <= 2 * r * a) {
    if (r == 0) return {a, 0, -a, 0, 0};
    return {0.5 * (sum + x) / r, 0, 0.5 * (sum - x) / r, 0, 0};
  }
  // The higher peak is held; `fall` is what the jerk phase down then takes squared.
  const double fall = 2 * a * x - std::abs(gain_);
  if (r > 0 && fall < 4 * r * a * a) {
    const double drop = std::sqrt(std::max(0.0, fall) / r);
    const double held = 2 * std::max(0.0, x - r * drop);
    return gain_ > 0 ? Farthest{a, held, std::min(a - drop, joint_.a1), 0, 0}
                     : Farthest{std::max(drop - a, joint_.a0), 0, -a, held, 0};
  }
  const double held = x - 2 * r * a, more = 0.5 * gain_ / a;
  return {a, std::max(0.0, held + more), -a, std::max(0.0, held - more), 0};
}

/// The way is the sum over the phases, from both ends to the middle. Its derivative is the
/// Hamiltonian, constant along the motion: v where the acceleration is or would be 0 on the way
/// down, plus half the inverse jerk times both peaks.
FarthestMotions::Value FarthestMotions::measured(const Farthest& m) const noexcept {
  const double r = joint_.inverse_jerk;
  const double up = std::max(0.0, r * (m.a_top - joint_.a0));
  const double down = r * (m.a_top - m.a_low);
  const double back = std::max(0.0, r * (joint_.a1 - m.a_low));
  const double way_up = up * (joint_.v0 + up * (2 * joint_.a0 + m.a_top) / 6);
  const double v_up = joint_.v0 + 0.5 * up * (joint_.a0 + m.a_top);
  const double way_top = m.top_time * (v_up + 0.5 * m.top_time * m.a_top);
  const double v_top = v_up + m.top_time * m.a_top;
  const double way_down = down * (v_top + down * (2 * m.a_top + m.a_low) / 6);
  const double way_back = back * (joint_.v1 - back * (2 * joint_.a1 + m.a_low) / 6);
  const double v_back = joint_.v1 - 0.5 * back * (joint_.a1 + m.a_low);
  const double way_low = m.low_time * (v_back - 0.5 * m.low_time * m.a_low);
  return {way_up + way_top + way_down + way_low + way_back,
          v_top + 0.5 * r * m.a_top * (m.a_top - m.a_low)};
}

FarthestMotions::Value FarthestMotions::at(double duration) const noexcept {
  if (duration >= cruise_from_) {
    return {cruise_way_ + joint_.v_max * (duration - cruise_from_), joint_.v_max};
  }
  return measured(without_cruise(duration));
}

std::array<JerkPhase, 7> FarthestMotions::phases(double duration) const noexcept {
  const double r = joint_.inverse_jerk;
  Farthest m = fastest_;
  if (duration >= cruise_from_) {
    m.cruise = duration - cruise_from_;
  } else {
    m = without_cruise(duration);
  }
  const double jerk = r > 0 ? 1 / r : 0;
  const double middle = m.cruise > 0 ? 0 : m.a_low;
  return {{{std::max(0.0, r * (m.a_top - joint_.a0)), joint_.a0, jerk},
           {m.top_time, m.a_top, 0},
           {r * (m.a_top - middle), m.a_top, -jerk},
           {m.cruise, 0, 0},
           {r * (middle - m.a_low), middle, -jerk},
           {m.low_time, m.a_low, 0},
           {std::max(0.0, r * (joint_.a1 - m.a_low)), m.a_low, jerk}}};
}

/// The duration at which `at` has its least speed: the way is concave in the duration before, and
/// convex after it up to the cruise. Both peaks have the same sign there.
double FarthestMotions::bend_time() const noexcept {
  const double r = joint_.inverse_jerk, a = joint_.a_max, gain = std::abs(gain_);
  constexpr double kSqrt3 = 1.7320508075688772;
  double x = std::sqrt(r * gain / kSqrt3);
  if (x * (1 + kSqrt3) > 2 * r * a) {
    x = 0.5 * (gain / a + r * a * 9 / 16);
    if (x < 0.75 * r * a) x = r * a - std::sqrt(std::max(0.0, r * (r * a * a - gain)));
  }
  return 2 * x + ramp_time_;
}

bool FarthestMotions::far_enough(double duration, double way) const noexcept {
  const double a = std::abs(joint_.a0) + std::abs(joint_.a1);
  const double scale =
      std::abs(joint_.way) + duration * (std::abs(joint_.v0) + std::abs(joint_.v1) + duration * a);
  return way >= joint_.way - joint_.noise - 0.01 * kRounding * scale;
}

double FarthestMotions::first_far_enough(double from, double until) const noexcept {
  Value value = at(from);
  if (far_enough(from, value.way)) return from;
  if (from >= cruise_from_) return from + (joint_.way - value.way) / joint_.v_max;
  double t = from;
  const double bend = std::min(bend_time(), cruise_from_);
  if (t < bend) {
    // Newton's steps on a concave function stay before its first root.
    for (int i = 0; i < kMaxSteps && value.speed > 0; ++i) {
      const double step = (joint_.way - value.way) / value.speed;
      if (t + step > std::min(bend, until)) break;
      t += step;
      value = at(t);
      if (step <= 2 * kEpsilon * t || value.way >= joint_.way) return t;
    }
    if (far_enough(t, value.way)) return t;  // it but touches
    if (bend > until) return far_enough(until, at(until).way) ? until : kInf;
    t = bend;
    value = at(t);
  }
  return first_on_convex(t, until, value);
}

/// @param value  at `from`, not far enough.
double FarthestMotions::first_on_convex(double from, double until, Value value) const noexcept {
  const double missing = joint_.way - value.way;
  if (missing <= 0) return from;
  double low = from, high = std::min(until, cruise_from_);
  if (high < kInf) {
    const double there = high == cruise_from_ ? cruise_way_ : at(high).way;
    if (there < joint_.way) {
      if (high < until) return high + (joint_.way - there) / joint_.v_max;
      return far_enough(until, there) ? until : kInf;
    }
  }
  // First guess: as if at rest. On a convex function Newton's steps overshoot at most once.
  double step = std::max(std::cbrt(32 * joint_.inverse_jerk * missing),
                         2 * std::sqrt(missing / joint_.a_max));
  if (value.speed > 0) step = std::min(step, missing / value.speed);
  double t = low + step;
  for (int i = 0; i < kMaxSteps; ++i) {
    if (!(t > low && t < high)) t = high < kInf ? 0.5 * (low + high) : 2 * low + step;
    value = at(t);
    (value.way < joint_.way ? low : high) = t;
    const double next = t + (joint_.way - value.way) / value.speed;
    if (std::abs(next - t) <= 2 * kEpsilon * t) return next;
    if (low >= high * (1 - 2 * kEpsilon)) return high;
    t = next;
  }
  return t;
}

/// Motions exist where no phase up is shorter than nothing: a_top >= a0 and a_low <= a1, two
/// parabolas in x (see `FarthestMotions::without_cruise`). One of them bounds x below, the other
/// may leave a gap: too late to go straight on, too early to turn back.
Durations::Durations(const OneJoint& joint) noexcept {
  const double r = joint.inverse_jerk, a_max = joint.a_max;
  double gain = joint.v1 - joint.v0 - 0.5 * r * (square(joint.a1) - square(joint.a0));
  const double v_scale = std::min(joint.v_max, std::abs(joint.v0) + std::abs(joint.v1));
  if (std::abs(gain) <= 0.01 * kRounding * v_scale) gain = 0;
  const double ramp_time = r * (joint.a1 - joint.a0);
  // Seen with a gain that is positive: `own` bounds below, `other` leaves the gap.
  const bool rising = gain > 0 || (gain == 0 && joint.a1 >= 0);
  const double own = rising ? joint.a1 : -joint.a0, other = rising ? joint.a0 : -joint.a1;
  const double c = r * std::abs(gain);
  double x = 0;
  if (std::abs(gain) + r * square(own) <= r * square(a_max)) {
    const double root = std::sqrt(square(r * own) + c);
    x = own > 0 ? c / (r * own + root) : root - r * own;
  } else {
    x = 0.5 * (std::abs(gain) + r * square(a_max - own)) / a_max;
  }
  from = 2 * x + ramp_time;
  const double left = square(r * other) - c;
  if (other <= 0 || left <= kRounding * square(r * other)) return;
  const Roots gap = roots(r * other, c);
  if (x >= gap.high) return;
  if (x > gap.low + kRounding * gap.high || from < 0) {
    from = 2 * gap.high + ramp_time;
    return;
  }
  gap_from = std::max(from, 2 * gap.low + ramp_time);
  gap_to = 2 * gap.high + ramp_time;
}

JointTimes::JointTimes(const OneJoint& joint) noexcept
    : durations_(joint), up_(joint), down_(joint.mirrored()) {}

double JointTimes::first_possible(double from) const noexcept {
  double t = std::max(from, durations_.from);
  // Each round goes on to a later duration that one of the three asks for, and few do.
  for (int i = 0; i < kMaxSteps; ++i) {
    const bool before = t <= durations_.gap_from * (1 + kRounding);
    if (!before) t = std::max(t, durations_.gap_to);
    const double until = before ? std::max(t, durations_.gap_from) : kInf;
    const double far = up_.first_far_enough(t, until);
    const double near = far <= until ? down_.first_far_enough(far, until) : kInf;
    if (near == t) return t;
    t = near <= until && near < kInf ? near : durations_.gap_to;
  }
  return t;
}

}  // namespace mjarm::detail
