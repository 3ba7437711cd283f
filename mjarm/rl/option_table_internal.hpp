#pragma once

#include <limits>
#include <utility>

#include "mjarm/rl/option_ranges_internal.hpp"
#include "mjarm/rl/ppo.hpp"
#include "mjarm/rl/reach_options.hpp"
#include "mjarm/rl/training.hpp"

namespace mjarm::rl::detail {

// The one table of options: what a configuration may say, in its order, and where each number must
// lie. `check` of the options, the reader and the writer of configurations and their tests all go
// through it. @tparam Options  const where nothing is changed.

inline constexpr OptionRange kEverySeed{.least = 0, .most = 18446744073709551615.0};
inline constexpr OptionRange kWeight{.least = 0, .most = 1e6};
inline constexpr OptionRange kScale{.least = 0, .most = 1e6, .above = true};
inline constexpr OptionRange kCount{.least = 1, .most = 1e6};
inline constexpr OptionRange kLayer{.least = 1, .most = 65536};

template <class Options, class Visit>
void visit_reach(Options& task, Visit&& visit) {
  visit("task", "environments", task.environments, OptionRange{1, 1e5});
  visit("task", "region", task.region);
  visit("task", "action", task.action);
  visit("task", "gripper", task.gripper);
  visit("task", "frame_skip", task.frame_skip, OptionRange{1, 1e4});
  visit("task", "episode_steps", task.episode_steps, kCount);
  visit("task", "start", task.start, OptionRange{-1e3, 1e3});
  visit("task", "start_spread", task.start_spread, kShare);
  visit("task", "speed", task.speed, kShareAboveZero);
  visit("task", "torque", task.torque, kShareAboveZero);
  visit("task", "orientation", task.orientation);
  visit("task", "obstacle", task.obstacle);
  visit("task", "guide", task.guide);
  auto& reward = task.reward;
  visit("reward", "distance", reward.distance, kWeight);
  visit("reward", "coarse", reward.coarse, kWeight);
  visit("reward", "coarse_scale", reward.coarse_scale, kScale);
  visit("reward", "fine", reward.fine, kWeight);
  visit("reward", "fine_scale", reward.fine_scale, kScale);
  visit("reward", "action", reward.action, kWeight);
  visit("reward", "collision", reward.collision, kWeight);
  visit("reward", "limit", reward.limit, kWeight);
  visit("reward", "limit_margin", reward.limit_margin, kScale);
  visit("reward", "turn", reward.turn, kWeight);
  visit("reward", "turn_fine", reward.turn_fine, kWeight);
  visit("reward", "turn_scale", reward.turn_scale, kScale);
}

template <class Options, class Visit>
void visit_ppo(Options& ppo, Visit&& visit) {
  visit("ppo", "seed", ppo.seed, kEverySeed);
  visit("ppo", "total_steps", ppo.total_steps, OptionRange{1, 1e15});
  visit("ppo", "rollout_steps", ppo.rollout_steps, kCount);
  visit("ppo", "minibatch", ppo.minibatch, OptionRange{2, 1e6});
  visit("ppo", "epochs", ppo.epochs, kCount);
  visit("ppo", "learning_rate", ppo.learning_rate, kAboveZero);
  visit("ppo", "schedule", ppo.schedule);
  visit("ppo", "adam_epsilon", ppo.adam_epsilon, kAboveZero);
  visit("ppo", "max_gradient_norm", ppo.max_gradient_norm, kZeroOrMore);
  visit("ppo", "discount", ppo.discount, kShare);
  visit("ppo", "gae_lambda", ppo.gae_lambda, kShare);
  visit("ppo", "clip", ppo.clip, kAboveZero);
  visit("ppo", "value_clip", ppo.value_clip, kZeroOrMore);
  visit("ppo", "value_weight", ppo.value_weight, kZeroOrMore);
  visit("ppo", "entropy_weight", ppo.entropy_weight, kZeroOrMore);
  visit("ppo", "target_kl", ppo.target_kl, kZeroOrMore);
  visit("ppo", "normalise_advantages", ppo.normalise_advantages);
  visit("ppo", "normalise_observations", ppo.normalise_observations);
  visit("ppo", "scale_rewards", ppo.scale_rewards);
  visit("ppo", "actor", ppo.actor, kLayer);
  visit("ppo", "critic", ppo.critic, kLayer);
  visit("ppo", "activation", ppo.activation);
  visit("ppo", "initial_log_std", ppo.initial_log_std, OptionRange{-20, 2});
}

/// The section `training` alone.
template <class Options, class Visit>
void visit_training(Options& options, Visit&& visit) {
  visit("training", "evaluate_every", options.evaluate_every, OptionRange{1, 1e15});
  visit("training", "evaluate_episodes", options.evaluation.episodes, OptionRange{1, 1e5});
  visit("training", "evaluate_seed", options.evaluation.seed, kEverySeed);
  visit("training", "stop_within", options.stop_within, OptionRange{0.005, 1e3});
  visit("training", "stop_share", options.stop_share, kShare);
}

/// All of a configuration.
template <class Options, class Visit>
void visit_options(Options& options, Visit&& visit) {
  visit_reach(options.task, visit);
  visit_ppo(options.ppo, visit);
  visit_training(options, visit);
}

}  // namespace mjarm::rl::detail
