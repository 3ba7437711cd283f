#include <gmock/gmock.h>
#include <mujoco/mujoco.h>

#include "mjarm/control/sag.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/rl/reach_test.hpp"

namespace mjarm::rl {
namespace {

using testing::reach_env;
using testing::row;

TEST(ReachGuide, IsTheTutorialsEnvironment) {
  ReachOptions options = guide_options();
  options.environments = 2;
  ReachEnv env = reach_env(options);
  ASSERT_EQ(env.observation_size(), 10);
  ASSERT_EQ(env.action_size(), 7);
  const mjModel* m = env.model().raw();
  mjData* d = mj_makeData(m);
  const double home[] = {0, -0.785398, 0, -2.356194, 0, 1.570796, 0.785398};
  mj_resetData(m, d);
  std::copy_n(home, 7, d->qpos);
  mj_forward(m, d);
  const int hand = mj_name2id(m, mjOBJ_BODY, "hand");
  // 0.105 m out of the hand, as the tutorial's model places its `ee_center_body`.
  const auto point = [&](int axis) {
    return d->xpos[3 * hand + axis] + 0.105 * d->xmat[9 * hand + 3 * axis + 2];
  };
  const Eigen::Vector3d goal = env.goal(1), start(point(0), point(1), point(2));
  EXPECT_GT((goal - start).norm(), 0.4);
  EXPECT_LT((goal - start).norm(), 0.5);

  Rng rng(1);
  std::vector<float> actions(14);
  for (int step = 0; step < 200; ++step) {
    const auto seen = row(env.observations(), 1, 10);
    for (int k = 0; k < 7; ++k) EXPECT_EQ(seen[k], static_cast<float>(d->qpos[k]));
    for (int k = 0; k < 3; ++k) EXPECT_EQ(seen[7 + k], static_cast<float>(goal[k]));
    for (float& a : actions) a = static_cast<float>(rng.uniform(-0.3, 0.3));
    ASSERT_TRUE(env.step(actions));
    for (int k = 0; k < 7; ++k) {
      const double lower = m->jnt_range[2 * k], upper = m->jnt_range[2 * k + 1];
      d->ctrl[k] = static_cast<float>(lower + (actions[7 + k] + 1) * 0.5 * (upper - lower));
    }
    mj_step(m, d);
    // Where mj_step leaves xpos: at the positions before the step.
    const double distance = (goal - Eigen::Vector3d(point(0), point(1), point(2))).norm();
    EXPECT_NEAR(env.distances()[1], distance, 1e-9);
    ASSERT_EQ(env.terminated()[1], 0);
  }
  mj_deleteData(d);
}

TEST(ReachGuide, SuccessEndsAnEpisodeAndTheStepLimitCutsIt) {
  ReachOptions options = guide_options();
  options.environments = 6;
  ReachEnv env = reach_env(options);
  // Targets from inverse kinematics, and what the servos sag there under gravity.
  const IkSolver solver(env.arm(), {.pos_tol = 1e-5, .task = IkTask::position});
  std::vector<JointVec> targets;
  const JointVec start = joint_vec(options.start);
  for (int i = 0; i < env.count(); ++i) {
    const auto found = solver.solve({env.goal(i), Eigen::Matrix3d::Identity()}, as_span(start));
    ASSERT_TRUE(found);
    std::vector<double> qpos(env.model().nq(), 0.0);
    std::copy(found->q.begin(), found->q.end(), qpos.begin());
    targets.push_back(found->q + static_sag(env.model(), env.arm(), qpos));
  }
  std::vector<float> actions(6 * 7);
  std::vector<int> terminated(6), truncated(6);
  for (int step = 1; step <= 2000; ++step) {
    for (int i = 0; i < 6; ++i) {
      for (int k = 0; k < 7; ++k) {
        const double lower = env.arm().limits.lower[k], upper = env.arm().limits.upper[k];
        // The last copy stays where it begins and runs into the limit.
        const double q = i == 5 ? start[k] : targets[i][k];
        actions[7 * i + k] = static_cast<float>(2 * (q - lower) / (upper - lower) - 1);
      }
    }
    ASSERT_TRUE(env.step(actions));
    for (int i = 0; i < 6; ++i) {
      if (terminated[i] != 0) continue;
      if (env.terminated()[i] != 0) {
        terminated[i] = step;
        EXPECT_LT(env.final_distances()[i], 0.005);
        EXPECT_EQ(env.truncated()[i], 0);
      }
      if (env.truncated()[i] != 0) truncated[i] = step;
    }
  }
  EXPECT_EQ(truncated[5], 2000);
  EXPECT_EQ(terminated[5], 0);
  for (int i = 0; i < 5; ++i) EXPECT_GT(terminated[i], 0) << i;
}

}  // namespace
}  // namespace mjarm::rl
