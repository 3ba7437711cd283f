#include <algorithm>
#include <cmath>

#include "mjarm/trajectory/recovery_internal.hpp"

namespace mjarm::detail {

Recovery::Recovery(const OneJoint& joint) noexcept : v(joint.v0), a(joint.a0) {
  const double r = joint.inverse_jerk;
  if (std::abs(a) > joint.a_max * (1 + kLimitSlack)) {
    const double limit = std::copysign(joint.a_max, a);
    if (r > 0) add(r * (std::abs(a) - joint.a_max), -std::copysign(1 / r, a));
    a = limit;
  }
  // The way the acceleration points comes first: there the velocity still grows.
  const double sign = std::copysign(1.0, a), v_limit = joint.v_max * (1 + kLimitSlack);
  if (sign * v + 0.5 * r * a * a > v_limit) {
    slow_down(joint, sign);
  } else if (-sign * v > v_limit) {
    slow_down(joint, -sign);
  }
}

/// Down to the velocity limit at full deceleration, but never so hard that the opposite limit
/// would be overshot in turn. Velocities times `sign` are too large.
void Recovery::slow_down(const OneJoint& joint, double sign) noexcept {
  const double r = joint.inverse_jerk, v_max = joint.v_max;
  const double jerk = r > 0 ? -sign / r : 0;
  const double over = sign * v - v_max, v_flat = sign * v + 0.5 * r * a * a;
  // The deceleration when the limit is met, and the most from which the opposite one holds.
  const double max = r * joint.a_max * joint.a_max;
  const double squared = std::min({max, r * a * a + 2 * over, v_flat + v_max});
  const double low = squared < max ? std::sqrt(std::max(0.0, squared) / r) : joint.a_max;
  const double until = std::max(-sign * a, low);
  add(r * (until + sign * a), jerk);
  a = -sign * until;
  if (low < joint.a_max) return;
  const double target = std::max(v_max, 0.5 * r * a * a - v_max);
  add(std::max(0.0, (sign * v - target) / joint.a_max), 0);
}

void Recovery::add(double time, double jerk) noexcept {
  if (time <= 0) return;
  phases[count_++] = {time, a, jerk};
  way += time * (v + time * (0.5 * a + time / 6 * jerk));
  v += time * (a + 0.5 * time * jerk);
  a += time * jerk;
  duration += time;
}

}  // namespace mjarm::detail
