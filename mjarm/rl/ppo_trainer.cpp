#include "mjarm/rl/ppo_trainer.hpp"

#include "mjarm/core/messages/rl.hpp"
#include "mjarm/core/stopwatch.hpp"
#include "mjarm/rl/first_weights_internal.hpp"
#include "mjarm/rl/trainer_state_internal.hpp"

namespace mjarm::rl {
namespace {

/// Sequences of random numbers of one seed; each rank has its own from `of_ranks` on.
enum RngStream : std::uint64_t { weights = 1, of_ranks = 16 };

Rng rng_of_rank(const PpoOptions& options, const Ranks* ranks, std::uint64_t use) {
  const int rank = ranks == nullptr ? 0 : ranks->rank();
  return Rng(options.seed, RngStream::of_ranks + 2 * static_cast<std::uint64_t>(rank) + use);
}

Normaliser scale_of_one_number() {
  return {Eigen::VectorXd::Zero(1), Eigen::VectorXd::Ones(1), 0, 10};
}

tl::unexpected<Error> failed_iteration(std::int64_t iteration, const Error& error) {
  return fail(error.code, text(msg::rl_iteration, iteration, error.what));
}

/// Weights of layers one after another.
double count_weights(int inputs, const std::vector<int>& hidden, int outputs) {
  double count = 0, from = inputs;
  for (const int size : hidden) {
    count += (from + 1) * size;
    from = size;
  }
  return count + (from + 1) * outputs;
}

/// A rollout, and weights with gradient and moments, stay well below 2 GB.
Result<void> check_memory(const VecEnv& env, const PpoOptions& options) {
  constexpr std::int64_t kMaxSamples = std::int64_t{1} << 22;
  constexpr double kMaxWeights = 1 << 24;
  const std::int64_t samples = std::int64_t{env.count()} * options.rollout_steps;
  if (samples > kMaxSamples) {
    return fail(Errc::bad_input, text(msg::rl_many_samples, samples, kMaxSamples));
  }
  const double weights = count_weights(env.observation_size(), options.actor, env.action_size()) +
                         count_weights(env.observation_size(), options.critic, 1);
  if (weights > kMaxWeights) {
    return fail(Errc::bad_input, text(msg::rl_many_weights, weights, kMaxWeights));
  }
  return {};
}

}  // namespace

PpoTrainer::State::State(VecEnv& environment, const PpoOptions& all_options, Ranks* all_ranks,
                         Policy first_policy)
    : env(environment),
      policy(std::move(first_policy)),
      adam(policy.parameters().size()),
      rng(rng_of_rank(all_options, all_ranks, 0)),
      reward_scale(scale_of_one_number()),
      open(environment.count()),
      options(all_options),
      ranks(all_ranks),
      workers(all_options.threads),
      networks(detail::net_kernels(simd_level()), policy, workers),
      gradient(policy.shape(), policy.parameters().size(), networks),
      rollout(all_options.rollout_steps, environment.count(), policy.shape()) {}

void PpoTrainer::State::sum_over_ranks(std::span<double> values) const {
  if (ranks != nullptr) ranks->sum(values);
}

PpoTrainer::PpoTrainer(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
PpoTrainer::~PpoTrainer() = default;
PpoTrainer::PpoTrainer(PpoTrainer&& other) noexcept = default;
PpoTrainer& PpoTrainer::operator=(PpoTrainer&& other) noexcept = default;

Result<PpoTrainer> PpoTrainer::create(VecEnv& env, const PpoOptions& options, Ranks* ranks) {
  if (auto fine = check(options); !fine) return fail(std::move(fine.error()));
  if (env.count() < 1 || env.observation_size() < 1 || env.action_size() < 1) {
    return fail(Errc::bad_input,
                text(msg::rl_env_sizes, env.count(), env.observation_size(), env.action_size()));
  }
  if (options.rollout_steps == 1 && env.count() == 1) {
    return fail(Errc::bad_input, text(msg::rl_few_samples, 1));
  }
  if (auto fits = check_memory(env, options); !fits) return fail(std::move(fits.error()));
  const std::uint64_t env_seed = rng_of_rank(options, ranks, 1).next();
  if (auto started = env.reset(env_seed); !started) return fail(std::move(started.error()));
  Policy policy({env.observation_size(), env.action_size(), options.actor, options.critic,
                 options.activation});
  Rng rng(options.seed, RngStream::weights);
  detail::draw_first_weights(policy, options.initial_log_std, rng);
  return PpoTrainer(std::make_unique<State>(env, options, ranks, std::move(policy)));
}

Result<IterationReport> PpoTrainer::iterate() {
  State& state = *state_;
  IterationReport report;
  report.iteration = state.iterations + 1;
  const Policy before = state.policy;
  const auto give_up = [&](const Error& error) {
    state.policy = before;
    state.networks.pack(state.policy);
    return failed_iteration(report.iteration, error);
  };
  const Stopwatch collecting;
  if (auto collected = state.collect_rollout(report); !collected) {
    return give_up(collected.error());
  }
  report.collect_us = collecting.us();
  const Stopwatch updating;
  const bool first_look =
      state.options.normalise_observations && state.policy.normaliser.count == 0;
  const std::span<const float> seen(
      state.rollout.observations.data(),
      state.rollout.samples() * static_cast<std::size_t>(state.policy.shape().observations));
  if (first_look) {  // before the first update, so that no weights are learnt for raw observations
    state.policy.normaliser.absorb(seen, state.ranks);
    detail::update_log_probs(state.policy, state.networks, state.rollout);
  }
  if (state.options.scale_rewards) {
    detail::scale_rewards(state.options.discount, state.reward_scale, state.open, state.rollout,
                          state.ranks);
  }
  const State::Targets targets = state.targets();
  report.explained_variance = targets.explained_variance;
  if (auto updated = state.update(targets, report); !updated) return give_up(updated.error());
  if (state.options.normalise_observations && !first_look) {
    state.policy.normaliser.absorb(seen, state.ranks);
  }
  state.iterations = report.iteration;
  state.steps += static_cast<std::int64_t>(state.rollout.samples()) * state.rank_count();
  report.steps = state.steps;
  report.update_us = updating.us();
  return report;
}

const Policy& PpoTrainer::policy() const noexcept { return state_->policy; }
const PpoOptions& PpoTrainer::options() const noexcept { return state_->options; }
std::int64_t PpoTrainer::steps() const noexcept { return state_->steps; }
std::int64_t PpoTrainer::iterations() const noexcept { return state_->iterations; }

}  // namespace mjarm::rl
