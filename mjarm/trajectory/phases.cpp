#include <algorithm>
#include <cmath>
#include <limits>

#include "mjarm/trajectory/phases_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr double kWeightEps = 16 * std::numeric_limits<double>::epsilon();

/// One of the two motions alone.
void append_alone(const std::array<JerkPhase, 7>& phases, double sign, Phases& out) noexcept {
  for (const JerkPhase& phase : phases) out.add(phase.duration, sign * phase.a, sign * phase.jerk);
}

/// Both, in common phases.
void append_both(const std::array<JerkPhase, 7>& up, double up_weight,
                 const std::array<JerkPhase, 7>& down, double down_weight, Phases& out) noexcept {
  std::size_t i = 0, k = 0;
  double up_done = 0, down_done = 0;
  while (i < up.size() && k < down.size()) {
    const double up_left = up[i].duration - up_done, down_left = down[k].duration - down_done;
    const double h = std::min(up_left, down_left);
    out.add(h,
            up_weight * (up[i].a + up[i].jerk * up_done) -
                down_weight * (down[k].a + down[k].jerk * down_done),
            up_weight * up[i].jerk - down_weight * down[k].jerk);
    up_done += h;
    down_done += h;
    if (up_left <= h) ++i, up_done = 0;
    if (down_left <= h) ++k, down_done = 0;
  }
}

}  // namespace

void Phases::append(const Phases& after) noexcept {
  for (const JerkPhase& phase : after.all()) add(phase.duration, phase.a, phase.jerk);
}

void Phases::append_reversed(const Phases& before) noexcept {
  for (std::size_t i = before.count_; i-- > 0;) {
    const JerkPhase& phase = before.all_[i];
    add(phase.duration, phase.a + phase.duration * phase.jerk, -phase.jerk);
  }
}

double Phases::duration() const noexcept {
  double sum = 0;
  for (const JerkPhase& phase : all()) sum += phase.duration;
  return sum;
}

Phases Phases::mirrored() const noexcept {
  Phases out;
  for (const JerkPhase& phase : all()) out.add(phase.duration, -phase.a, -phase.jerk);
  return out;
}

double Phases::way(double v) const noexcept {
  double way = 0;
  for (const JerkPhase& p : all()) {
    const double t = p.duration;
    way = way + t * (v + t * (0.5 * p.a + t / 6 * p.jerk));
    v += t * (p.a + 0.5 * t * p.jerk);
  }
  return way;
}

/// The way is largest and smallest at its ends or where the velocity v + a x + jerk x^2 / 2 is 0:
/// both of its roots, without cancellation.
Extent Phases::extent(double v) const noexcept {
  Extent out{0, 0, 0, v};
  for (const JerkPhase& p : all()) {
    const auto way = [&](double x) {
      return out.way + x * (out.v + x * (0.5 * p.a + x / 6 * p.jerk));
    };
    const double root = std::sqrt(std::max(0.0, p.a * p.a - 2 * p.jerk * out.v));
    const double b = -(p.a + std::copysign(root, p.a));
    for (const double x : {b / p.jerk, 2 * out.v / b, p.duration}) {
      if (!(x > 0 && x <= p.duration)) continue;
      out.low = std::min(out.low, way(x));
      out.high = std::max(out.high, way(x));
    }
    out.way = way(p.duration);
    out.v += p.duration * (p.a + 0.5 * p.duration * p.jerk);
  }
  return out;
}

void append_blend(const JointTimes& times, double way, double duration, Phases& out) noexcept {
  const double farthest = times.up().at(duration).way;
  const double nearest = -times.down().at(duration).way;
  const double range = farthest - nearest;
  const double up = range > 0 ? std::clamp((way - nearest) / range, 0.0, 1.0) : 1;
  const double down = range > 0 ? std::clamp((farthest - way) / range, 0.0, 1.0) : 0;
  // A motion that is all but one of the two is that one.
  if (down < kWeightEps && up >= kWeightEps) {
    return append_alone(times.up().phases(duration), 1, out);
  }
  if (up < kWeightEps) return append_alone(times.down().phases(duration), -1, out);
  append_both(times.up().phases(duration), up, times.down().phases(duration), down, out);
}

/// Up to a peak and back to 0: with r = 1 / jerk, the gain of the velocity is r (peak^2 - a^2 / 2)
/// and what the peak, held, brings.
void append_change(const OneJoint& joint, double v, Phases& out) noexcept {
  const double r = joint.inverse_jerk;
  const double flat = joint.v0 + 0.5 * r * joint.a0 * std::abs(joint.a0);
  const double sign = v >= flat ? 1 : -1, a = sign * joint.a0;
  const double gain = sign * (v - joint.v0) + 0.5 * r * a * a;
  const double ramps = r * joint.a_max * joint.a_max;
  const bool holds = gain >= ramps;
  const double top = holds ? joint.a_max : std::max(a, std::sqrt(std::max(0.0, gain) / r));
  const double jerk = r > 0 ? sign / r : 0;
  out.add(r * (top - a), joint.a0, jerk);
  if (holds) out.add((gain - ramps) / joint.a_max, sign * top, 0);
  out.add(r * top, sign * top, -jerk);
}

void append_brake(const OneJoint& joint, Phases& out) noexcept {
  const double r = joint.inverse_jerk, a = joint.a0, v = joint.v0;
  const double until = r * (a + joint.a_max);
  if (v + 0.5 * r * std::max(0.0, a) * std::max(0.0, a) <= 0) return;
  // The later root of v + a t - t^2 / (2 r).
  const double root = std::sqrt(std::max(0.0, a * a + 2 * v / r));
  const double stop = r > 0 ? (a > 0 || v <= 0 ? r * (a + root) : 2 * v / (root - a)) : 0;
  const double ramp = std::min(stop, until);
  if (r > 0) out.add(ramp, a, -1 / r);
  if (r > 0 && stop <= until) return;
  const double left = v + (r > 0 ? ramp * (a - 0.5 * ramp / r) : 0);
  out.add(left / joint.a_max, -joint.a_max, 0);
}

}  // namespace mjarm::detail
