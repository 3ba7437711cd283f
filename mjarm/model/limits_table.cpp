#include "mjarm/model/limits_table.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace mjarm {
namespace {

constexpr double kPi = std::numbers::pi;

/// How the axis of the next joint lies against that of this one: length of the common normal [m]
/// and angle between the lines [rad], 0 to pi/2. Neither depends on where the joint frames sit.
struct AxisStep {
  double distance;
  double angle;
};

// UR5e: DH table of Universal Robots (a2 = 0.425 m, a3 = 0.3922 m). Speeds 180 deg/s and torques
// 150 and 28 N m from its technical specification; acceleration as the vendor's ROS driver
// configures MoveIt; jerk is not published: 100 rad/s^3 reaches full acceleration in 50 ms.
constexpr std::array<AxisStep, 5> kUr5eAxes = {
    {{0, kPi / 2}, {0.425, 0}, {0.392, 0}, {0, kPi / 2}, {0, kPi / 2}}};
constexpr std::array<double, 6> kUr5eVelocity = {kPi, kPi, kPi, kPi, kPi, kPi};
constexpr std::array<double, 6> kUr5eAcceleration = {5, 5, 5, 5, 5, 5};
constexpr std::array<double, 6> kUr5eJerk = {100, 100, 100, 100, 100, 100};
constexpr std::array<double, 6> kUr5eTorque = {150, 150, 150, 28, 28, 28};

// Panda: DH table and limits of Franka Robotics' control interface documentation ("Robot and
// interface specifications").
constexpr std::array<AxisStep, 6> kPandaAxes = {{{0, kPi / 2},
                                                 {0, kPi / 2},
                                                 {0.0825, kPi / 2},
                                                 {0.0825, kPi / 2},
                                                 {0, kPi / 2},
                                                 {0.088, kPi / 2}}};
constexpr std::array<double, 7> kPandaVelocity = {2.175, 2.175, 2.175, 2.175, 2.61, 2.61, 2.61};
constexpr std::array<double, 7> kPandaAcceleration = {15, 7.5, 10, 12.5, 15, 20, 20};
constexpr std::array<double, 7> kPandaJerk = {7500, 3750, 5000, 6250, 7500, 10000, 10000};
constexpr std::array<double, 7> kPandaTorque = {87, 87, 87, 87, 12, 12, 12};

constexpr KnownRobot kUr5e = {"UR5e", kUr5eVelocity, kUr5eAcceleration, kUr5eJerk, kUr5eTorque};
constexpr KnownRobot kPanda = {"Panda", kPandaVelocity, kPandaAcceleration, kPandaJerk,
                               kPandaTorque};

AxisStep axis_step(const ArmJoint& here, const ArmJoint& next) {
  const Eigen::Vector3d& a = here.axis;
  const Eigen::Vector3d b = next.X_PJ.R * next.axis;
  const Eigen::Vector3d& between = next.X_PJ.p;  // from a point of line a to a point of line b
  const Eigen::Vector3d normal = a.cross(b);
  const double sine = normal.norm();
  const double angle = std::atan2(sine, std::abs(a.dot(b)));
  const double distance =
      sine < 1e-3 ? a.cross(between).norm() : std::abs(between.dot(normal)) / sine;
  return {distance, angle};
}

bool has_axes(const Arm& arm, std::span<const AxisStep> axes) {
  constexpr double kDistance = 3e-3;
  constexpr double kAngle = 0.01;
  if (arm.joints.size() != axes.size() + 1) return false;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const AxisStep step = axis_step(arm.joints[i], arm.joints[i + 1]);
    if (std::abs(step.distance - axes[i].distance) > kDistance) return false;
    if (std::abs(step.angle - axes[i].angle) > kAngle) return false;
  }
  return true;
}

}  // namespace

StandardLimits standard_limits(JointType type) noexcept {
  return type == JointType::hinge ? StandardLimits{2, 5, 100, 100}
                                  : StandardLimits{0.5, 5, 100, 1000};
}

const KnownRobot* known_robot(const Arm& arm) noexcept {
  for (const ArmJoint& joint : arm.joints) {
    if (joint.type != JointType::hinge) return nullptr;
    // The successor of the Panda has its geometry, but other limits.
    if (joint.name.find("fr3") != std::string::npos) return nullptr;
  }
  if (has_axes(arm, kUr5eAxes)) return &kUr5e;
  if (has_axes(arm, kPandaAxes)) return &kPanda;
  return nullptr;
}

}  // namespace mjarm
