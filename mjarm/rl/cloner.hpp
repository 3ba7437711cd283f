#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "mjarm/core/rng.hpp"
#include "mjarm/rl/mixture_policy.hpp"

namespace mjarm::rl {

/// What was demonstrated, row by row.
struct Demonstrations {
  std::size_t rows = 0;  ///< at least 1
  int observations = 0;  ///< numbers of an observation, >= 1
  int actions = 0;       ///< numbers of an action, >= 1
  /// Writes observation and action of a row. What it draws from `rng` may blur them, so that the
  /// policy learns to come back to the way; null: as they were. Called from several threads.
  std::function<void(std::size_t row, Rng* rng, std::span<float> observation,
                     std::span<float> action)>
      show = {};
};

/// How a policy is cloned. Every default is usable as is.
struct CloningOptions {
  std::vector<int> hidden = {256, 256};
  int modes = 4;                ///< ways that are kept apart, 1 to 64
  int batch = 1024;             ///< rows of a step, >= 1
  int epochs = 100;             ///< passes over all rows, >= 1
  double learning_rate = 1e-3;  ///< at first; falls to 0 as half a cosine
  double least_std = 0.02;      ///< of a mode, in units of the actions; > 0
  double max_norm = 10;         ///< of the gradient, > 0
  std::uint64_t seed = 1;
  int threads = 1;  ///< whose number changes no byte
};

/// Behaviour cloning: makes the demonstrated actions likely (D. A. Pomerleau, Neural Computation 3
/// (1991) 88), by Adam on the likelihood of a mixture.
class Cloner {
 public:
  /// @param demonstrations  must outlive this.
  Cloner(const Demonstrations& demonstrations, const CloningOptions& options);
  ~Cloner();
  Cloner(Cloner&&) noexcept;
  Cloner& operator=(Cloner&&) noexcept;

  /// One pass over all rows in an order of its own.
  /// @return the mean of -ln of their likelihood, as they were shown; not finite where the learning
  ///         diverged.
  double epoch();
  [[nodiscard]] int epochs() const noexcept;  ///< done so far
  [[nodiscard]] const MixturePolicy& policy() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace mjarm::rl
