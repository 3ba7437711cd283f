#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/path/curve.hpp"
#include "mjarm/path/solve_path.hpp"
#include "mjarm/trajectory/spline_internal.hpp"
#include "mjarm/trajectory/trajectory.hpp"
#include "tests/support/constants.hpp"
#include "tests/support/test_data.hpp"

namespace mjarm {
namespace {

using support::kNaN;

/// UR5e with the limits of its data sheet and driver.
Arm timed_ur5e() {
  Arm arm = testing::ur5e();
  arm.limits.velocity.setConstant(std::numbers::pi);
  arm.limits.acceleration.setConstant(5);
  arm.limits.jerk.setConstant(100);
  return arm;
}

JointPath path_along(const Arm& arm, const Curve& curve, double step = 0.001) {
  const std::vector<double> seed{-1.57, -1.34, 2.65, -1.3, 1.55, 0};
  const std::vector<double> s = curve.stations(step, 0.02);
  auto path = solve_path(IkSolver(arm), curve.poses(s), s, seed);
  EXPECT_TRUE(path.has_value());
  return path.value_or(JointPath{});
}

Pose tool_down(double x, double y, double z) { return {{x, y, z}, from_euler({3.14, 0, 0})}; }

/// Times `path` and checks all that must always hold.
Trajectory checked(const JointPath& path, std::span<const double> stops, const JointLimits& limits,
                   const TimingOptions& options) {
  const auto timed = time_tool_path(path, stops, limits, options);
  EXPECT_TRUE(timed.has_value()) << timed.error().what;
  const double T = timed->duration();
  EXPECT_EQ(timed->at(0).q, path.q.front());
  EXPECT_EQ(timed->at(T).q, path.q.back());
  for (const double t : {0.0, T}) {
    EXPECT_EQ(timed->at(t).v.norm(), 0);
    EXPECT_EQ(timed->at(t).a.norm(), 0);
  }
  const LimitUse use = check_limits(*timed, limits, T / 7001);
  EXPECT_LE(use.worst(), (1 + 1e-6) * options.joint_share);
  EXPECT_LE(use.jerk.maxCoeff(), 1 + 1e-6);
  EXPECT_GE(T, (path.s.back() - path.s.front()) / options.tool_speed);
  return *timed;
}

/// Largest jump of the acceleration and largest disagreement of v and a with differences.
void expect_smooth(const Trajectory& trajectory, double jerk_bound) {
  const double h = 1e-5;
  const auto n = static_cast<int>(std::min(2000.0, trajectory.duration() / (3 * h)));
  for (int k = 1; k < n; ++k) {
    const double t = trajectory.duration() * k / n;
    const JointState x = trajectory.at(t), low = trajectory.at(t - h), high = trajectory.at(t + h);
    EXPECT_LT(((high.q - low.q) / (2 * h) - x.v).cwiseAbs().maxCoeff(), h * h * jerk_bound + 1e-9);
    EXPECT_LT(((high.v - low.v) / (2 * h) - x.a).cwiseAbs().maxCoeff(), h * jerk_bound + 1e-6);
  }
}

/// Largest and smallest tool speed away from the ends, and the largest distance from the curve.
struct Drawn {
  double fastest = 0;
  double slowest = 1e9;
  double deviation = 0;
};
Drawn drawn(const Arm& arm, const Curve& curve, const Trajectory& timed) {
  Drawn d;
  for (double t = 0; t < timed.duration(); t += 0.0017) {
    const JointState x = timed.at(t);
    const FkJacobian tool = fk_jacobian(arm, as_span(x.q));
    const double speed = (tool.J_W.topRows(3) * x.v).norm();
    d.deviation = std::max(d.deviation, curve.nearest(tool.X_WT.p).distance);
    d.fastest = std::max(d.fastest, speed);
    if (t > 0.5 && t < timed.duration() - 0.5) d.slowest = std::min(d.slowest, speed);
  }
  return d;
}

Curve ellipse_at(double y, double z) {
  return *Curve::ellipse(
      {{0, y, z}, 0.3, 0.15, Eigen::Vector3d::UnitZ(), from_euler({3.14, 0, 0})});
}

TEST(ToolPath, AnEllipseIsDrawnAtItsSpeedOnItsCurve) {
  const Arm arm = timed_ur5e();
  const Curve curve = ellipse_at(-0.45, 0.4);
  const Trajectory timed = checked(path_along(arm, curve), curve.corners(), arm.limits, {});
  expect_smooth(timed, 200);
  EXPECT_LE(check_limits(timed, arm.limits).jerk.maxCoeff(), 1);
  // Speed up, cruise, slow down, and 0.1 s for the changes of acceleration.
  EXPECT_NEAR(timed.duration(), curve.length() / 0.25 + 0.25 + 0.1, 5e-3);
  const Drawn d = drawn(arm, curve, timed);
  EXPECT_NEAR(d.fastest, 0.25, 5e-5);
  EXPECT_NEAR(d.slowest, 0.25, 5e-5);
  EXPECT_LT(d.deviation, 1e-8);
}

TEST(ToolPath, TheEllipseOfTheDemoSlowsDownNearTheBaseAxis) {
  const Arm arm = timed_ur5e();
  const Curve curve = ellipse_at(-0.3, 0.5);
  const Trajectory timed = checked(path_along(arm, curve), curve.corners(), arm.limits, {});
  expect_smooth(timed, 200);
  EXPECT_LE(check_limits(timed, arm.limits).jerk.maxCoeff(), 1);
  EXPECT_LT(timed.duration(), curve.length() / 0.25 + 0.25 + 0.3);
  const Drawn d = drawn(arm, curve, timed);
  EXPECT_NEAR(d.fastest, 0.25, 5e-5);
  EXPECT_LT(d.slowest, 0.249);
  EXPECT_LT(d.deviation, 1e-8);
  RecordProperty("slowest", std::to_string(d.slowest));
  RecordProperty("duration", std::to_string(timed.duration()));
}

TEST(ToolPath, RestsAtCorners) {
  const Arm arm = timed_ur5e();
  const Curve curve = *Curve::polyline(std::vector<Pose>{
      tool_down(0.3, -0.4, 0.4), tool_down(0.3, -0.4, 0.2), tool_down(0.5, -0.4, 0.2)});
  const JointPath path = path_along(arm, curve);
  const Trajectory timed = checked(path, curve.corners(), arm.limits, {});
  expect_smooth(timed, 500);
  double nearest = 1, speed_there = 1;
  for (double t = 0.2; t < timed.duration() - 0.2; t += 0.0005) {
    const JointState x = timed.at(t);
    const double away = (fk(arm, as_span(x.q)).p - curve.at(0.2).p).norm();
    EXPECT_LT(curve.nearest(fk(arm, as_span(x.q)).p).distance, 1e-6);
    if (away < nearest) {
      nearest = away;
      speed_there = x.v.norm();
    }
  }
  EXPECT_LT(nearest, 1e-8);
  EXPECT_LT(speed_there, 1e-3);
}

TEST(ToolPath, JointLimitsSlowTheToolDown) {
  const Arm arm = timed_ur5e();
  // Close to the base axis the first joint has to turn fast.
  const Curve curve = *Curve::line(tool_down(-0.5, -0.15, 0.4), tool_down(0.5, -0.15, 0.4));
  const JointPath path = path_along(arm, curve);
  const TimingOptions fast{.tool_speed = 2, .joint_share = 0.8, .tool_accel = 20};
  const Trajectory timed = checked(path, curve.corners(), arm.limits, fast);
  const LimitUse use = check_limits(timed, arm.limits);
  EXPECT_GT(use.worst(), 0.6);
  EXPECT_GT(timed.duration(), 1.0);
  for (double t = 0; t < timed.duration(); t += 0.001) {
    EXPECT_LT(curve.nearest(fk(arm, as_span(timed.at(t).q)).p).distance, 1e-6);
  }
}

TEST(ToolPath, TurnsOnTheSpotAreTimedByTheirAngle) {
  const Arm arm = timed_ur5e();
  const Pose from = tool_down(0.2, -0.45, 0.4);
  const Curve curve = *Curve::line(from, {from.p, from.R * from_euler({0, 0, 1})});
  const JointPath path = path_along(arm, curve);
  const Trajectory timed = checked(path, curve.corners(), arm.limits, {.tool_speed = 0.5});
  EXPECT_NEAR(timed.duration(), 1 / 0.5 + 0.5 + 0.1, 0.01);
}

TEST(ToolPath, RandomSplinesKeepTheirLimits) {
  Rng rng(11);
  for (int i = 0; i < 200; ++i) {
    const auto dof = static_cast<Eigen::Index>(1 + rng.below(7));
    const auto n = 2 + rng.below(9);
    JointPath path;
    double s = rng.uniform(-1, 1);
    for (std::uint64_t k = 0; k < n; ++k) {
      JointVec q(dof);
      for (double& x : q) x = rng.uniform(-1, 1);
      path.q.push_back(q);
      path.s.push_back(s);
      s += std::pow(10, rng.uniform(-1.5, 0));
    }
    JointLimits limits;
    limits.velocity = limits.acceleration = limits.jerk = JointVec(dof);
    limits.lower = JointVec::Constant(dof, -99);
    limits.upper = -limits.lower;
    for (Eigen::Index j = 0; j < dof; ++j) {
      limits.velocity[j] = rng.uniform(0.5, 5);
      limits.acceleration[j] = rng.uniform(1, 20);
      limits.jerk[j] = std::pow(10, rng.uniform(2, 4));
    }
    const std::vector<double> stops{path.s[rng.below(n)]};
    const TimingOptions options{.tool_speed = std::pow(10, rng.uniform(-1, 1)),
                                .joint_share = rng.uniform(0.1, 1),
                                .tool_accel = std::pow(10, rng.uniform(-1, 2))};
    checked(path, stops, limits, options);
  }
}

TEST(ToolPath, ShortPathsAndSinglePoints) {
  const JointVec one = JointVec::Ones(1);
  const JointLimits limits{-9 * one, 9 * one, one, 5 * one, 100 * one, one, {}};
  for (const double length : {1e-9, 1e-6, 1e-3}) {
    const JointPath path{{0, length}, {one, one + length * one}};
    const Trajectory timed = checked(path, {}, limits, {});
    EXPECT_LT(timed.duration(), 0.3);
    EXPECT_NEAR(timed.at(0.5 * timed.duration()).q[0] - 1, 0.5 * length, 1e-3 * length + 1e-15);
  }
  const auto point = time_tool_path({{0}, {one}}, {}, limits);
  ASSERT_TRUE(point.has_value());
  EXPECT_EQ(point->duration(), 0);
  EXPECT_EQ(point->at(1).q[0], 1);
}

TEST(ToolPath, SameInputSameTrajectory) {
  const Arm arm = timed_ur5e();
  const Curve curve = *Curve::line(tool_down(0.3, -0.4, 0.4), tool_down(-0.3, -0.3, 0.4));
  const JointPath path = path_along(arm, curve, 0.01);
  const auto first = time_tool_path(path, {}, arm.limits),
             again = time_tool_path(path, {}, arm.limits);
  ASSERT_TRUE(first && again);
  ASSERT_EQ(first->duration(), again->duration());
  for (double t = 0; t < first->duration(); t += 0.01) EXPECT_EQ(first->at(t).a, again->at(t).a);
}

TEST(ToolPath, RefusesBadInput) {
  const JointVec one = JointVec::Ones(1);
  const JointLimits limits{-9 * one, 9 * one, one, one, one, one, {}};
  const auto what = [&](const JointPath& path, std::vector<double> stops = {},
                        const TimingOptions& options = {}) {
    const auto timed = time_tool_path(path, stops, limits, options);
    return timed ? std::string("none") : timed.error().what;
  };
  const JointPath good{{0, 1}, {one, 2 * one}};
  EXPECT_EQ(what(good, {0, 1}), "none");
  EXPECT_NE(what({}), "none");
  EXPECT_NE(what({{0, 1}, {one}}), "none");
  EXPECT_NE(what({{0, 0}, {one, one}}).find("waypoint 1"), std::string::npos);
  EXPECT_NE(what({{0, kNaN}, {one, one}}).find("waypoint 1"), std::string::npos);
  EXPECT_NE(what({{0, 1}, {one, kNaN * one}}).find("waypoint 1"), std::string::npos);
  EXPECT_NE(what({{0, 1}, {one, JointVec::Ones(2)}}).find("waypoint 1"), std::string::npos);
  EXPECT_NE(what({{0}, {JointVec()}}), "none");
  EXPECT_NE(what(good, {0.5}).find("0.5"), std::string::npos);
  EXPECT_NE(what(good, {kNaN}), "none");
  EXPECT_NE(what(good, {2}), "none");
  EXPECT_NE(what(good, {}, {.tool_speed = 0}).find("speed is 0"), std::string::npos);
  EXPECT_NE(what(good, {}, {.tool_accel = -1}).find("acceleration is -1"), std::string::npos);
  EXPECT_NE(what(good, {}, {.tool_ramp = 0}).find("ramp is 0"), std::string::npos);
  EXPECT_NE(what({{0, 1}, {JointVec::Ones(2), JointVec::Ones(2)}}).find("2 joints"),
            std::string::npos);
}

TEST(CubicSpline, ReproducesCubicsAndMeetsItsWaypoints) {
  Rng rng(12);
  for (int i = 0; i < 100; ++i) {
    const double c[4] = {rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1),
                         rng.uniform(-1, 1)};
    std::vector<double> s{rng.uniform(-1, 1)};
    std::vector<JointVec> q;
    const auto n = 4 + rng.below(10);
    while (s.size() < n) s.push_back(s.back() + std::pow(10, rng.uniform(-2, 0)));
    for (const double x : s)
      q.push_back(JointVec::Constant(1, c[0] + x * (c[1] + x * (c[2] + x * c[3]))));
    const detail::CubicSpline spline(s, q);
    for (std::size_t k = 0; k < n; ++k) EXPECT_EQ(spline.at(s[k]).q, q[k]);
    for (int k = 0; k < 20; ++k) {
      const double x = rng.uniform(s.front(), s.back());
      const detail::SplinePoint p = spline.at(x);
      const double size = 1 + std::pow(s.back(), 3);
      EXPECT_NEAR(p.q[0], c[0] + x * (c[1] + x * (c[2] + x * c[3])), 1e-10 * size);
      EXPECT_NEAR(p.d[0], c[1] + x * (2 * c[2] + x * 3 * c[3]), 1e-8 * size);
      EXPECT_NEAR(p.e[0], 2 * c[2] + x * 6 * c[3], 1e-6 * size);
    }
  }
}

TEST(ToolPathData, TheFastEllipseIsNearTheOptimum) {
  MJARM_TEST_FILE(file, "trajectory_cases/ur5e_ellipse.json");
  MJARM_TEST_FILE(best_file, "trajectory_cases/best_known.json");
  const nlohmann::json entry = support::load_json(file).at("cases").at(0);
  const double best =
      support::load_json(best_file).at("ur5e_ellipse").at("spline_va").at("0").get<double>();
  JointPath path;
  for (const auto& q : entry.at("waypoints")) {
    path.q.push_back(joint_vec(q.get<std::vector<double>>()));
    const double step = path.s.empty() ? 0 : (path.q.back() - path.q[path.q.size() - 2]).norm();
    path.s.push_back(path.s.empty() ? 0 : path.s.back() + step);
  }
  const Arm arm = timed_ur5e();
  const TimingOptions unbounded{.tool_speed = 1e3, .tool_accel = 1e4, .tool_ramp = 1e-3};
  const Trajectory timed = checked(path, {}, arm.limits, unbounded);
  // The optimum may jump in acceleration, ours not.
  EXPECT_GT(timed.duration(), best * 0.999);
  EXPECT_LT(timed.duration(), 1.04 * best);
  RecordProperty("over_best", std::to_string(timed.duration() / best));
}

}  // namespace
}  // namespace mjarm
