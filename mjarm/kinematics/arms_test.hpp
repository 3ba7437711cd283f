#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/model/arm.hpp"

/// Arms written by hand from published figures, so that kinematics is tested without a file.
namespace mjarm::testing {

struct JointRow {
  Eigen::Vector3d xyz;
  Eigen::Vector3d rpy;
  Eigen::Vector3d axis;
  double lower;
  double upper;
  JointType type = JointType::hinge;
};

inline Arm make_arm(std::string name, const std::vector<JointRow>& rows, const Pose& X_JT) {
  Arm arm;
  arm.name = std::move(name);
  arm.tip = "tool";
  arm.X_JT = X_JT;
  const auto n = static_cast<Eigen::Index>(rows.size());
  arm.limits.lower.resize(n);
  arm.limits.upper.resize(n);
  arm.home.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const JointRow& row = rows[static_cast<std::size_t>(i)];
    ArmJoint joint;
    joint.name = "joint" + std::to_string(i + 1);
    joint.type = row.type;
    joint.X_PJ = {row.xyz, from_euler(row.rpy)};
    joint.axis = row.axis.normalized();
    arm.joints.push_back(joint);
    arm.limits.lower[i] = row.lower;
    arm.limits.upper[i] = row.upper;
    arm.home[i] = std::isfinite(row.lower + row.upper) ? 0.5 * (row.lower + row.upper) : 0.0;
  }
  arm.limits.velocity = JointVec::Constant(n, 3);
  arm.limits.acceleration = JointVec::Constant(n, 10);
  arm.limits.jerk = JointVec::Constant(n, 100);
  arm.limits.torque = JointVec::Constant(n, 100);
  return arm;
}

/// UR5e, old ROS figures, tool0, seen from base_link. `turned` = from the controller's base frame.
inline Arm ur5e(bool turned = false) {
  constexpr double pi = std::numbers::pi;
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const double half = pi / 2;
  return make_arm("ur5e",
                  {{{0, 0, 0.163}, {0, 0, turned ? pi : 0.0}, z, -2 * pi, 2 * pi},
                   {{0, 0.138, 0}, {0, half, 0}, y, -2 * pi, 2 * pi},
                   {{0, -0.131, 0.425}, {0, 0, 0}, y, -pi, pi},
                   {{0, 0, 0.392}, {0, half, 0}, y, -2 * pi, 2 * pi},
                   {{0, 0.127, 0}, {0, 0, 0}, z, -2 * pi, 2 * pi},
                   {{0, 0, 0.1}, {0, 0, 0}, y, -2 * pi, 2 * pi}},
                  {{0, 0.1, 0}, from_euler({-half, 0, 0})});
}

/// Panda, figures of Franka's DH table, flange (panda_link8).
inline Arm panda() {
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const double half = std::numbers::pi / 2;
  return make_arm("panda",
                  {{{0, 0, 0.333}, {0, 0, 0}, z, -2.8973, 2.8973},
                   {{0, 0, 0}, {-half, 0, 0}, z, -1.7628, 1.7628},
                   {{0, -0.316, 0}, {half, 0, 0}, z, -2.8973, 2.8973},
                   {{0.0825, 0, 0}, {half, 0, 0}, z, -3.0718, -0.0698},
                   {{-0.0825, 0.384, 0}, {-half, 0, 0}, z, -2.8973, 2.8973},
                   {{0, 0, 0}, {half, 0, 0}, z, -0.0175, 3.7525},
                   {{0.088, 0, 0}, {half, 0, 0}, z, -2.8973, 2.8973}},
                  {{0, 0, 0.107}, Eigen::Matrix3d::Identity()});
}

inline JointVec random_q(const Arm& arm, Rng& rng) {
  JointVec q(arm.dof());
  for (int i = 0; i < arm.dof(); ++i) {
    const double lower = arm.limits.lower[i];
    const double upper = arm.limits.upper[i];
    q[i] = std::isfinite(upper - lower) ? rng.uniform(lower, upper) : rng.uniform(-3, 3);
  }
  return q;
}

/// About half of the joints within 1e-8 to 0.1 rad of a limit.
inline JointVec random_q_near_limits(const Arm& arm, Rng& rng) {
  JointVec q = random_q(arm, rng);
  for (int i = 0; i < arm.dof(); ++i) {
    const double inside = std::pow(10, rng.uniform(-8, -1));
    const double side = rng.uniform();
    if (side < 0.25) q[i] = arm.limits.lower[i] + inside;
    if (side > 0.75) q[i] = arm.limits.upper[i] - inside;
  }
  return q;
}

/// An arm of `dof` joints with random frames, axes and limits; every fifth joint or so is a slide.
inline Arm random_arm(int dof, Rng& rng) {
  const auto vec = [&](double size) {
    return Eigen::Vector3d(rng.uniform(-size, size), rng.uniform(-size, size),
                           rng.uniform(-size, size));
  };
  std::vector<JointRow> rows;
  for (int i = 0; i < dof; ++i) {
    const bool slide = rng.uniform() < 0.2;
    const double middle = slide ? rng.uniform(0, 0.1) : rng.uniform(-1, 1);
    const double half = slide ? rng.uniform(0.05, 0.3) : rng.uniform(0.5, 4);
    rows.push_back({vec(0.3), vec(3), vec(1), middle - half, middle + half,
                    slide ? JointType::slide : JointType::hinge});
  }
  return make_arm("random", rows, {vec(0.2), from_euler(vec(3))});
}

}  // namespace mjarm::testing
