#include <algorithm>
#include <cmath>

#include "mjarm/planning/ball_reach_internal.hpp"

namespace mjarm::detail {
namespace {

using Eigen::Vector3d;

constexpr double kEndlessSlide = 10;  // [m] as FastRobot takes it
constexpr double kLimitSlack = 1e-3;  // [m] more than what checks let pass
constexpr double kParallel = 1e-9;    // sine of an angle

/// What is between the limits of a slide.
struct Stroke {
  double low, high;  // [m]
  Stroke(const Arm& arm, int joint)
      : low(std::max(arm.limits.lower[joint], -kEndlessSlide) - kLimitSlack),
        high(std::min(arm.limits.upper[joint], kEndlessSlide) + kLimitSlack) {}
};

/// [m] of the centre from the origin of a joint's frame.
double farthest_from(const Arm& arm, const LinkBall& ball, int joint) {
  double out = ball.center.norm();
  for (int k = joint + 1; k <= ball.joint; ++k) {
    const ArmJoint& next = arm.joints[static_cast<std::size_t>(k)];
    out += next.X_PJ.p.norm();
    if (next.type != JointType::slide) continue;
    const Stroke stroke(arm, k);
    out += std::max(std::abs(stroke.low), std::abs(stroke.high));
  }
  return out;
}

/// [m] n . p of the centre at most.
double farthest_along(const Arm& arm, const LinkBall& ball, Vector3d n) {
  double out = 0;
  for (int k = 0; k <= ball.joint; ++k) {
    const ArmJoint& joint = arm.joints[static_cast<std::size_t>(k)];
    out += n.dot(joint.X_PJ.p);
    n = joint.X_PJ.R.transpose() * n;
    if (joint.type == JointType::slide) {
      const Stroke stroke(arm, k);
      const double share = n.dot(joint.axis);
      out += std::max(share * stroke.low, share * stroke.high);
    } else if (n.cross(joint.axis).norm() > kParallel) {
      return out + farthest_from(arm, ball, k);
    }
  }
  return out + n.dot(ball.center);
}

}  // namespace

BallReach reach_of(const Arm& arm, const LinkBall& ball) {
  BallReach out;
  out.middle = arm.joints.front().X_PJ.p;
  out.radius = farthest_from(arm, ball, 0);
  if (arm.joints.front().type == JointType::slide) {
    const Stroke stroke(arm, 0);
    out.radius += std::max(std::abs(stroke.low), std::abs(stroke.high));
  }
  constexpr std::size_t kOfWorld = 3;
  std::vector<Vector3d> axes = {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  for (int k = 0; k <= ball.joint; ++k) {
    const ArmJoint& joint = arm.joints[static_cast<std::size_t>(k)];
    R *= joint.X_PJ.R;
    axes.push_back(R * joint.axis);
    if (joint.type != JointType::slide) break;
  }
  for (std::size_t i = axes.size() - 1; i > kOfWorld; --i) {  // two slides move in a plane
    const Vector3d across = axes[i - 1].cross(axes[i]);
    if (across.norm() > 0.1) axes.push_back(across.normalized());
  }
  for (const Vector3d& axis : axes) {
    for (const Vector3d& n : {axis, Vector3d(-axis)}) {
      out.sides.push_back({n, farthest_along(arm, ball, n)});
    }
  }
  return out;
}

}  // namespace mjarm::detail
