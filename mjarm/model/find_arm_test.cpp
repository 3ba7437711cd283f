#include "mjarm/model/find_arm.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "mjarm/core/rng.hpp"
#include "mjarm/model/arm_chain_test.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

using ::testing::HasSubstr;

Model shipped(std::string_view name) {
  const auto file = find_model_file(name);
  EXPECT_TRUE(file) << (file ? "" : file.error().what);
  auto model = Model::load(*file);
  EXPECT_TRUE(model) << (model ? "" : model.error().what);
  return *model;
}

/// Largest difference between the composed chain and MuJoCo, over random joint values.
double worst_fk_error(const Model& model, const Arm& arm, Rng& rng, int draws) {
  double worst = 0;
  for (int n = 0; n < draws; ++n) {
    std::vector<double> qpos(model.qpos0().begin(), model.qpos0().end());
    std::vector<double> q(static_cast<std::size_t>(arm.dof()));
    for (int i = 0; i < arm.dof(); ++i) {
      q[i] = rng.uniform(-3, 3);
      qpos[arm.joints[i].qpos] = q[i];
    }
    const Pose ours = compose(arm, q);
    const auto theirs = frame_pose(model, arm.tip, qpos);
    EXPECT_TRUE(theirs);
    worst = std::max({worst, (ours.p - theirs->p).norm(), (ours.R - theirs->R).norm()});
  }
  return worst;
}

TEST(FindArm, Ur5e) {
  const Model model = shipped("ur5e");
  const auto arm = find_arm(model);
  ASSERT_TRUE(arm) << arm.error().what;
  EXPECT_EQ(arm->dof(), 6);
  EXPECT_EQ(arm->tip, "attachment_site");
  EXPECT_EQ(arm->joints[0].name, "shoulder_pan_joint");
  EXPECT_FALSE(arm->gripper);
  for (int i = 0; i < 6; ++i) {
    ASSERT_TRUE(arm->joints[i].actuator);
    EXPECT_EQ(arm->joints[i].actuator->id, i);
    EXPECT_DOUBLE_EQ(arm->limits.velocity[i], std::numbers::pi);
    EXPECT_DOUBLE_EQ(arm->limits.acceleration[i], 5);
    EXPECT_DOUBLE_EQ(arm->limits.torque[i], i < 3 ? 150 : 28);
    EXPECT_EQ(arm->limits.sources[i].velocity, LimitSource::table);
    EXPECT_EQ(arm->limits.sources[i].torque, LimitSource::file);
  }
  EXPECT_DOUBLE_EQ(arm->joints[0].actuator->gain, 2000);
  EXPECT_DOUBLE_EQ(arm->joints[0].actuator->bias[1], -2000);
  EXPECT_DOUBLE_EQ(arm->joints[0].actuator->bias[2], -400);
  EXPECT_DOUBLE_EQ(arm->home[0], -1.5708);
  const Pose home = compose(*arm, view(arm->home));
  EXPECT_NEAR((home.p - Eigen::Vector3d(-0.134, 0.492, 0.488)).norm(), 0, 1e-3);
  Rng rng(1);
  EXPECT_LT(worst_fk_error(model, *arm, rng, 200), 1e-12);
}

TEST(FindArm, Panda) {
  const Model model = shipped("panda");
  const auto arm = find_arm(model);
  ASSERT_TRUE(arm) << arm.error().what;
  EXPECT_EQ(arm->dof(), 7);
  EXPECT_EQ(arm->tip, "hand_tcp");
  ASSERT_TRUE(arm->gripper);
  EXPECT_EQ(arm->gripper->actuator, "actuator8");
  EXPECT_EQ(arm->gripper->id, 7);
  EXPECT_DOUBLE_EQ(arm->gripper->ctrl_open, 255);
  EXPECT_DOUBLE_EQ(arm->gripper->ctrl_closed, 0);
  EXPECT_EQ(arm->gripper->joints, (std::vector<std::string>{"finger_joint1", "finger_joint2"}));
  EXPECT_DOUBLE_EQ(arm->limits.velocity[6], 2.61);
  EXPECT_DOUBLE_EQ(arm->limits.jerk[1], 3750);
  Rng rng(2);
  EXPECT_LT(worst_fk_error(model, *arm, rng, 200), 1e-12);
  for (const char* tip : {"hand", "panda_link8", "left_finger"}) {
    const auto other = find_arm(model, {.tip = tip});
    ASSERT_TRUE(other) << other.error().what;
    EXPECT_EQ(other->dof(), std::string_view(tip) == "left_finger" ? 8 : 7);
    EXPECT_LT(worst_fk_error(model, *other, rng, 50), 1e-12) << tip;
  }
}

}  // namespace
}  // namespace mjarm
