#pragma once

#include <span>
#include <vector>

#include "mjarm/rl/mlp_internal.hpp"
#include "mjarm/rl/workers_internal.hpp"

namespace mjarm::rl::detail {

/// Actor and critic of a policy, ready to be computed for many rows at a time by all workers. What
/// comes out for a row depends on neither its neighbours nor the number of threads.
class Networks {
 public:
  /// @param workers  must outlive this.
  Networks(const NetKernels& kernels, const Policy& policy, Workers& workers);

  /// Takes over the parameters; due whenever they have changed.
  void pack(const Policy& policy);

  /// Mean actions.
  /// @param rows   (n, observations), normalised.  @param means  (n, actions)
  void means(std::span<const float> rows, std::span<float> means);
  /// @param rows   (n, observations), normalised.  @param values  (n,)
  void values(std::span<const float> rows, std::span<float> values);

  [[nodiscard]] const NetKernels& kernels() const noexcept { return kernels_; }
  [[nodiscard]] Workers& workers() noexcept { return workers_; }
  [[nodiscard]] const Mlp& actor() const noexcept { return actor_; }
  [[nodiscard]] const Mlp& critic() const noexcept { return critic_; }
  [[nodiscard]] Mlp::Scratch& actor_scratch(int thread) { return scratch_[2 * thread]; }
  [[nodiscard]] Mlp::Scratch& critic_scratch(int thread) { return scratch_[2 * thread + 1]; }

 private:
  void compute(const Mlp& net, bool is_actor, std::span<const float> rows, std::span<float> out);

  const NetKernels& kernels_;
  Workers& workers_;
  Mlp actor_, critic_;
  std::vector<Mlp::Scratch> scratch_;  ///< two of each thread
};

}  // namespace mjarm::rl::detail
