#include <algorithm>
#include <cmath>

#include "mjarm/program/step_motion_internal.hpp"

namespace mjarm::program::detail {
namespace {

/// [m/s^2] Of a tool that presses, along its way and across it: what is faster changes the force by
/// the arm's inertia, the more so on something that is tilted.
constexpr double kPressAccel = 0.1;

/// [m/s] At most `speed`, and less in bends, a little before and behind them as well.
std::vector<SpeedFrom> speeds_in_bends(const Curve& curve, double speed) {
  constexpr double kStep = 2e-4;  // [m] between places
  constexpr int kAround = 2;      // places
  const auto count = static_cast<int>(std::clamp(std::ceil(curve.end() / kStep), 4.0, 1e5));
  const double step = curve.end() / count;
  std::vector<double> most(static_cast<std::size_t>(count) + 1, speed);
  for (int i = 1; i < count; ++i) {
    const Eigen::Vector3d before = curve.at((i - 1) * step).p, here = curve.at(i * step).p,
                          after = curve.at((i + 1) * step).p;
    const double bend = (after - 2 * here + before).norm() / (step * step);  // [1/m]
    most[static_cast<std::size_t>(i)] = std::min(speed, std::sqrt(kPressAccel / (bend + 1e-9)));
  }
  std::vector<SpeedFrom> out;
  for (int i = 0; i <= count; ++i) {
    double least = speed;
    for (int k = std::max(0, i - kAround); k <= std::min(count, i + kAround); ++k) {
      least = std::min(least, most[static_cast<std::size_t>(k)]);
    }
    constexpr double kChange = 0.1;  // of the speed before
    if (out.empty() || std::abs(least - out.back().speed) > kChange * out.back().speed) {
      out.push_back({i * step, least});
    }
  }
  return out;
}

}  // namespace

bool same_pose(const Pose& a, const Pose& b) {
  constexpr double kSame = 1e-9;
  return (a.p - b.p).norm() < kSame && (a.R - b.R).norm() < kSame;
}

Result<Curve> leg_of(const Step& step, const Pose& X) {
  if (step.kind == Step::Kind::line) return Curve::line(X, step.X_WT);
  return step.whole ? Curve::circle(X, step.X_via, step.X_WT)
                    : Curve::arc(X, step.X_via, step.X_WT);
}

bool is_blended(std::span<const Step> steps, std::size_t k) {
  if (k + 1 == steps.size() || !(steps[k].blend > 0)) return false;
  const Step& next = steps[k + 1];
  const bool goes_on = next.kind == Step::Kind::line ? !same_pose(steps[k].X_WT, next.X_WT)
                                                     : next.kind == Step::Kind::arc && !next.whole;
  return goes_on && next.tool == steps[k].tool;
}

MotionOptions motion_options(std::span<const Step> steps, const Curve& curve, double tool_speed) {
  MotionOptions options;
  const auto speed_of = [&](const Step& step) { return step.speed > 0 ? step.speed : tool_speed; };
  const double first = speed_of(steps.front());
  options.timing.tool_speed = first;
  if (steps.front().press) {
    options.timing.tool_accel = kPressAccel;
    options.timing.tool_speeds = speeds_in_bends(curve, first);
    return options;
  }
  bool keep = steps.front().keep_speed, alike = true;
  for (std::size_t k = 1; k < steps.size(); ++k) {
    const double speed = speed_of(steps[k]);
    alike = alike && speed == first;
    keep = keep && steps[k].keep_speed;
    options.timing.tool_speeds.push_back({curve.breaks()[k - 1], speed});
  }
  if (alike) options.timing.tool_speeds.clear();
  if (alike && keep) options.path.tool_speed = options.timing.tool_speed;
  return options;
}

}  // namespace mjarm::program::detail
