#include <algorithm>
#include <cmath>
#include <utility>

#include "mjarm/core/messages/rl.hpp"
#include "mjarm/rl/ppo_loss_internal.hpp"
#include "mjarm/rl/rollout_internal.hpp"

namespace mjarm::rl::detail {
namespace {

/// An error where one of the observations, rows of `size` numbers, is not finite.
Result<void> check_observations(std::span<const float> rows, int size, int step) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (std::isfinite(rows[i])) continue;
    const auto width = static_cast<std::size_t>(size);
    return fail(Errc::impossible,
                text(msg::rl_bad_observation, i % width, i / width, step, double(rows[i])));
  }
  return {};
}

Result<void> check_rewards(std::span<const float> rewards, int step) {
  for (std::size_t i = 0; i < rewards.size(); ++i) {
    if (std::isfinite(rewards[i])) continue;
    return fail(Errc::impossible, text(msg::rl_bad_reward, i, step, double(rewards[i])));
  }
  return {};
}

/// Draws the actions of all copies in one step, and their probabilities.
void draw_actions(const Gaussian& gaussian, std::span<const float> means, Rng& rng,
                  std::span<float> actions, std::span<float> log_probs) {
  const std::size_t size = actions.size() / log_probs.size();
  for (std::size_t i = 0; i < actions.size(); ++i) {
    actions[i] = static_cast<float>(means[i] + gaussian.deviation(i % size) * rng.normal());
  }
  for (std::size_t i = 0; i < log_probs.size(); ++i) {
    log_probs[i] =
        static_cast<float>(gaussian.log_prob(&actions[i * size], means.data() + i * size));
  }
}

/// Takes over what the environment says of step `t`.
Result<void> take_step(const VecEnv& env, int t, OpenEpisodes& open, Rollout& out) {
  const auto copies = static_cast<std::size_t>(out.copies);
  const auto size = static_cast<std::size_t>(env.observation_size());
  const std::size_t first = static_cast<std::size_t>(t) * copies;
  if (auto fine = check_rewards(env.rewards(), t); !fine) return fine;
  std::ranges::copy(env.rewards(), out.rewards.begin() + static_cast<long>(first));
  std::ranges::copy(env.terminated(), out.terminated.begin() + static_cast<long>(first));
  std::ranges::copy(env.truncated(), out.truncated.begin() + static_cast<long>(first));
  for (std::size_t copy = 0; copy < copies; ++copy) {
    open.returns[copy] += env.rewards()[copy];
    open.lengths[copy] += 1;
    const bool terminated = env.terminated()[copy] != 0, truncated = env.truncated()[copy] != 0;
    if (!terminated && !truncated) continue;
    out.ended += 1;
    out.ended_returns += std::exchange(open.returns[copy], 0);
    out.ended_steps += static_cast<double>(std::exchange(open.lengths[copy], 0));
    if (terminated) continue;
    const auto last = env.final_observations().subspan(copy * size, size);
    if (auto fine = check_observations(last, env.observation_size(), t); !fine) return fine;
    out.cut.push_back(first + copy);
    out.final_observations.insert(out.final_observations.end(), last.begin(), last.end());
  }
  return {};
}

}  // namespace

Rollout::Rollout(int step_count, int copy_count, const PolicyShape& shape)
    : steps(step_count), copies(copy_count) {
  const std::size_t count = static_cast<std::size_t>(steps) * static_cast<std::size_t>(copies);
  observations.resize((count + static_cast<std::size_t>(copies)) *
                      static_cast<std::size_t>(shape.observations));
  actions.resize(count * static_cast<std::size_t>(shape.actions));
  log_probs.resize(count);
  rewards.resize(count);
  terminated.resize(count);
  truncated.resize(count);
}

Result<void> collect(VecEnv& env, const Policy& policy, Networks& networks, Rng& rng,
                     OpenEpisodes& open, Rollout& out) {
  const auto copies = static_cast<std::size_t>(out.copies);
  const std::size_t in_row = copies * static_cast<std::size_t>(env.observation_size());
  const std::size_t out_row = copies * static_cast<std::size_t>(env.action_size());
  const Gaussian gaussian(policy.log_std());
  std::vector<float> normalised(in_row), means(out_row);
  out.cut.clear();
  out.final_observations.clear();
  out.ended = 0;
  out.ended_returns = out.ended_steps = 0;
  for (int t = 0;; ++t) {
    const auto step = static_cast<std::size_t>(t);
    if (auto fine = check_observations(env.observations(), env.observation_size(), t); !fine) {
      return fine;
    }
    std::ranges::copy(env.observations(),
                      out.observations.begin() + static_cast<long>(step * in_row));
    if (t == out.steps) return {};
    policy.normaliser.apply(env.observations(), normalised);
    networks.means(normalised, means);
    const std::span<float> actions(&out.actions[step * out_row], out_row);
    draw_actions(gaussian, means, rng, actions, {&out.log_probs[step * copies], copies});
    if (auto stepped = env.step(actions); !stepped) return stepped;
    if (auto taken = take_step(env, t, open, out); !taken) return taken;
  }
}

void update_log_probs(const Policy& policy, Networks& networks, Rollout& rollout) {
  const auto observations = static_cast<std::size_t>(policy.shape().observations);
  const auto actions = static_cast<std::size_t>(policy.shape().actions);
  std::vector<float> normalised(rollout.samples() * observations);
  policy.normaliser.apply(std::span(rollout.observations).first(normalised.size()), normalised);
  std::vector<float> means(rollout.actions.size());
  networks.means(normalised, means);
  const Gaussian gaussian(policy.log_std());
  for (std::size_t i = 0; i < rollout.samples(); ++i) {
    rollout.log_probs[i] =
        static_cast<float>(gaussian.log_prob(&rollout.actions[i * actions], &means[i * actions]));
  }
}

void scale_rewards(double discount, Normaliser& scale, OpenEpisodes& open, Rollout& rollout,
                   Ranks* ranks) {
  std::vector<float> returns(rollout.samples());
  for (std::size_t i = 0; i < returns.size(); ++i) {
    double& discounted = open.discounted[i % open.discounted.size()];
    discounted = discounted * discount + static_cast<double>(rollout.rewards[i]);
    returns[i] = static_cast<float>(discounted);
    if (rollout.terminated[i] != 0 || rollout.truncated[i] != 0) discounted = 0;
  }
  scale.absorb(returns, ranks);
  const double factor = 1 / std::sqrt(scale.variance[0] + 1e-8);
  for (float& reward : rollout.rewards) reward = static_cast<float>(reward * factor);
}

}  // namespace mjarm::rl::detail
