#include "mjarm/session/policy_player.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "mjarm/core/rng.hpp"

namespace mjarm::session {
namespace {

using ::testing::HasSubstr;

constexpr int kActions = 5;

rl::Policy random_policy(int observations, int actions) {
  rl::Policy policy({observations, actions, {8}, {8}, rl::Activation::tanh});
  Rng rng(3);
  for (float& parameter : policy.parameters()) parameter = static_cast<float>(rng.uniform(-1, 1));
  return policy;
}

rl::ReachEnv lone_env(const Model& model) {
  // What the player shows: goals never trained on, and the last state of an episode.
  return rl::ReachEnv::create(model,
                              {.environments = 1, .episode_steps = kActions + 1, .held_out = true})
      .value();
}

/// The environment itself is the judge.
TEST(PolicyPlayer, GoesTheWayOfTheEnvironmentToTheLastBit) {
  const Model model = rl::reach_model().value();
  rl::ReachEnv env = lone_env(model);
  Sim there(model);
  const rl::Policy policy = random_policy(env.observation_size(), env.action_size());
  Result<PolicyPlayer> player = PolicyPlayer::create(model, {.episode_steps = kActions}, policy, 9);
  ASSERT_TRUE(player) << player.error().what;
  EXPECT_FALSE(player->step().value()) << "no episode was begun";
  for (const std::uint64_t seed : {9, 10}) {
    ASSERT_TRUE(env.reset(seed));
    ASSERT_TRUE(player->begin_episode());
    EXPECT_EQ(player->goal(), env.goal(0));
    EXPECT_EQ(player->sim().snapshot().state, env.snapshot(0).state);
    for (int i = 0; i < kActions; ++i) {
      const Eigen::VectorXf action = policy.act(env.observations());
      ASSERT_TRUE(env.step({action.data(), static_cast<std::size_t>(action.size())}));
      for (int k = 0; k < env.options().frame_skip; ++k) ASSERT_TRUE(player->step().value());
      ASSERT_TRUE(there.restore(env.snapshot(0)));
      ASSERT_TRUE(std::ranges::equal(player->sim().qpos(), there.qpos())) << i;
      ASSERT_TRUE(std::ranges::equal(player->sim().qvel(), there.qvel())) << i;
      EXPECT_LT((player->tool().p - env.tool(0).p).norm(), 1e-12);
      EXPECT_EQ(player->point(), env.tool(0).p);
    }
    EXPECT_FALSE(player->step().value()) << "the episode is over";
  }
}

TEST(PolicyPlayer, RefusesWhatDoesNotFit) {
  const Model model = rl::reach_model().value();
  const rl::ReachEnv env = lone_env(model);
  const auto other =
      PolicyPlayer::create(model, {}, random_policy(env.observation_size() + 1, 7), 1);
  ASSERT_FALSE(other);
  EXPECT_THAT(other.error().what, HasSubstr(std::to_string(env.observation_size() + 1)));
  rl::ReachOptions wrong;
  wrong.frame_skip = 0;
  EXPECT_FALSE(PolicyPlayer::create(model, wrong, random_policy(env.observation_size(), 7), 1));
}

}  // namespace
}  // namespace mjarm::session
