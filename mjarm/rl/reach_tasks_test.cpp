#include <gmock/gmock.h>
#include <mujoco/mujoco.h>

#include <cmath>

#include "mjarm/core/rotation.hpp"
#include "mjarm/rl/reach_test.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::rl {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;
using testing::random_step;
using testing::reach_env;
using testing::row;
using testing::task_model;

TEST(ReachTasks, OrientationIsSeenAndJudged) {
  ReachEnv env = reach_env({.environments = 2, .episode_steps = 4, .orientation = true});
  ASSERT_EQ(env.observation_size(), 35);
  for (int step = 0; step < 4; ++step) random_step(env, step);
  const auto last = row(env.final_observations(), 1, 35);
  const Eigen::Vector3d x(last[17], last[18], last[19]), y(last[20], last[21], last[22]);
  const Eigen::Vector3d z = x.cross(y), turn(last[32], last[33], last[34]);
  EXPECT_GT(turn.norm(), 0.01);
  EXPECT_NEAR(env.final_turns()[1], std::acos(-z.z()), 1e-5);
  EXPECT_LT((rotation_exp(turn) * z - Eigen::Vector3d(0, 0, -1)).norm(), 1e-5);
}

TEST(ReachTasks, TheBallStandsBetweenAndCostsWhenTouched) {
  const ReachOptions options{.environments = 30, .obstacle = true};
  ReachEnv env = reach_env(options);
  ASSERT_EQ(env.observation_size(), 35);
  for (int i = 0; i < env.count(); ++i) {
    const auto seen = row(env.observations(), i, 35);
    const Eigen::Vector3d p = env.tool(i).p;
    const Eigen::Vector3d ball = p + Eigen::Vector3d(seen[32], seen[33], seen[34]);
    EXPECT_LT((ball - (p + env.goal(i)) / 2).norm(), 0.05 * std::sqrt(3.0) + 1e-6);
    EXPECT_GT((ball - env.goal(i)).norm(), 0.15 - 1e-6);
    const mjModel* m = env.model().raw();
    mjData* d = mj_makeData(m);
    mj_setState(m, d, env.snapshot(i).state.data(), mjSTATE_INTEGRATION);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(d->mocap_pos[k], ball[k], 1e-6);
    mj_deleteData(d);
  }
  // Straight ahead the way of some is blocked.
  const testing::Expert expert(env.arm(), options);
  std::vector<float> actions(30 * 7);
  int touching = 0;
  for (int step = 0; step < 40; ++step) {
    for (int i = 0; i < env.count(); ++i) {
      expert.act(row(env.observations(), i, 35), row(std::span(actions), i, 7));
    }
    ASSERT_TRUE(env.step(actions));
    for (const auto flag : env.touching()) touching += flag;
  }
  EXPECT_GT(touching, 0);
}

TEST(ReachTasks, RefusesOptionsThatMakeNoSense) {
  const Model model = task_model();
  ReachReward odd;
  odd.fine_scale = 0;
  const std::pair<ReachOptions, const char*> wrong[] = {
      {{.environments = 0}, "environments"},
      {{.threads = 0}, "threads"},
      {{.frame_skip = 0}, "frame_skip"},
      {{.episode_steps = -1}, "episode_steps"},
      {{.start = {1, 2}}, "start"},
      {{.start = {0, -0.7, 0, 1, 0, 1.5, 0.7}}, "joint4"},
      {{.start = {0, 0, 0, -0.07, 0, 0, 0}}, "touches"},
      {{.start_spread = std::nan("")}, "start_spread"},
      {{.speed = 0}, "speed"},
      {{.torque = 2}, "torque"},
      {{.reward = odd}, "reward.fine_scale"},
      {{.obstacle = true}, "reach_obstacle.xml"},
      {{.frame_skip = 2, .guide = true}, "guide"}};
  for (const auto& [options, words] : wrong) {
    const auto env = ReachEnv::create(model, options);
    ASSERT_FALSE(env) << words;
    EXPECT_THAT(env.error().what, HasSubstr(words));
  }
  const auto region = reach_region("wides");
  ASSERT_FALSE(region);
  EXPECT_THAT(region.error().what, HasSubstr("did you mean \"wide\""));
  EXPECT_EQ(*reach_action("torque"), ReachAction::torque);
  EXPECT_EQ(*reach_gripper("as_model"), ReachGripper::as_model);
}

/// A light arm of three joints under servos that no time step as long as this can hold.
constexpr const char* kUnstableArm =
    R"(<mujoco model="unstable"><option timestep="0.05" integrator="Euler"/>
  <default><joint range="-180 180"/><geom mass="0.01" contype="0" conaffinity="0" type="capsule"/></default>
  <worldbody><body pos="0 0 0.3"><joint name="yaw" axis="0 0 1"/><geom size="0.01" fromto="0 0 0 0 0 0.1"/>
    <body pos="0 0 0.1"><joint name="lift" axis="0 1 0"/><geom size="0.01" fromto="0 0 0 0.4 0 0"/>
      <body pos="0.4 0 0"><joint name="bend" axis="0 1 0"/><geom size="0.01" fromto="0 0 0 0.4 0 0"/>
        <site name="tool" pos="0.4 0 0"/></body></body></body></worldbody>
  <actuator><position joint="yaw" kp="50000"/><position joint="lift" kp="50000"/>
    <position joint="bend" kp="50000"/></actuator>
</mujoco>)";

TEST(ReachTasks, AWorldThatBreaksDownEndsItsEpisodeAsTerminated) {
  const support::TempFolder folder;
  const auto model = Model::load(folder.write("arm.xml", kUnstableArm));
  ASSERT_TRUE(model) << model.error().what;
  auto env = ReachEnv::create(
      *model,
      {.environments = 2, .threads = 2, .region = ReachRegion::wide, .start = {0, 0.5, 0.5}});
  ASSERT_TRUE(env) << env.error().what;
  std::vector<float> actions(6, 0.5F);
  int breakdowns = 0;
  for (int step = 0; step < 20; ++step) {
    const Eigen::Vector3d goal = env->goal(1);
    ASSERT_TRUE(env->step(actions));
    EXPECT_THAT(env->truncated(), Each(0));
    for (const float x : env->observations()) ASSERT_TRUE(std::isfinite(x));
    for (const float x : env->final_observations()) ASSERT_TRUE(std::isfinite(x));
    for (const float x : env->rewards()) ASSERT_TRUE(std::isfinite(x));
    if (env->terminated()[1] == 0) continue;
    ++breakdowns;
    EXPECT_TRUE(std::isnan(env->final_distances()[1]));
    EXPECT_LT(env->rewards()[1], -2.0F);
    EXPECT_NE(env->goal(1), goal);
  }
  EXPECT_GT(breakdowns, 1);
  EXPECT_TRUE(env->set_state(env->state()));
}

TEST(ReachTasks, OtherArmsLearnAsWell) {
  const auto file = find_model_file("ur5e");
  ASSERT_TRUE(file);
  const auto model = Model::load(*file);
  ASSERT_TRUE(model);
  EXPECT_FALSE(ReachEnv::create(*model)) << "the start is of seven joints";
  EXPECT_FALSE(ReachEnv::create(*model, guide_options()));
  auto env =
      ReachEnv::create(*model, {.environments = 2, .region = ReachRegion::wide, .start = {}});
  ASSERT_TRUE(env) << env.error().what;
  EXPECT_EQ(env->observation_size(), 30);
  for (int step = 0; step < 5; ++step) random_step(*env, step);
}

}  // namespace
}  // namespace mjarm::rl
