#include <algorithm>
#include <cmath>
#include <numeric>

#include "mjarm/core/messages/rl.hpp"
#include "mjarm/core/shuffle.hpp"
#include "mjarm/rl/gae.hpp"
#include "mjarm/rl/ppo_loss_internal.hpp"
#include "mjarm/rl/trainer_state_internal.hpp"

namespace mjarm::rl {
namespace {

double variance_of(std::span<const float> values, std::span<const float> minus) {
  const auto n = static_cast<double>(values.size());
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < values.size(); ++i) sum += double(values[i]) - double(minus[i]);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double rest = double(values[i]) - double(minus[i]) - sum / n;
    squares += rest * rest;
  }
  return squares / n;
}

/// 1 where `values` tell all of `returns`, 0 where no more than a constant does.
double explained_variance_of(std::span<const float> returns, std::span<const float> values) {
  const std::vector<float> zeros(returns.size());
  const double all = variance_of(returns, zeros);
  return all > 0 ? 1 - variance_of(returns, values) / all : 0;
}

double rate_at(const PpoOptions& options, std::int64_t steps) {
  if (options.schedule == Schedule::constant) return options.learning_rate;
  const double done = static_cast<double>(steps) / static_cast<double>(options.total_steps);
  return options.learning_rate * std::max(0.0, 1 - done);
}

}  // namespace

Result<void> PpoTrainer::State::collect_rollout(IterationReport& report) {
  auto collected = detail::collect(env, policy, networks, rng, open, rollout);
  // A rank that fails takes the others along: alone, they would wait for it for ever.
  double sums[] = {collected ? 0.0 : 1.0, static_cast<double>(rollout.ended), rollout.ended_returns,
                   rollout.ended_steps};
  sum_over_ranks(sums);
  if (!collected) return collected;
  if (sums[0] > 0) {
    return fail(Errc::impossible, text(msg::rl_failed_rank));
  }
  report.episodes = std::llround(sums[1]);
  if (report.episodes > 0) {
    report.mean_return = sums[2] / sums[1];
    report.mean_length = sums[3] / sums[1];
  }
  return {};
}

PpoTrainer::State::Targets PpoTrainer::State::targets() {
  const std::size_t n = rollout.samples();
  const auto size = static_cast<std::size_t>(policy.shape().observations);
  Targets out;
  out.observations.resize(rollout.observations.size());
  policy.normaliser.apply(rollout.observations, out.observations);
  out.values.resize(n + static_cast<std::size_t>(rollout.copies));
  networks.values(out.observations, out.values);
  std::vector<float> final_rows(rollout.final_observations.size());
  policy.normaliser.apply(rollout.final_observations, final_rows);
  std::vector<float> final_values(rollout.cut.size()), final_values_of_all(n);
  networks.values(final_rows, final_values);
  for (std::size_t i = 0; i < rollout.cut.size(); ++i) {
    final_values_of_all[rollout.cut[i]] = final_values[i];
  }
  const std::vector<float> last_values(out.values.begin() + static_cast<long>(n), out.values.end());
  out.values.resize(n);
  out.observations.resize(n * size);
  out.advantages.resize(n);
  out.returns.resize(n);
  estimate_advantages({rollout.copies, rollout.rewards, out.values, rollout.terminated,
                       rollout.truncated, final_values_of_all, last_values},
                      options.discount, options.gae_lambda, out.advantages, out.returns);
  out.explained_variance = explained_variance_of(out.returns, out.values);
  return out;
}

Result<void> PpoTrainer::State::update(const Targets& targets, IterationReport& report) {
  const detail::Samples samples = {targets.observations, rollout.actions, rollout.log_probs,
                                   targets.advantages,   targets.returns, targets.values};
  const std::size_t n = rollout.samples();
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  const std::size_t wanted = (n + static_cast<std::size_t>(options.minibatch) / 2) /
                             static_cast<std::size_t>(options.minibatch);
  const std::size_t batches = std::clamp<std::size_t>(wanted, 1, n / 2);
  report.learning_rate = rate_at(options, steps);
  detail::LossMeans sums;
  double done = 0;
  bool go_on = true;
  for (int epoch = 0; epoch < options.epochs && go_on; ++epoch) {
    shuffle(order, rng);
    report.epochs = epoch + 1;
    double kl = 0, done_in_epoch = 0;
    for (std::size_t i = 0; i < batches && go_on; ++i) {
      const std::size_t first = n * i / batches, last = n * (i + 1) / batches;
      detail::LossMeans losses;
      double norm = 0;
      auto stepped = step(samples, std::span(order).subspan(first, last - first),
                          report.learning_rate, losses, norm);
      if (!stepped) return fail(std::move(stepped.error()));
      go_on = *stepped;
      sums += losses;
      report.gradient_norm += norm;
      kl += losses.kl;
      done_in_epoch += 1;
    }
    report.kl = kl / done_in_epoch;
    done += done_in_epoch;
  }
  sums *= 1 / done;
  report.policy_loss = sums.policy;
  report.value_loss = sums.value;
  report.clip_fraction = sums.clip_fraction;
  report.gradient_norm /= done;
  const detail::Gaussian gaussian(policy.log_std());
  report.entropy = gaussian.entropy();
  for (int i = 0; i < policy.shape().actions; ++i) {
    report.mean_std += gaussian.deviation(static_cast<std::size_t>(i)) / policy.shape().actions;
  }
  return {};
}

Result<bool> PpoTrainer::State::step(const detail::Samples& samples, std::span<const int> which,
                                     double rate, detail::LossMeans& losses, double& norm) {
  losses = gradient.compute(policy, samples, which, options);
  double means[] = {losses.policy, losses.value, losses.kl, losses.clip_fraction};
  sum_over_ranks(means);
  if (ranks != nullptr) ranks->sum(gradient.gradient());
  const double share = 1.0 / rank_count();
  losses = {means[0] * share, means[1] * share, means[2] * share, means[3] * share};
  norm = std::sqrt(gradient.squares()) * share;
  if (!std::isfinite(norm) || !std::isfinite(losses.policy) || !std::isfinite(losses.value)) {
    return fail(Errc::impossible, text(msg::rl_diverged, losses.policy, losses.value, norm));
  }
  if (options.target_kl > 0 && losses.kl > 1.5 * options.target_kl) return false;
  const double max = options.max_gradient_norm;
  const double scale = max > 0 ? std::min(1.0, max / (norm + 1e-6)) : 1.0;
  adam.step(networks.kernels(), workers, gradient.gradient(), scale * share, rate,
            options.adam_epsilon, policy.parameters());
  networks.pack(policy);
  return true;
}

}  // namespace mjarm::rl
