#include "mjarm/rl/cloner.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "mjarm/core/shuffle.hpp"
#include "mjarm/rl/adam_internal.hpp"
#include "mjarm/rl/first_weights_internal.hpp"
#include "mjarm/rl/gradient_sums_internal.hpp"
#include "mjarm/rl/mixture_loss_internal.hpp"
#include "mjarm/rl/networks_internal.hpp"

namespace mjarm::rl {
namespace {

using detail::Mlp;

/// Sequences of random numbers of one seed.
enum RngUse : std::uint64_t { first_weights = 1, order = 2, blur = 16 };

constexpr double kAdamEpsilon = 1e-8;
constexpr std::size_t kCloningPortion = std::size_t{1} << 16;  // parameters a task

Policy first_policy(const Demonstrations& data, const CloningOptions& options) {
  Policy policy({.observations = data.observations,
                 .actions = MixturePolicy::outputs(data.actions, options.modes),
                 .actor = options.hidden,
                 .critic = {},
                 .activation = Activation::relu});
  Rng rng(options.seed, RngUse::first_weights);
  detail::draw_first_weights(policy, 0, rng);
  // Modes that begin as one would learn as one: their centres begin apart.
  const ParameterBlock& bias = policy.blocks()[2 * options.hidden.size() + 1];
  for (int i = 0; i < options.modes * data.actions; ++i) {
    policy.parameters()[bias.offset + static_cast<std::size_t>(i)] =
        static_cast<float>(0.5 * rng.normal());
  }
  return policy;
}

void learn_scale(const Demonstrations& data, Normaliser& normaliser) {
  constexpr std::size_t kAtOnce = 65536;
  const auto width = static_cast<std::size_t>(data.observations);
  std::vector<float> rows, action(static_cast<std::size_t>(data.actions));
  for (std::size_t first = 0; first < data.rows; first += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, data.rows - first);
    rows.resize(count * width);
    for (std::size_t i = 0; i < count; ++i) {
      data.show(first + i, nullptr, std::span(rows).subspan(i * width, width), action);
    }
    normaliser.absorb(rows);
  }
}

}  // namespace

struct Cloner::State {
  State(const Demonstrations& demonstrations, const CloningOptions& all_options)
      : data(demonstrations),
        options(all_options),
        policy(first_policy(data, options), options.modes),
        adam(policy.net.parameters().size()),
        rng(options.seed, RngUse::order),
        workers(options.threads),
        networks(detail::net_kernels(simd_level()), policy.net, workers),
        sums(policy.net.parameters().size(), kCloningPortion, networks),
        rows(data.rows) {
    learn_scale(data, policy.net.normaliser);
    std::iota(rows.begin(), rows.end(), std::size_t{0});
  }

  /// Of some rows, at most Mlp::kRows, to `slice`.
  double slice_loss(std::size_t first, std::size_t count, double weight, int thread, float* slice);
  /// @return the sum of their losses; not finite, and nothing learned, where that diverges.
  double step(std::size_t first, std::size_t count, double rate);

  const Demonstrations& data;
  CloningOptions options;
  MixturePolicy policy;
  detail::Adam adam;
  Rng rng;
  detail::Workers workers;
  detail::Networks networks;
  detail::GradientSums sums;
  std::vector<std::size_t> rows;  ///< in the order of this pass
  std::uint64_t shown = 0;        ///< rows so far: each is blurred by numbers of its own
  int epochs = 0;
};

double Cloner::State::slice_loss(std::size_t first, std::size_t count, double weight, int thread,
                                 float* slice) {
  const auto n = static_cast<int>(count);
  Mlp::Scratch& scratch = networks.actor_scratch(thread);
  std::vector<float> actions(count * static_cast<std::size_t>(data.actions));
  std::vector<float> observation(static_cast<std::size_t>(data.observations));
  const auto action_of = [&](std::size_t i) {
    const auto width = static_cast<std::size_t>(data.actions);
    return std::span(actions).subspan(i * width, width);
  };
  for (std::size_t i = 0; i < count; ++i) {
    Rng own(options.seed, RngUse::blur + shown + first + i);
    data.show(rows[first + i], &own, observation, action_of(i));
    policy.net.normaliser.apply(observation, observation);
    scratch.values.front().set_row(static_cast<int>(i), observation.data());
  }
  networks.actor().forward(n, scratch);
  detail::MixtureLoss loss(data.actions, options.modes);
  const auto outputs = static_cast<std::size_t>(policy.net.shape().actions);
  std::vector<float> out(outputs);
  std::vector<double> by_out(outputs), by_log_std(outputs);
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < outputs; ++k) out[k] = scratch.values.back().at(i, int(k));
    sum +=
        loss(out, policy.net.log_std(), action_of(static_cast<std::size_t>(i)), by_out, by_log_std);
    for (std::size_t k = 0; k < outputs; ++k) {
      scratch.gradients.back().at(i, int(k)) = static_cast<float>(weight * by_out[k]);
    }
  }
  networks.actor().backward(n, scratch, false, slice);
  float* last = slice + sums.size() - outputs;  // log_std stands last of all parameters
  for (std::size_t k = 0; k < outputs; ++k) last[k] = static_cast<float>(weight * by_log_std[k]);
  return sum;
}

double Cloner::State::step(std::size_t first, std::size_t count, double rate) {
  const std::size_t pieces = (count + Mlp::kRows - 1) / Mlp::kRows;
  sums.reserve(static_cast<int>(pieces));
  std::vector<double> losses(pieces);
  networks.pack(policy.net);
  workers.run(static_cast<int>(pieces), [&](int piece, int thread) {
    const auto i = static_cast<std::size_t>(piece);
    const std::size_t begin = first + i * Mlp::kRows;
    const std::size_t size = std::min<std::size_t>(Mlp::kRows, first + count - begin);
    losses[i] = slice_loss(begin, size, 1 / static_cast<double>(count), thread, sums.slice(piece));
  });
  sums.add(static_cast<int>(pieces));
  const double norm = std::sqrt(sums.squares());
  if (!std::isfinite(norm)) return norm;
  adam.step(networks.kernels(), workers, sums.gradient(),
            std::min(1.0, options.max_norm / std::max(norm, options.max_norm)), rate, kAdamEpsilon,
            policy.net.parameters());
  const auto least = static_cast<float>(std::log(options.least_std));
  const std::size_t outputs = policy.net.log_std().size();
  for (float& value : policy.net.parameters().last(outputs)) value = std::max(value, least);
  return std::accumulate(losses.begin(), losses.end(), 0.0);
}

Cloner::Cloner(const Demonstrations& demonstrations, const CloningOptions& options)
    : state_(std::make_unique<State>(demonstrations, options)) {}
Cloner::~Cloner() = default;
Cloner::Cloner(Cloner&&) noexcept = default;
Cloner& Cloner::operator=(Cloner&&) noexcept = default;

double Cloner::epoch() {
  State& state = *state_;
  const std::size_t n = state.rows.size();
  shuffle(state.rows, state.rng);
  const auto batch = static_cast<std::size_t>(state.options.batch);
  double sum = 0;
  for (std::size_t first = 0; first < n; first += batch) {
    const double done =
        (state.epochs + double(first) / double(n)) / static_cast<double>(state.options.epochs);
    const double rate =
        state.options.learning_rate * 0.5 * (1 + std::cos(std::numbers::pi * std::min(done, 1.0)));
    sum += state.step(first, std::min(batch, n - first), rate);
  }
  state.shown += n;
  state.epochs += 1;
  return sum / static_cast<double>(n);
}

int Cloner::epochs() const noexcept { return state_->epochs; }
const MixturePolicy& Cloner::policy() const noexcept { return state_->policy; }

}  // namespace mjarm::rl
