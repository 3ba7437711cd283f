#include "mjarm/path/solve_curve.hpp"

#include <gtest/gtest.h>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/path/path_fix.hpp"
#include "mjarm/path/poses_test.hpp"

namespace mjarm {
namespace {

using testing::kSeed;
const Eigen::Matrix3d kDown = from_euler({std::numbers::pi, 0, 0});

/// Largest distance of the tool from the curve, joints moving straight between waypoints; at 16
/// places between any two.
void expect_on_curve(const Arm& arm, const Curve& curve, const JointPath& path,
                     const CurveOptions& options, const PathChange& change = {}) {
  double pos = 0, rot = 0;
  for (std::size_t i = 1; i < path.q.size(); ++i) {
    EXPECT_LT(path.s[i - 1], path.s[i]);
    for (int k = 0; k <= 16; ++k) {
      const double t = k / 16.0;
      const Pose X = fk(arm, as_span(JointVec((1 - t) * path.q[i - 1] + t * path.q[i])));
      const Pose X_goal = change(curve.at((1 - t) * path.s[i - 1] + t * path.s[i]));
      pos = std::max(pos, (X.p - X_goal.p).norm());
      rot = std::max(rot, angle_between(X.R, X_goal.R));
    }
  }
  EXPECT_LE(pos, 1.1 * options.pos_tol);
  EXPECT_LE(rot, 1.1 * options.rot_tol);
  EXPECT_EQ(path.s.front(), 0);
  EXPECT_EQ(path.s.back(), curve.end());
}

TEST(SolveCurve, StaysOnTheCurveInAsFewWaypointsAsItTakes) {
  const IkSolver ik(testing::ur5e());
  const Curve line = *Curve::line({{0.4, -0.4, 0.3}, kDown}, {{-0.4, -0.4, 0.3}, kDown});
  const auto path = solve_curve(ik, line, kSeed);
  ASSERT_TRUE(path.has_value()) << describe(path.error(), ik.arm());
  expect_on_curve(ik.arm(), line, *path, {});
  CurveOptions coarse{.pos_tol = 0.01, .rot_tol = 0.1, .step = 0.5, .turn = 1};
  const auto few = solve_curve(ik, line, kSeed, coarse);
  ASSERT_TRUE(few.has_value());
  expect_on_curve(ik.arm(), line, *few, coarse);
  EXPECT_LT(few->q.size(), path->q.size() / 4);
  CurveOptions fine{.pos_tol = 1e-6, .rot_tol = 1e-5};
  const auto many = solve_curve(ik, line, kSeed, fine);
  ASSERT_TRUE(many.has_value());
  expect_on_curve(ik.arm(), line, *many, fine);
  EXPECT_GT(many->q.size(), path->q.size());
}

TEST(SolveCurve, ArcsEllipsesAndTurns) {
  const IkSolver ik(testing::ur5e());
  const Pose from{{0.4, -0.4, 0.3}, kDown}, to{{-0.2, -0.5, 0.4}, kDown * from_euler({0, 0, 1})};
  for (const Curve& curve :
       {*Curve::arc(from, {{0.1, -0.6, 0.5}, kDown}, to),
        *Curve::ellipse({{0, -0.5, 0.4}, 0.3, 0.1, Eigen::Vector3d::UnitZ(), kDown}),
        *Curve::line(from, {from.p, kDown * from_euler({0.3, 0, 2})}),
        *Curve::polyline(std::vector<Pose>{from, to, {{0.3, -0.3, 0.5}, kDown}})}) {
    const auto path = solve_curve(ik, curve, kSeed);
    ASSERT_TRUE(path.has_value()) << describe(path.error(), ik.arm());
    expect_on_curve(ik.arm(), curve, *path, {});
    EXPECT_LE(path->max_step(), 0.5);
  }
}

TEST(SolveCurve, TheArmOfSevenJoints) {
  const IkSolver ik(testing::panda());
  const Curve line = *Curve::line({{0.4, -0.4, 0.3}, kDown}, {{0.4, 0.4, 0.5}, kDown});
  const auto path = solve_curve(ik, line, as_span(ik.arm().home));
  ASSERT_TRUE(path.has_value()) << describe(path.error(), ik.arm());
  expect_on_curve(ik.arm(), line, *path, {});
}

/// A circle before the Panda.
Curve circle() {
  return *Curve::ellipse({{0.45, 0, 0.3}, 0.05, 0.05, Eigen::Vector3d::UnitZ(), kDown});
}

/// [rad/m^2] The largest difference of d^2 q / ds^2 from one waypoint to the next, of any joint.
double sharpest_change(const JointPath& path) {
  double worst = 0;
  JointVec last;
  for (std::size_t i = 1; i + 1 < path.q.size(); ++i) {
    const JointVec before = (path.q[i] - path.q[i - 1]) / (path.s[i] - path.s[i - 1]);
    const JointVec after = (path.q[i + 1] - path.q[i]) / (path.s[i + 1] - path.s[i]);
    const JointVec turn = (after - before) / (0.5 * (path.s[i + 1] - path.s[i - 1]));
    if (i > 1) worst = std::max(worst, (turn - last).cwiseAbs().maxCoeff());
    last = turn;
  }
  return worst;
}

/// It is 76 where the answers between two waypoints are sought from straight motions.
TEST(SolveCurve, SelfMotionsDoNotTurnOffAtWaypoints) {
  const Arm arm = testing::panda();
  for (const bool closed_form : {true, false}) {
    const IkSolver ik(arm, {.closed_form = closed_form});
    const auto path = solve_curve(ik, circle(), as_span(arm.home));
    ASSERT_TRUE(path.has_value()) << describe(path.error(), arm);
    EXPECT_LT(sharpest_change(*path), 30);
  }
}

/// As a search goes aside where it gets tight, the largest difference of two steps is 0.125 rad.
TEST(SolveCurve, AnArmGoesAsideEvenly) {
  const Arm arm = testing::panda();
  const auto free = solve_curve(IkSolver(arm), circle(), as_span(arm.home));
  ASSERT_TRUE(free.has_value());
  double highest = 0;
  for (const JointVec& q : free->q) highest = std::max(highest, q[6]);
  std::vector<double> s;
  for (int i = 0; i <= 200; ++i) s.push_back(i * circle().end() / 200);
  const std::vector<Pose> poses = circle().poses(s);
  for (const double missing : {0.0, 0.02, 0.04}) {
    Arm narrow = arm;
    narrow.limits.upper[6] = highest + 0.1 - missing;  // 0.1 rad are wanted
    for (const bool closed_form : {true, false}) {
      const IkSolver ik(narrow, {.closed_form = closed_form});
      const auto path = solve_path(ik, poses, s, as_span(free->q[0]), {.keep_start = true});
      ASSERT_TRUE(path.has_value()) << describe(path.error(), narrow);
      testing::expect_on_poses(narrow, *path, poses);
      double uneven = 0;
      for (std::size_t i = 1; i + 1 < path->q.size(); ++i) {
        const JointVec d = path->q[i + 1] - 2 * path->q[i] + path->q[i - 1];
        uneven = std::max(uneven, d.cwiseAbs().maxCoeff());
      }
      EXPECT_LT(uneven, 0.02) << missing;
    }
  }
}

TEST(SolveCurve, SaysWhereItStops) {
  const IkSolver ik(testing::ur5e());
  // With the tool down, the wrist cannot come nearer to the first axis than 0.134 m.
  const Curve line = *Curve::line({{0, -0.6, 0.3}, kDown}, {{0, 0, 0.3}, kDown});
  const auto path = solve_curve(ik, line, kSeed);
  ASSERT_FALSE(path.has_value());
  EXPECT_EQ(path.error().code, PathErrc::inner_void);
  EXPECT_NEAR(path.error().s, 0.6 - 0.134, 1e-3);
  EXPECT_NEAR(path.error().fraction, path.error().s / 0.6, 1e-12);
  EXPECT_EQ(path.error().partial.s.back(), path.error().s);
  const auto fixes = find_fixes(ik, line, kSeed, {}, path.error());
  ASSERT_FALSE(fixes.empty());
  for (const PathFix& fix : fixes) {
    const CurveOptions changed{.change = fix.change};
    const auto mended = solve_curve(ik, line, kSeed, changed);
    ASSERT_TRUE(mended.has_value()) << describe(fix);
    expect_on_curve(ik.arm(), line, *mended, {}, fix.change);
  }
}

TEST(SolveCurve, ThroughAWristSingularity) {
  // The last axis passes the direction of axis 4 exactly: the tool turns about axis 5.
  const Arm arm = testing::ur5e();
  const IkSolver ik(arm);
  const Pose X = fk(arm, std::vector<double>{-1.0, -1.5, 1.6, -1.2, 0, 0.3});
  std::vector<Pose> X_WJ(6);
  fk_all(arm, std::vector<double>{-1.0, -1.5, 1.6, -1.2, 0, 0.3}, X_WJ);
  const Eigen::Vector3d axis5 = X_WJ[4].R * arm.joints[4].axis;
  const Curve turn =
      *Curve::line({X.p, rotation_exp(-0.4 * axis5) * X.R}, {X.p, rotation_exp(0.4 * axis5) * X.R});
  const auto path = solve_curve(ik, turn, kSeed);
  ASSERT_TRUE(path.has_value()) << describe(path.error(), arm);
  expect_on_curve(arm, turn, *path, {});
}

/// Largest share of a velocity limit that the joints use at a tool speed, by differences.
double speed_use(const Arm& arm, const JointPath& path, double tool_speed) {
  double max = 0;
  for (std::size_t i = 1; i < path.q.size(); ++i) {
    const double time = (path.s[i] - path.s[i - 1]) / tool_speed;
    const JointVec speed = (path.q[i] - path.q[i - 1]).cwiseAbs() / time;
    max = std::max(max, speed.cwiseQuotient(arm.limits.velocity).maxCoeff());
  }
  return max;
}

TEST(SolveCurve, ASpeedTooHighPastAWristSingularityAndOneThatIsNot) {
  const Arm arm = testing::ur5e(true);
  const IkSolver ik(arm);
  const Eigen::Matrix3d R = rotation_exp({0, std::numbers::pi / 2 + 0.035, 0});
  const Curve line = *Curve::line({{-0.25, -0.45, 0.45}, R}, {{0.35, -0.45, 0.45}, R});
  const CurveOptions asked{.path = {.tool_speed = 0.25}};
  const auto slow = solve_curve(ik, line, kSeed);
  ASSERT_TRUE(slow.has_value()) << describe(slow.error(), arm);
  EXPECT_GT(speed_use(arm, *slow, 0.25), 2);
  const auto fast = solve_curve(ik, line, kSeed, asked);
  ASSERT_FALSE(fast.has_value());
  EXPECT_EQ(fast.error().code, PathErrc::joint_speed) << describe(fast.error(), arm);
  EXPECT_GT(fast.error().amount, 0);
  const auto fixes = find_fixes(ik, line, kSeed, asked, fast.error(), 2);
  ASSERT_FALSE(fixes.empty());
  EXPECT_EQ(fixes[0].kind, FixKind::slower);
  for (const PathFix& fix : fixes) {
    CurveOptions mended = asked;
    mended.change = fix.change;
    if (fix.kind == FixKind::slower) mended.path.tool_speed = fix.tool_speed;
    const auto path = solve_curve(ik, line, kSeed, mended);
    ASSERT_TRUE(path.has_value()) << describe(fix);
    EXPECT_LE(speed_use(arm, *path, mended.path.tool_speed), 1.002) << describe(fix);
  }
}

TEST(SolveCurve, BadOptionsAreRefused) {
  const IkSolver ik(testing::ur5e());
  const Curve line = *Curve::line({{0.4, -0.4, 0.3}, kDown}, {{-0.4, -0.4, 0.3}, kDown});
  for (const CurveOptions& bad :
       {CurveOptions{.pos_tol = 0}, CurveOptions{.rot_tol = -1}, CurveOptions{.step = 0},
        CurveOptions{.turn = std::nan("")}, CurveOptions{.path = {.max_step = 0}}}) {
    const auto path = solve_curve(ik, line, kSeed, bad);
    ASSERT_FALSE(path.has_value());
    EXPECT_EQ(path.error().code, PathErrc::bad_input);
  }
}

}  // namespace
}  // namespace mjarm
