#pragma once

#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/path/solve_path.hpp"

/// Paths that cannot be had, each built so that the cause is known without solving anything.
namespace mjarm::testing {

struct FailingPath {
  Arm arm = {};
  std::vector<Pose> poses = {};
  PathErrc cause = PathErrc::no_convergence;
  int joint = -1;     ///< joint_limit, joint_speed: which
  double amount = 0;  ///< joint_limit, collision, joint_speed: how far beyond, at most
  double tool_speed = 0;
  ClearanceCheck clearance = {};
};

/// An industrial arm: shoulder 0.15 m off the first axis, links of 0.45 m and 0.5 m, wrist axes
/// that meet.
inline Arm industrial() {
  constexpr double pi = std::numbers::pi;
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY(), z = Eigen::Vector3d::UnitZ();
  return make_arm("industrial",
                  {{{0, 0, 0.4}, {0, 0, 0}, z, -2 * pi, 2 * pi},
                   {{0.15, 0, 0}, {0, 0, 0}, y, -pi, pi},
                   {{0, 0, 0.45}, {0, 0, 0}, y, -pi, pi},
                   {{0, 0, 0.5}, {0, 0, 0}, z, -2 * pi, 2 * pi},
                   {{0, 0, 0}, {0, 0, 0}, y, -2.2, 2.2},
                   {{0, 0, 0}, {0, 0, 0}, z, -2 * pi, 2 * pi}},
                  {{0, 0, 0.1}, Eigen::Matrix3d::Identity()});
}

/// A UR5e posture far from singularities, the elbow and the wrist bent to one side.
inline JointVec bent(Rng& rng) {
  JointVec q(6);
  q << rng.uniform(-2, 2), rng.uniform(-2.2, -0.9), rng.uniform(0.9, 1.9), rng.uniform(-2, -0.6),
      rng.uniform(0.9, 1.9), rng.uniform(-2, 2);
  return q;
}

/// Straight lines: the tool keeps its orientation.
inline std::vector<Pose> line_of(const Pose& from, const Eigen::Vector3d& to, double spacing) {
  const int n = 1 + static_cast<int>(std::ceil((to - from.p).norm() / spacing));
  std::vector<Pose> poses = {};
  for (int i = 0; i <= n; ++i) poses.push_back({from.p + (to - from.p) * i / n, from.R});
  return poses;
}

/// Outwards from a bent posture to a tool point beyond all that the links can reach from the
/// shoulder: 0.425 + 0.392 m, 0.134 m aside and 0.1 + 0.1 m behind the elbow's plane.
inline FailingPath out_of_reach(Rng& rng, double depth) {
  FailingPath out{.arm = ur5e(), .cause = PathErrc::out_of_reach};
  const Pose X = fk(out.arm, as_span(bent(rng)));
  const Eigen::Vector3d shoulder(0, 0, 0.163);
  const Eigen::Vector3d way = (X.p - shoulder).normalized();
  out.poses = line_of(X, shoulder + (1.151 + depth) * way, 0.004);
  return out;
}

/// The tool down, towards the first axis: within 0.134 m of it there is nothing.
inline FailingPath inner_void(Rng& rng, double depth) {
  FailingPath out{.arm = ur5e(), .cause = PathErrc::inner_void};
  const double height = rng.uniform(0.1, 0.6), turn = rng.uniform(-3, 3);
  const Eigen::Vector3d way(std::cos(turn), std::sin(turn), 0), up(0, 0, height);
  const Eigen::Matrix3d R = from_euler({std::numbers::pi, 0, rng.uniform(-3, 3)});
  out.poses = line_of({up + 0.4 * way, R}, up + (0.133 - std::min(depth, 0.13)) * way, 0.002);
  return out;
}

/// A straight joint motion whose joint `j` ends `depth` beyond its limit, on an arm whose other
/// limits leave it just that branch.
inline FailingPath joint_limit(Rng& rng, double depth) {
  FailingPath out{.arm = ur5e(), .cause = PathErrc::joint_limit};
  const JointVec q0 = bent(rng);
  JointVec q1 = q0;
  out.joint = static_cast<int>(rng.uniform(0, 6));
  out.amount = depth;
  for (int i = 0; i < 6; ++i) q1[i] += rng.uniform(-0.25, 0.25);
  const double way = rng.uniform() < 0.5 ? 1 : -1;
  q1[out.joint] = q0[out.joint] + way * (0.3 + depth);
  out.arm.limits.lower = q0.cwiseMin(q1).array() - 0.5;
  out.arm.limits.upper = q0.cwiseMax(q1).array() + 0.5;
  (way > 0 ? out.arm.limits.upper : out.arm.limits.lower)[out.joint] = q1[out.joint] - way * depth;
  constexpr int n = 60;
  for (int i = 0; i <= n; ++i) {
    out.poses.push_back(fk(out.arm, as_span(JointVec(q0 + (q1 - q0) * i / n))));
  }
  out.arm.home = q0;
  return out;
}

/// A ball stands where the tool is to pass, `depth` deep at most.
inline FailingPath collision(Rng& rng, double depth) {
  FailingPath out = joint_limit(rng, 0.1);
  out.arm.limits = ur5e().limits;
  out.cause = PathErrc::collision;
  out.joint = -1;
  out.amount = depth;
  const Eigen::Vector3d center = out.poses[out.poses.size() / 2].p;
  const auto arm = std::make_shared<const Arm>(out.arm);
  out.clearance = [arm, center, depth](std::span<const double> q) {
    return Clearance{(fk(*arm, q).p - center).norm() - depth, {"tool", "ball", "tool", "world"}};
  };
  return out;
}

/// The tool turns past a wrist singularity at a small angle, in steps that turn the wrist by more
/// than 0.5 rad either way round; limits leave one shoulder and one elbow.
inline FailingPath singularity(Rng& rng, double depth) {
  FailingPath out{.arm = ur5e(), .cause = PathErrc::singularity};
  JointVec q = bent(rng);
  q[2] = rng.uniform(1.5, 1.9);  // the wrist may swing by 0.2 m
  q[4] = depth;
  std::vector<Pose> X_WJ(6);
  const Pose X = fk_all(out.arm, as_span(q), X_WJ);
  const Eigen::Vector3d axis5 = X_WJ[4].R * out.arm.joints[4].axis;
  const Eigen::Vector3d axis6 = X_WJ[5].R * out.arm.joints[5].axis;
  const Eigen::Vector3d turn = axis5.cross(axis6).normalized();
  const double step = 2 * depth * rng.uniform(0.6, 1.6);
  for (int i = -8; i < 8; ++i) {
    // The last axis' point stays, so that only the wrist has to move.
    const Eigen::Matrix3d R = rotation_exp((i + 0.5) * step * turn);
    const Eigen::Vector3d wrist = X_WJ[5].p;
    out.poses.push_back({wrist + R * (X.p - wrist), R * X.R});
  }
  out.arm.limits.lower[0] = q[0] - 1;
  out.arm.limits.upper[0] = q[0] + 1;
  out.arm.limits.lower[2] = 0.1;
  out.arm.home = q;
  return out;
}

/// Outwards past the stretch of an arm that reaches backwards over itself; limits of the first
/// joint keep it from facing the place at first, not at the end.
inline FailingPath branch_flip(Rng& rng, double depth) {
  FailingPath out{.arm = industrial(), .cause = PathErrc::branch_flip};
  const double middle = rng.uniform(-0.5, 0.5), stretch = 0.45 + 0.5 - 0.15;
  out.arm.limits.lower[0] = middle;
  out.arm.limits.upper[0] = middle + 2 * std::numbers::pi - 1;
  out.arm.home[0] = middle + std::numbers::pi;
  const Eigen::Matrix3d R = from_euler({rng.uniform(-1, 1), 1.6 + rng.uniform(-0.6, 0.6), 0});
  const double height = rng.uniform(-0.05, 0.05);
  constexpr int n = 80;
  for (int i = 0; i <= n; ++i) {
    const double share = static_cast<double>(i) / n;
    const double azimuth = middle - 0.3 + 0.6 * share;
    const double radius = stretch - 0.15 + (0.15 + depth) * share;
    const Eigen::Vector3d wrist(radius * std::cos(azimuth), radius * std::sin(azimuth),
                                0.4 + height);
    out.poses.push_back({wrist + 0.1 * R.col(2), R});
  }
  return out;
}

/// One pose and the next are turned about the first axis by more than max_step.
inline FailingPath far_apart(Rng& rng, double depth) {
  FailingPath out{.arm = ur5e(), .cause = PathErrc::branch_flip};
  JointVec q = bent(rng);
  const int at = 10 + static_cast<int>(rng.uniform(0, 20));
  for (int i = 0; i < 40; ++i) {
    q[0] += i == at ? 0.55 + depth : 0.02;
    out.poses.push_back(fk(out.arm, as_span(q)));
  }
  return out;
}

/// A straight joint motion at a tool speed for which one joint would have to be faster than its
/// limit by the share `depth`, on an arm whose limits leave it just that branch.
inline FailingPath joint_speed(Rng& rng, double depth) {
  FailingPath out = joint_limit(rng, 0);
  out.cause = PathErrc::joint_speed;
  out.arm.limits.lower.array() -= 0.1;
  out.arm.limits.upper.array() += 0.1;
  out.tool_speed = rng.uniform(0.1, 0.5);
  double shortest = 1e9;
  for (std::size_t i = 1; i < out.poses.size(); ++i) {
    shortest = std::min(shortest, (out.poses[i].p - out.poses[i - 1].p).norm());
  }
  const auto n = static_cast<double>(out.poses.size() - 1);
  JointVec step = (out.arm.limits.upper - out.arm.limits.lower);  // to be faster than any joint
  out.arm.limits.velocity = 2 * step / n / shortest * out.tool_speed;
  const double needed = 0.3 / n / shortest * out.tool_speed;
  out.arm.limits.velocity[out.joint] = needed / (1 + depth);
  out.amount = needed - out.arm.limits.velocity[out.joint];
  return out;
}

/// The classes and how deep each goes.
struct FailureClass {
  const char* name;
  FailingPath (*make)(Rng& rng, double depth);
  double depths[3];
};
inline constexpr FailureClass kFailureClasses[] = {
    {"out_of_reach", out_of_reach, {0.01, 0.05, 0.1}},
    {"inner_void", inner_void, {0.005, 0.04, 0.12}},
    {"joint_limit", joint_limit, {0.02, 0.1, 0.25}},
    {"collision", collision, {0.01, 0.04, 0.1}},
    {"singularity", singularity, {0.005, 0.02, 0.04}},
    {"branch_flip", branch_flip, {0.02, 0.06, 0.1}},
    {"far_apart", far_apart, {0.05, 0.4, 0.9}},
    {"joint_speed", joint_speed, {0.03, 0.3, 2}},
};

}  // namespace mjarm::testing
