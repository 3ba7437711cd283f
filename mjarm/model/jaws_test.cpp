#include "mjarm/model/jaws.hpp"

#include <gtest/gtest.h>

#include "mjarm/model/find_arm.hpp"
#include "mjarm/model/shipped_test.hpp"

namespace mjarm {
namespace {

TEST(Jaws, OfOurGrippersAreAsTheirFilesSay) {
  for (const char* name : {"ur5e_gripper", "panda"}) {
    SCOPED_TRACE(name);
    const Model model = testing::shipped(name);
    const auto arm = find_arm(model);
    ASSERT_TRUE(arm) << arm.error().what;
    const auto jaws = find_jaws(model, *arm);
    ASSERT_TRUE(jaws) << jaws.error().what;
    const bool ur5e = arm->dof() == 6;
    EXPECT_NEAR(jaws->opening, ur5e ? 0.085 : 0.0804, 1e-4);
    EXPECT_NEAR(jaws->half_width, ur5e ? 0.011 : 0.009, 1e-3);
    EXPECT_NEAR(jaws->tips, ur5e ? 0.015 : 0.0093, 1.5e-3);
    EXPECT_NEAR(jaws->palm, ur5e ? 0.0555 : 0.0374, 1e-3);
    EXPECT_LT(jaws->center_T.norm(), 1e-4);
    EXPECT_NEAR(std::abs(jaws->close_T.y()), 1, 1e-12);
    EXPECT_TRUE(jaws->approach_T.isApprox(Eigen::Vector3d::UnitZ()));
  }
}

TEST(Jaws, AreNotFoundWithoutAGripper) {
  const Model ur5e = testing::shipped("ur5e");
  const auto bare = find_jaws(ur5e, find_arm(ur5e).value());
  ASSERT_FALSE(bare);
  EXPECT_EQ(bare.error().what, "ur5e scene has no gripper");
}

TEST(Jaws, AreFoundFromAnyToolFrame) {
  const Model model = testing::shipped("ur5e_gripper");
  const auto tool = find_jaws(model, find_arm(model).value());
  const auto flange = find_jaws(model, find_arm(model, {.tip = "attachment_site"}).value());
  ASSERT_TRUE(tool && flange) << flange.error().what;
  EXPECT_NEAR(flange->opening, tool->opening, 1e-4);
  // Both frames are parallel; the pads reach from 123 to 160 mm from the flange.
  EXPECT_NEAR(std::abs(flange->close_T.dot(tool->close_T)), 1, 1e-9);
  EXPECT_GT(flange->center_T.z(), 0.123);
  EXPECT_LT(flange->center_T.z(), 0.16);
  EXPECT_TRUE(flange->approach_T.isApprox(Eigen::Vector3d::UnitZ()));
}

}  // namespace
}  // namespace mjarm
