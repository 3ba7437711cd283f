#include <algorithm>
#include <cmath>

#include "mjarm/kinematics/fk.hpp"
#include "mjarm/program/urscript_clock_internal.hpp"

namespace mjarm::program::detail {

ToolClock::ToolClock(const Arm& arm, const Trajectory& trajectory, const Curve& curve) {
  constexpr double kStep = 0.002;  // [s]
  constexpr double kFewest = 1000, kMax = 50'000;
  constexpr double kOnTheSpot = 1e-4;  // [m/rad] below it the tool only turns
  const double duration = trajectory.duration();
  const auto n = static_cast<int>(std::clamp(std::ceil(duration / kStep), kFewest, kMax));
  double s = 0, before = 0;
  for (int i = 0; i <= n; ++i) {
    const double t = duration * i / n;
    const JointState state = trajectory.at(t);
    const Eigen::Matrix<double, 6, 1> twist = fk_jacobian(arm, as_span(state.q)).J_W * state.v;
    const double v = twist.head<3>().norm(), w = twist.tail<3>().norm();
    const double speed = v > kOnTheSpot * w ? v : w;
    s += (speed + before) / 2 * duration / n;
    before = speed;
    t_.push_back(t);
    s_.push_back(i == 0 ? 0 : s);
    speed_.push_back(speed);
  }
  for (double& place : s_) place *= s > 0 ? curve.end() / s : 0;
}

double ToolClock::time_at(double s) const {
  const auto after = std::ranges::upper_bound(s_, s);
  if (after == s_.end()) return t_.back();
  if (after == s_.begin()) return 0;
  const auto i = static_cast<std::size_t>(after - s_.begin());
  return t_[i - 1] + (t_[i] - t_[i - 1]) * (s - s_[i - 1]) / (s_[i] - s_[i - 1]);
}

double ToolClock::peak(double s_from, double s_to) const {
  double out = 0;
  const auto first = std::ranges::lower_bound(s_, s_from);
  for (auto i = first; i != s_.end() && *i <= s_to; ++i) {
    out = std::max(out, speed_[static_cast<std::size_t>(i - s_.begin())]);
  }
  return out;
}

Trapezoid trapezoid(double way, double seconds, double peak) {
  if (!(peak > 0) || seconds >= 2 * way / peak) {
    return {2 * way / seconds, 4 * way / (seconds * seconds)};
  }
  constexpr double kShortest = 1e-3;  // [s] of a ramp, whatever the rounding
  return {peak, peak / std::max(seconds - way / peak, kShortest)};
}

}  // namespace mjarm::program::detail
