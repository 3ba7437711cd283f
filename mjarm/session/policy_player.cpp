#include "mjarm/session/policy_player.hpp"

#include <utility>

#include "mjarm/rl/evaluate.hpp"

namespace mjarm::session {

Result<PolicyPlayer> PolicyPlayer::create(const Model& model, rl::ReachOptions options,
                                          rl::Policy policy, std::uint64_t seed) {
  const int actions = options.episode_steps;
  options.environments = options.threads = 1;
  options.held_out = true;
  options.episode_steps = actions + 1;  // the last state of an episode is to be seen
  Result<rl::ReachEnv> env = rl::ReachEnv::create(model, options);
  if (!env) return fail(std::move(env.error()));
  if (auto fits = rl::check_sizes(policy, *env); !fits) return fail(std::move(fits.error()));
  return PolicyPlayer(model, std::move(*env), std::move(policy), actions, seed);
}

Result<void> PolicyPlayer::begin_episode() {
  actions_ = steps_left_ = 0;
  ended_ = false;
  return env_.reset(seed_++).and_then([&] { return sim_.restore(env_.snapshot(0)); });
}

Result<void> PolicyPlayer::take_action() {
  const Eigen::VectorXf action = policy_.act(env_.observations());
  const Snapshot before = env_.snapshot(0);
  if (auto stepped = env_.step({action.data(), static_cast<std::size_t>(action.size())}); !stepped)
    return stepped;
  ++actions_;
  if (env_.terminated()[0] != 0) {
    ended_ = true;
    return {};
  }
  // What was commanded is part of the state after it.
  if (auto there = sim_.restore(env_.snapshot(0)); !there) return there;
  ctrl_.assign(sim_.ctrl().begin(), sim_.ctrl().end());
  steps_left_ = env_.options().frame_skip;
  return sim_.restore(before);
}

Result<bool> PolicyPlayer::step() {
  if (steps_left_ == 0) {
    if (ended_ || actions_ >= max_actions_) return false;
    if (auto taken = take_action(); !taken) return fail(std::move(taken.error()));
    if (ended_) return false;
  }
  --steps_left_;
  if (auto stepped = sim_.step(ctrl_); !stepped) return fail(std::move(stepped.error()));
  return true;
}

}  // namespace mjarm::session
