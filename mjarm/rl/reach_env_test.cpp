#include "mjarm/rl/reach_env.hpp"

#include <gmock/gmock.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <limits>

#include "mjarm/core/rotation.hpp"
#include "mjarm/rl/reach_test.hpp"

namespace mjarm::rl {
namespace {

using ::testing::Each;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using testing::random_step;
using testing::reach_env;
using testing::row;
using testing::task_model;

/// Everything that steps show, one row a copy.
struct Seen {
  std::vector<std::vector<double>> rows;
  explicit Seen(int copies) : rows(copies) {}
  void take(const ReachEnv& env) {
    for (int i = 0; i < std::min(env.count(), static_cast<int>(rows.size())); ++i) {
      for (const float x : row(env.observations(), i, env.observation_size())) {
        rows[i].push_back(x);
      }
      const bool ended = env.terminated()[i] != 0 || env.truncated()[i] != 0;
      rows[i].insert(rows[i].end(), {1.0 * env.rewards()[i], 1.0 * env.terminated()[i],
                                     1.0 * env.truncated()[i], env.distances()[i]});
      if (!ended) continue;
      rows[i].push_back(env.final_distances()[i]);
      for (const float x : row(env.final_observations(), i, env.observation_size())) {
        rows[i].push_back(x);
      }
    }
  }
};

Seen random_run(ReachOptions options, int copies, int steps) {
  ReachEnv env = reach_env(options);
  EXPECT_TRUE(env.reset(11));
  Seen seen(copies);
  for (int step = 0; step < steps; ++step) {
    random_step(env, step);
    seen.take(env);
  }
  return seen;
}

TEST(ReachEnv, IsTheSameForAnyNumberOfThreadsAndCopies) {
  for (const bool obstacle : {false, true}) {
    ReachOptions options{.environments = 5,
                         .episode_steps = 7,
                         .start_spread = 0.1,
                         .orientation = obstacle,
                         .obstacle = obstacle};
    const Seen alone = random_run(options, 3, 20);
    for (const auto& [copies, threads] : {std::pair{5, 2}, {5, 4}, {3, 1}, {9, 4}}) {
      SCOPED_TRACE(copies);
      options.environments = copies;
      options.threads = threads;
      EXPECT_EQ(random_run(options, 3, 20).rows, alone.rows);
    }
  }
}

TEST(ReachEnv, EveryCopyAndSeedHasGoalsOfItsOwn) {
  ReachEnv env = reach_env({.environments = 20});
  const auto goals = [&] {
    std::vector<double> all;
    for (int i = 0; i < env.count(); ++i) all.push_back(env.goal(i).x());
    return all;
  };
  ASSERT_TRUE(env.reset(1));
  const auto first = goals();
  ASSERT_TRUE(env.reset(2));
  const auto second = goals();
  ASSERT_TRUE(env.reset(1));
  EXPECT_EQ(goals(), first);
  std::vector<double> all = first;
  all.insert(all.end(), second.begin(), second.end());
  ReachEnv unseen = reach_env({.environments = 20, .held_out = true});
  ASSERT_TRUE(unseen.reset(1));
  for (int i = 0; i < 20; ++i) all.push_back(unseen.goal(i).x());
  std::sort(all.begin(), all.end());
  EXPECT_EQ(std::adjacent_find(all.begin(), all.end()), all.end());
}

/// What MuJoCo makes of the same commands, from the state before the step.
void expect_as_mj_step(const ReachEnv& env, int copy, const Snapshot& before, int steps) {
  const mjModel* m = env.model().raw();
  mjData* d = mj_makeData(m);
  mj_setState(m, d, env.snapshot(copy).state.data(), mjSTATE_INTEGRATION);
  const std::vector<double> ctrl(d->ctrl, d->ctrl + m->nu);
  const std::vector<double> qpos(d->qpos, d->qpos + m->nq);
  mj_setState(m, d, before.state.data(), mjSTATE_INTEGRATION);
  std::copy(ctrl.begin(), ctrl.end(), d->ctrl);
  for (int k = 0; k < steps; ++k) mj_step(m, d);
  EXPECT_THAT(qpos, ElementsAreArray(d->qpos, m->nq));
  mj_forward(m, d);
  const int site = mj_name2id(m, mjOBJ_SITE, "hand_tcp");
  const Eigen::Vector3d p = env.tool(copy).p;
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(p[k], d->site_xpos[3 * site + k], 1e-12);
  // The row that the policy sees, written out once more.
  const auto seen = row(env.observations(), copy, env.observation_size());
  const Eigen::Vector3d error = env.goal(copy) - p;
  for (int k = 0; k < 7; ++k) {
    const double lower = m->jnt_range[2 * k], upper = m->jnt_range[2 * k + 1];
    EXPECT_NEAR(seen[k], 2 * (d->qpos[k] - lower) / (upper - lower) - 1, 1e-6);
    const double speed = env.options().speed * env.arm().limits.velocity[k];
    EXPECT_NEAR(seen[7 + k], d->qvel[k] / speed, 1e-5);
  }
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(seen[14 + k], p[k], 1e-6);
    EXPECT_NEAR(seen[17 + k], d->site_xmat[9 * site + 3 * k], 1e-6);
    EXPECT_NEAR(seen[20 + k], d->site_xmat[9 * site + 3 * k + 1], 1e-6);
    EXPECT_EQ(seen[23 + k], static_cast<float>(env.goal(copy)[k]));
    EXPECT_NEAR(seen[26 + k], error[k] / 0.25, 1e-6);
    EXPECT_NEAR(seen[29 + k], error[k] / (error.norm() + 0.02), 1e-6);
  }
  EXPECT_NEAR(env.distances()[copy], error.norm(), 1e-12);
  mj_deleteData(d);
}

TEST(ReachEnv, StepsAndSeesWhatMuJoCoDoes) {
  for (const ReachAction action :
       {ReachAction::joint_delta, ReachAction::joint_velocity, ReachAction::joint_position}) {
    SCOPED_TRACE(name(action));
    ReachEnv env = reach_env({.environments = 2, .threads = 2, .action = action});
    EXPECT_EQ(env.observation_size(), 32);
    for (int step = 0; step < 30; ++step) {
      const Snapshot before = env.snapshot(1);
      random_step(env, step);
      expect_as_mj_step(env, 1, before, 20);
    }
  }
}

TEST(ReachEnv, TheStepLimitTruncatesAndTheNextEpisodeBegins) {
  ReachEnv env = reach_env({.environments = 3, .episode_steps = 6});
  EXPECT_THAT(env.final_distances(), Each(::testing::IsNan()));
  const std::vector<float> first(env.observations().begin(), env.observations().end());
  for (int step = 1; step <= 18; ++step) {
    const Eigen::Vector3d goal = env.goal(2);
    random_step(env, step);
    EXPECT_THAT(env.terminated(), Each(0));
    EXPECT_THAT(env.truncated(), Each(step % 6 == 0 ? 1 : 0));
    if (step % 6 != 0) continue;
    const auto last = row(env.final_observations(), 2, env.observation_size());
    const Eigen::Vector3d p(last[14], last[15], last[16]);
    EXPECT_NEAR(env.final_distances()[2], (goal - p).norm(), 1e-6);
    EXPECT_EQ(env.final_distances()[2], env.distances()[2]);
    EXPECT_NE(env.goal(2), goal);
    const auto begun = row(env.observations(), 2, env.observation_size());
    for (int k = 0; k < 23; ++k) EXPECT_EQ(begun[k], first[2 * 32 + k]) << "the same start";
    EXPECT_EQ(env.snapshot(2).time, 0);
  }
}

TEST(ReachEnv, GoesOnFromAStateToTheLastBit) {
  const ReachOptions every[] = {
      {.environments = 4, .threads = 2, .episode_steps = 9, .start_spread = 0.05},
      {.environments = 2, .action = ReachAction::torque, .episode_steps = 9},
      {.environments = 3, .episode_steps = 9, .orientation = true, .obstacle = true}};
  for (const ReachOptions& options : every) {
    ReachEnv env = reach_env(options);
    ASSERT_TRUE(env.reset(0x123456789abcdefULL));
    for (int step = 0; step < 13; ++step) random_step(env, step);
    const std::vector<double> state = env.state();
    const std::vector<float> seen(env.observations().begin(), env.observations().end());
    Seen there(env.count()), again(env.count());
    for (int step = 13; step < 40; ++step) {
      random_step(env, step);
      there.take(env);
    }
    ReachEnv other = reach_env(options);
    ASSERT_TRUE(other.set_state(state));
    EXPECT_THAT(other.observations(), ElementsAreArray(seen));
    EXPECT_EQ(other.state(), state);
    for (int step = 13; step < 40; ++step) {
      random_step(other, step);
      again.take(other);
    }
    EXPECT_EQ(again.rows, there.rows);
  }
}

TEST(ReachEnv, RefusesAStateThatDoesNotFitAndStaysAsItIs) {
  ReachEnv env = reach_env({.environments = 2});
  random_step(env, 0);
  const std::vector<double> state = env.state();
  std::vector<double> bad = state;
  bad.pop_back();
  EXPECT_FALSE(env.set_state(bad));
  for (const std::size_t at : {0, 1, 2, 4, 5, 8, 40, 60}) {
    SCOPED_TRACE(at);
    bad = state;
    bad[at] = std::nan("");
    EXPECT_FALSE(env.set_state(bad));
  }
  for (const std::size_t at : {2, 4, 5}) {
    bad = state;
    bad[at] = -1.5;
    EXPECT_FALSE(env.set_state(bad));
  }
  EXPECT_EQ(env.state(), state);
}

TEST(ReachEnv, ZeroActionsHoldTheArmStill) {
  for (const ReachAction action : {ReachAction::joint_delta, ReachAction::joint_velocity}) {
    for (const ReachGripper gripper : {ReachGripper::open, ReachGripper::as_model}) {
      SCOPED_TRACE(name(action));
      ReachEnv env = reach_env({.environments = 2,
                                .action = action,
                                .gripper = gripper,
                                .episode_steps = 100,
                                .start_spread = 0.3});
      const Pose before = env.tool(1);
      const std::vector<float> zeros(14, 0.0F);
      for (int step = 0; step < 99; ++step) ASSERT_TRUE(env.step(zeros));
      EXPECT_LT((env.tool(1).p - before.p).norm(), 0.0005);
      EXPECT_LT(angle_between(env.tool(1).R, before.R), 0.001);
    }
  }
}

TEST(ReachEnv, AnActionMovesTheJointByItsShareOfTheGreatestStep) {
  ReachEnv env = reach_env({.environments = 1});
  const auto q = [&](int joint) {
    return env.snapshot(0).state[1 + joint];  // time, then qpos
  };
  for (int joint = 0; joint < 7; ++joint) {
    ASSERT_TRUE(env.reset(0));
    const double before = q(joint);
    std::vector<float> actions(7, 0.0F);
    for (int step = 0; step < 8; ++step) {
      actions[joint] = step < 5 ? 0.5F : 0.0F;
      ASSERT_TRUE(env.step(actions));
    }
    const double wanted = 5 * 0.5 * 0.5 * env.arm().limits.velocity[joint] * 0.04;
    EXPECT_NEAR(q(joint) - before, wanted, 0.02 * wanted) << joint;
  }
}

TEST(ReachEnv, ReferencesStayWithinTheLimits) {
  for (const ReachAction action : {ReachAction::joint_delta, ReachAction::joint_position}) {
    ReachEnv env = reach_env({.environments = 2, .action = action, .episode_steps = 400});
    std::vector<float> actions(14, 1.0F);
    std::fill_n(actions.begin(), 7, -1.0F);
    for (int step = 0; step < 150; ++step) {
      ASSERT_TRUE(env.step(actions));
      for (int i = 0; i < 2; ++i) {
        for (const float q : row(env.observations(), i, 32).first(7)) EXPECT_LT(std::abs(q), 1.03F);
        EXPECT_TRUE(std::isfinite(env.rewards()[i]));
        EXPECT_LT(env.rewards()[i], 1.0F);
        EXPECT_GT(env.rewards()[i], -5.0F);
      }
    }
    EXPECT_EQ(env.touching()[0], 1) << "folded as far as it goes, the arm touches itself";
  }
}

TEST(ReachEnv, TorqueActionsMoveTheArmAndNoneLetsItFloat) {
  ReachEnv env = reach_env({.environments = 2, .action = ReachAction::torque});
  std::vector<float> actions(14, 0.0F);
  actions[7] = 0.5F;
  const Pose still = env.tool(0), moved = env.tool(1);
  for (int step = 0; step < 20; ++step) ASSERT_TRUE(env.step(actions));
  EXPECT_LT((env.tool(0).p - still.p).norm(), 0.001);
  EXPECT_GT((env.tool(1).p - moved.p).norm(), 0.05);
}

TEST(ReachEnv, RefusesActionsThatAreNoNumbers) {
  ReachEnv env = reach_env({.environments = 2});
  const std::vector<double> state = env.state();
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    std::vector<float> actions(14, 0.0F);
    actions[9] = bad;
    const auto stepped = env.step(actions);
    ASSERT_FALSE(stepped);
    EXPECT_EQ(stepped.error().code, Errc::bad_input);
    EXPECT_THAT(stepped.error().what, HasSubstr("action 2 of copy 1"));
  }
  EXPECT_FALSE(env.step(std::vector<float>(13)));
  EXPECT_EQ(env.state(), state);
}

}  // namespace
}  // namespace mjarm::rl
