#include <gmock/gmock.h>

#include <cmath>

#include "mjarm/model/find_arm.hpp"
#include "mjarm/rl/reach_episodes_internal.hpp"
#include "mjarm/rl/reach_reward_internal.hpp"
#include "mjarm/rl/reach_test.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm::rl {
namespace {

using testing::task_model;

struct DrawnEpisode {
  Model model;
  Arm arm;
  ReachEpisodes episodes;
};
DrawnEpisode episodes_of(const ReachOptions& options) {
  Model model = task_model(options);
  Arm arm = find_arm(model).value();
  ReachDrive drive = ReachDrive::create(arm, options, 0.04).value();
  ReachEpisodes episodes = ReachEpisodes::create(model, arm, options, drive).value();
  return {std::move(model), std::move(arm), std::move(episodes)};
}

TEST(ReachEpisodes, GoalsAreThoseOfTheTutorial) {
  const ReachOptions options;
  DrawnEpisode drawn = episodes_of(options);
  const Eigen::Vector3d start = fk(drawn.arm, options.start).p;
  const IkSolver solver(drawn.arm, {.pos_tol = 1e-4, .task = IkTask::position});
  Eigen::Vector3d lowest = Eigen::Vector3d::Constant(9), highest = -lowest;
  for (int i = 0; i < 10000; ++i) {
    const ReachEpisode episode = drawn.episodes.draw(3, i % 7, static_cast<std::uint32_t>(i));
    const Eigen::Vector3d& goal = episode.goal;
    const double away = (goal - start).norm();
    ASSERT_TRUE(away > 0.4 && away < 0.5 && goal.x() > 0.2 && goal.z() > 0.2 && goal.z() < 0.3 &&
                std::abs(goal.y()) < 0.5 && goal.x() < 0.8)
        << goal.transpose();
    lowest = lowest.cwiseMin(goal);
    highest = highest.cwiseMax(goal);
    EXPECT_EQ(episode.q, joint_vec(options.start));
    // Reached, and by another way of asking than the one it was drawn with.
    if (i % 10 == 0) {
      EXPECT_TRUE(solver.solve({goal, Eigen::Matrix3d::Identity()}, as_span(drawn.arm.home)));
    }
  }
  // All of it is used, on both sides.
  EXPECT_LT(lowest.y(), -0.42);
  EXPECT_GT(highest.y(), 0.42);
  EXPECT_LT(lowest.x(), 0.21);
  EXPECT_GT(highest.x(), 0.7);
  EXPECT_LT(lowest.z(), 0.205);
  EXPECT_GT(highest.z(), 0.295);
}

TEST(ReachEpisodes, WideGoalsAreAllReachableAndNothingTouchesThere) {
  const ReachOptions options{.region = ReachRegion::wide};
  DrawnEpisode drawn = episodes_of(options);
  // Another solver, and a Sim with the names of what touches, as judges.
  Sim sim(drawn.model);
  std::vector<double> qpos(drawn.model.nq()), ctrl(drawn.model.nu());
  IkOptions how{.pos_tol = 1e-4, .seed = 77, .task = IkTask::position};
  how.valid = [&](std::span<const double> q) {
    std::vector<double> whole = qpos;
    std::copy(q.begin(), q.end(), whole.begin());
    sim.set_state(whole, std::vector<double>(drawn.model.nv(), 0.0));
    return sim.contacts(drawn.arm).empty();
  };
  const IkSolver solver(drawn.arm, how);
  int high = 0, near_base = 0, far = 0;
  for (int i = 0; i < 10000; ++i) {
    const ReachEpisode episode = drawn.episodes.draw(4, 0, static_cast<std::uint32_t>(i));
    const Eigen::Vector3d& goal = episode.goal;
    ASSERT_TRUE(goal.x() > 0.2 && goal.z() > 0.05 && goal.head<2>().norm() >= 0.3);
    high += goal.z() > 0.6;
    near_base += goal.head<2>().norm() < 0.4;
    far += goal.head<2>().norm() > 0.7;
    if (i % 20 != 0) continue;
    drawn.episodes.write(episode, qpos, ctrl);
    EXPECT_TRUE(solver.solve({goal, Eigen::Matrix3d::Identity()}, as_span(drawn.arm.home)));
  }
  EXPECT_GT(high, 1000);
  EXPECT_GT(near_base, 500);
  EXPECT_GT(far, 500);
}

TEST(ReachEpisodes, StartsSpreadWithinTheirBoundsAndTouchNothing) {
  const ReachOptions options{.start_spread = 0.4};
  DrawnEpisode drawn = episodes_of(options);
  const JointVec middle = joint_vec(options.start);
  Sim sim(drawn.model);
  std::vector<double> qpos(drawn.model.nq()), ctrl(drawn.model.nu());
  double widest = 0;
  for (std::uint32_t i = 0; i < 300; ++i) {
    const ReachEpisode episode = drawn.episodes.draw(5, 2, i);
    drawn.episodes.write(episode, qpos, ctrl);
    const double away = (episode.q - middle).cwiseAbs().maxCoeff();
    EXPECT_LE(away, 0.4);
    widest = std::max(widest, away);
    EXPECT_TRUE(within_limits(drawn.arm, as_span(episode.q)));
    sim.set_state(qpos, std::vector<double>(drawn.model.nv(), 0.0));
    EXPECT_TRUE(sim.contacts(drawn.arm).empty());
  }
  EXPECT_GT(widest, 0.38);
}

TEST(ReachEpisodes, TheGripperStandsAsItIsToldTo) {
  std::vector<double> qpos(9), ctrl(8);
  DrawnEpisode open = episodes_of({});
  open.episodes.write(open.episodes.draw(1, 0, 0), qpos, ctrl);
  EXPECT_NEAR(qpos[7], 0.04, 1e-4);
  EXPECT_NEAR(qpos[8], 0.04, 1e-4);
  EXPECT_EQ(ctrl[7], 255);
  DrawnEpisode closed = episodes_of({.gripper = ReachGripper::as_model});
  closed.episodes.write(closed.episodes.draw(1, 0, 0), qpos, ctrl);
  EXPECT_EQ(qpos[7], 0);
  EXPECT_EQ(ctrl[7], 0);
}

TEST(ReachReward, GrowsAsTheToolComesNearAndTakesCostsOff) {
  const ReachReward weights;
  double before = -1e9;
  for (const double d : {1.5, 0.5, 0.1, 0.05, 0.02, 0.01, 0.005, 0.001, 0.0}) {
    const double reward = reward_of(weights, {.distance = d}, false);
    EXPECT_GT(reward, before);
    before = reward;
  }
  EXPECT_NEAR(before, 1.0, 1e-12) << "the most there is";
  // A millimetre near the goal is worth more than one far away.
  const auto millimetre = [&](double d) {
    return reward_of(weights, {.distance = d}, false) -
           reward_of(weights, {.distance = d + 0.001}, false);
  };
  EXPECT_GT(millimetre(0.004), 10 * millimetre(0.4));
  EXPECT_NEAR(reward_of(weights, {.mean_square = 1}, false), 1 - 0.01, 1e-12);
  EXPECT_NEAR(reward_of(weights, {.touching = true}, false), 1 - 0.5, 1e-12);
  EXPECT_NEAR(reward_of(weights, {.near_limits = 2}, false), 1 - 0.2, 1e-12);
  EXPECT_NEAR(reward_of(weights, {.turn = 0}, true), 1.5, 1e-12);
  EXPECT_NEAR(reward_of(weights, {.turn = 0.1}, true), 1 + 0.5 * std::exp(-1) - 0.03, 1e-12);
  EXPECT_NEAR(reward_of(weights, {.turn = 0.1}, false), 1, 1e-12);
}

}  // namespace
}  // namespace mjarm::rl
