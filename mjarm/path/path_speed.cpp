#include "mjarm/core/rotation.hpp"
#include "mjarm/path/path_speed_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr double kRounding = 1e-7;  // [rad or m] of answers

}  // namespace

double time_at_speed(const Pose& X_before, const Pose& X_WT, double tool_speed) {
  constexpr double kStanding = 1e-9;  // [m]
  const double way = (X_WT.p - X_before.p).norm();
  return (way > kStanding ? way : angle_between(X_before.R, X_WT.R)) / tool_speed;
}

JointVec longest_at_speed(const Arm& arm, const Pose& X_before, const Pose& X_WT,
                          double tool_speed) {
  const JointVec way = arm.limits.velocity * time_at_speed(X_before, X_WT, tool_speed);
  return way.array() + kRounding;
}

Overspeed overspeed(const Arm& arm, const JointVec& step, double time) {
  Overspeed out;
  double max = 1;
  for (int i = 0; i < step.size(); ++i) {
    const double limit = arm.limits.velocity[i];
    const double way = std::abs(step[i]);
    if (way <= limit * time + kRounding || way <= max * limit * time) continue;
    max = way / (limit * time);
    out = {i, way / time - limit};
  }
  return out;
}

}  // namespace mjarm::detail
