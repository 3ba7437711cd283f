#include "mjarm/trajectory/tool_motion.hpp"

#include <gtest/gtest.h>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/trajectory/tool_down_test.hpp"

namespace mjarm {
namespace {

using testing::kDown;
using testing::kSeed;

Curve the_ellipse() {
  return *Curve::ellipse({{0, -0.5, 0.4}, 0.3, 0.15, Eigen::Vector3d::UnitZ(), kDown});
}

/// Largest distance and angle of the moving tool from the curve.
struct Strayed {
  double pos = 0;
  double rot = 0;
};
Strayed strayed(const Arm& arm, const ToolMotion& motion) {
  Strayed out;
  for (double t = 0; t <= motion.trajectory.duration(); t += 0.0013) {
    const Pose X = fk(arm, as_span(motion.trajectory.at(t).q));
    const Curve::Nearest nearest = motion.curve.nearest(X.p);
    out.pos = std::max(out.pos, nearest.distance);
    out.rot = std::max(out.rot, angle_between(motion.curve.at(nearest.s).R, X.R));
  }
  return out;
}

TEST(ToolMotion, StaysOnTheCurve) {
  for (const Arm& arm : {testing::ur5e(), testing::panda()}) {
    const IkSolver ik(arm);
    const auto start = arm.dof() == 6 ? std::span<const double>(kSeed) : as_span(arm.home);
    for (const Curve& curve :
         {the_ellipse(), *Curve::line({{0.3, -0.4, 0.3}, kDown},
                                      {{-0.3, -0.4, 0.4}, kDown * from_euler({0.3, 0, 1})})}) {
      const auto motion = plan_tool_motion(ik, curve, start);
      ASSERT_TRUE(motion.has_value()) << describe(motion.error(), arm);
      const Strayed off = strayed(arm, *motion);
      EXPECT_LT(off.pos, 1e-8);
      EXPECT_LT(off.rot, 1e-7);
      const LimitUse use = check_limits(motion->trajectory, arm.limits);
      EXPECT_LE(use.worst(), 1 + 1e-6);
    }
  }
}

TEST(ToolMotion, ALooserToleranceTakesFewerWaypoints) {
  const IkSolver ik(testing::ur5e());
  const auto close = plan_tool_motion(ik, the_ellipse(), kSeed);
  const auto loose = plan_tool_motion(ik, the_ellipse(), kSeed, {.pos_tol = 1e-4, .rot_tol = 1e-3});
  ASSERT_TRUE(close && loose);
  EXPECT_LT(loose->path.q.size(), close->path.q.size() / 4);
  EXPECT_LT(strayed(ik.arm(), *loose).pos, 1e-4);
}

TEST(ToolMotion, APositionAloneLeavesTheOrientationFree) {
  const IkSolver ik(testing::ur5e(), {.task = IkTask::position});
  const auto motion = plan_tool_motion(ik, the_ellipse(), kSeed);
  ASSERT_TRUE(motion.has_value()) << describe(motion.error(), ik.arm());
  EXPECT_LT(motion->path.q.size(), 20000U);
  EXPECT_LT(strayed(ik.arm(), *motion).pos, 1e-6);
}

TEST(ToolMotion, FailuresSayWhy) {
  const IkSolver ik(testing::ur5e());
  const Curve far = *Curve::line({{0, -0.5, 0.4}, kDown}, {{0, -2, 0.4}, kDown});
  const auto unreachable = plan_tool_motion(ik, far, kSeed);
  ASSERT_FALSE(unreachable.has_value());
  ASSERT_TRUE(unreachable.error().path.has_value());
  EXPECT_EQ(unreachable.error().path->code, PathErrc::out_of_reach);
  EXPECT_FALSE(unreachable.error().timing.has_value());
  const auto still = plan_tool_motion(ik, the_ellipse(), kSeed, {.timing = {.tool_speed = 0}});
  ASSERT_FALSE(still.has_value());
  EXPECT_TRUE(still.error().timing.has_value());
  EXPECT_NE(describe(still.error(), ik.arm()), "");
  const auto exact = plan_tool_motion(ik, the_ellipse(), kSeed, {.pos_tol = 0});
  ASSERT_FALSE(exact.has_value());
  ASSERT_TRUE(exact.error().path.has_value());
  EXPECT_EQ(exact.error().path->code, PathErrc::bad_input);
}

}  // namespace
}  // namespace mjarm
