#pragma once

#include <span>
#include <vector>

#include "mjarm/rl/gradient_sums_internal.hpp"
#include "mjarm/rl/networks_internal.hpp"
#include "mjarm/rl/ppo.hpp"

namespace mjarm::rl::detail {

/// What a policy learns from, row by row.
struct Samples {
  std::span<const float> observations;  ///< (n, observations), normalised
  std::span<const float> actions;       ///< (n, actions)
  std::span<const float> log_probs;     ///< (n,) of the actions when they were taken
  std::span<const float> advantages;    ///< (n,)
  std::span<const float> returns;       ///< (n,)
  std::span<const float> values;        ///< (n,) before the update
};

/// Means over a minibatch.
struct LossMeans {
  double policy = 0, value = 0, kl = 0, clip_fraction = 0;

  LossMeans& operator+=(const LossMeans& other) noexcept;
  LossMeans& operator*=(double factor) noexcept;
};

/// The gradient of PPO's loss, policy + value_weight value - entropy_weight entropy, over a
/// minibatch. The minibatch is cut into slices whose number depends on its size alone; each has a
/// gradient of its own, and these are added in order.
class PpoGradient {
 public:
  /// @param networks  must outlive this.
  PpoGradient(const PolicyShape& shape, std::size_t parameters, Networks& networks);

  /// Means of the losses; the gradient stands in gradient() then.
  /// @param policy  the networks are packed with its parameters.
  /// @param which   rows of the minibatch.
  LossMeans compute(const Policy& policy, const Samples& samples, std::span<const int> which,
                    const PpoOptions& options);

  [[nodiscard]] std::span<float> gradient() noexcept { return sums_.gradient(); }
  /// |gradient()|^2
  [[nodiscard]] double squares() { return sums_.squares(); }

 private:
  struct Batch;
  /// After the actor's forward pass over `rows`: the gradient by its outputs, and what comes to the
  /// sums.
  void actor_loss(const Batch& batch, std::span<const int> rows, Mlp::Scratch& scratch,
                  LossMeans& sums, std::span<double> by_log_std) const;
  void run_actor(const Batch& batch, int slice, int thread);
  void run_critic(const Batch& batch, int slice, int thread);

  PolicyShape shape_;
  Networks& networks_;
  GradientSums sums_;
  std::vector<LossMeans> losses_;  ///< of each slice
};

}  // namespace mjarm::rl::detail
