#include <algorithm>
#include <cmath>

#include "mjarm/rl/ppo_gradient_internal.hpp"
#include "mjarm/rl/ppo_loss_internal.hpp"

namespace mjarm::rl::detail {
namespace {

constexpr int kMaxSlices = 8;
constexpr std::size_t kPortion = 16384;  ///< parameters a task

int slices_of(std::size_t rows) {
  const auto blocks = (static_cast<int>(rows) + Mlp::kRows - 1) / Mlp::kRows;
  return std::min(kMaxSlices, blocks);
}

/// Shift and factor that bring the advantages of a minibatch to mean 0 and deviation 1.
struct AdvantageScale {
  double mean = 0, factor = 1;

  AdvantageScale(std::span<const float> advantages, std::span<const int> which, bool wanted) {
    if (!wanted || which.size() < 2) return;
    const auto n = static_cast<double>(which.size());
    double sum = 0, squares = 0;
    for (const int i : which) sum += advantages[i];
    mean = sum / n;
    for (const int i : which) squares += (advantages[i] - mean) * (advantages[i] - mean);
    factor = 1 / (std::sqrt(squares / (n - 1)) + 1e-8);
  }
};

/// Copies the rows `which` of the observations into the input of a net.
void gather(const Samples& samples, std::span<const int> which, Panels& to) {
  for (std::size_t i = 0; i < which.size(); ++i) {
    const float* row = samples.observations.data() + static_cast<long>(which[i]) * to.cols();
    to.set_row(static_cast<int>(i), row);
  }
}

}  // namespace

LossMeans& LossMeans::operator+=(const LossMeans& other) noexcept {
  policy += other.policy;
  value += other.value;
  kl += other.kl;
  clip_fraction += other.clip_fraction;
  return *this;
}

LossMeans& LossMeans::operator*=(double factor) noexcept {
  policy *= factor;
  value *= factor;
  kl *= factor;
  clip_fraction *= factor;
  return *this;
}

struct PpoGradient::Batch {
  const Samples& samples;
  std::span<const int> which;
  const PpoOptions& options;
  Gaussian gaussian;
  AdvantageScale scale;
  int slices;

  [[nodiscard]] double weight() const { return 1 / static_cast<double>(which.size()); }
  /// Calls body(rows, whether they are the first ones) for all rows of a slice, a few at a time.
  template <class Body>
  void for_each_block(int slice, const Body& body) const {
    const auto place = [&](int i) { return which.size() * std::size_t(i) / std::size_t(slices); };
    std::span<const int> rest = which.subspan(place(slice), place(slice + 1) - place(slice));
    for (bool first = true; !rest.empty(); first = false) {
      const std::size_t count = std::min<std::size_t>(rest.size(), Mlp::kRows);
      body(rest.first(count), first);
      rest = rest.subspan(count);
    }
  }
};

PpoGradient::PpoGradient(const PolicyShape& shape, std::size_t parameters, Networks& networks)
    : shape_(shape), networks_(networks), sums_(parameters, kPortion, networks) {}

LossMeans PpoGradient::compute(const Policy& policy, const Samples& samples,
                               std::span<const int> which, const PpoOptions& options) {
  const Batch batch = {samples,
                       which,
                       options,
                       Gaussian(policy.log_std()),
                       AdvantageScale(samples.advantages, which, options.normalise_advantages),
                       slices_of(which.size())};
  sums_.reserve(batch.slices);
  losses_.resize(static_cast<std::size_t>(batch.slices));
  networks_.workers().run(2 * batch.slices, [&](int task, int thread) {
    if (task < batch.slices) {
      run_actor(batch, task, thread);
    } else {
      run_critic(batch, task - batch.slices, thread);
    }
  });
  sums_.add(batch.slices);
  // The entropy is the sum of log_std but for a constant.
  for (float& by_log_std : gradient().last(static_cast<std::size_t>(shape_.actions))) {
    by_log_std -= static_cast<float>(options.entropy_weight);
  }
  LossMeans means;
  for (const LossMeans& of_slice : losses_) means += of_slice;
  return means *= batch.weight();
}

void PpoGradient::actor_loss(const Batch& batch, std::span<const int> rows, Mlp::Scratch& scratch,
                             LossMeans& sums, std::span<double> by_log_std) const {
  const auto actions = static_cast<std::size_t>(shape_.actions);
  std::vector<float> mean(actions);
  for (int i = 0; i < static_cast<int>(rows.size()); ++i) {
    const auto sample = static_cast<std::size_t>(rows[i]);
    const float* action = batch.samples.actions.data() + sample * actions;
    for (std::size_t k = 0; k < actions; ++k) mean[k] = scratch.values.back().at(i, int(k));
    const double log_prob = batch.gaussian.log_prob(action, mean.data());
    const double advantage =
        (batch.samples.advantages[sample] - batch.scale.mean) * batch.scale.factor;
    const SurrogateTerm term = surrogate_term(log_prob - double(batch.samples.log_probs[sample]),
                                              advantage, batch.options.clip);
    sums += {term.loss, 0, term.kl, term.clipped ? 1.0 : 0.0};
    const double slope = term.slope * batch.weight();
    for (std::size_t k = 0; k < actions; ++k) {
      const double z = batch.gaussian.distance(k, action, mean.data());
      const double by_mean = slope * z * batch.gaussian.inverse(k);
      scratch.gradients.back().at(i, int(k)) = static_cast<float>(by_mean);
      by_log_std[k] += slope * (z * z - 1);
    }
  }
}

void PpoGradient::run_actor(const Batch& batch, int slice, int thread) {
  const Mlp& net = networks_.actor();
  Mlp::Scratch& scratch = networks_.actor_scratch(thread);
  LossMeans sums;
  std::vector<double> by_log_std(static_cast<std::size_t>(shape_.actions), 0.0);
  float* gradient = sums_.slice(slice);
  batch.for_each_block(slice, [&](std::span<const int> rows, bool first) {
    gather(batch.samples, rows, scratch.values.front());
    net.forward(static_cast<int>(rows.size()), scratch);
    actor_loss(batch, rows, scratch, sums, by_log_std);
    net.backward(static_cast<int>(rows.size()), scratch, !first, gradient);
  });
  // log_std stands last of all parameters.
  std::ranges::copy(by_log_std, gradient + sums_.size() - by_log_std.size());
  losses_[slice].policy = sums.policy;
  losses_[slice].kl = sums.kl;
  losses_[slice].clip_fraction = sums.clip_fraction;
}

void PpoGradient::run_critic(const Batch& batch, int slice, int thread) {
  const Mlp& net = networks_.critic();
  Mlp::Scratch& scratch = networks_.critic_scratch(thread);
  double sum = 0;
  batch.for_each_block(slice, [&](std::span<const int> rows, bool first) {
    gather(batch.samples, rows, scratch.values.front());
    net.forward(static_cast<int>(rows.size()), scratch);
    for (int i = 0; i < static_cast<int>(rows.size()); ++i) {
      const auto sample = static_cast<std::size_t>(rows[i]);
      const ValueTerm term =
          value_term(scratch.values.back().at(i, 0), batch.samples.values[sample],
                     batch.samples.returns[sample], batch.options.value_clip);
      sum += term.loss;
      scratch.gradients.back().at(i, 0) =
          static_cast<float>(term.slope * batch.options.value_weight * batch.weight());
    }
    net.backward(static_cast<int>(rows.size()), scratch, !first, sums_.slice(slice));
  });
  losses_[slice].value = sum;
}

}  // namespace mjarm::rl::detail
