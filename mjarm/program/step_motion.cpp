#include "mjarm/program/step_motion_internal.hpp"

namespace mjarm::program::detail {
namespace {

/// [m/s^2] Of a tool that presses: on something that is tilted, what is faster changes the force by
/// the arm's inertia.
constexpr double kPressAccel = 0.1;

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
  if (steps.front().press) options.timing.tool_accel = kPressAccel;
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
