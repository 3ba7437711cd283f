#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mjarm/core/result.hpp"

namespace mjarm::rl {

/// Many copies of one task that are stepped together. Observations and actions are rows of one
/// matrix in row-major order, one row a copy.
///
/// A copy whose episode ended in a step starts a new one in the same step: `observations()` then
/// holds the first observation of the new episode, `final_observations()` the last of the old one.
/// Every copy has random numbers of its own, so that results depend on no number of threads.
class VecEnv {
 public:
  virtual ~VecEnv() = default;

  [[nodiscard]] virtual int count() const noexcept = 0;             ///< copies
  [[nodiscard]] virtual int observation_size() const noexcept = 0;  ///< numbers a row
  [[nodiscard]] virtual int action_size() const noexcept = 0;       ///< numbers a row

  /// Starts every copy anew, from random numbers that `seed` decides.
  [[nodiscard]] virtual Result<void> reset(std::uint64_t seed) = 0;
  /// One step of every copy.
  /// @param actions  (count, action_size), clamped to what the task allows, [-1, 1] as a rule.
  /// @return an error where an action is not a number; a copy whose simulation fails ends its
  ///         episode as terminated instead.
  [[nodiscard]] virtual Result<void> step(std::span<const float> actions) = 0;

  [[nodiscard]] virtual std::span<const float> observations() const noexcept = 0;
  [[nodiscard]] virtual std::span<const float> rewards() const noexcept = 0;  ///< (count,)
  /// (count,) 1 where the episode ended for good: no reward can follow.
  [[nodiscard]] virtual std::span<const std::uint8_t> terminated() const noexcept = 0;
  /// (count,) 1 where the step limit cut the episode: the value of its last state still counts.
  [[nodiscard]] virtual std::span<const std::uint8_t> truncated() const noexcept = 0;
  /// Like `observations()`, of the step just done; only rows of ended episodes are set.
  [[nodiscard]] virtual std::span<const float> final_observations() const noexcept = 0;

  /// Everything that decides what comes next, for checkpoints.
  [[nodiscard]] virtual std::vector<double> state() const = 0;
  /// Back to a state of a task with the same options; what follows is the same to the last bit.
  /// @return an error where it does not fit.
  [[nodiscard]] virtual Result<void> set_state(std::span<const double> state) = 0;
};

}  // namespace mjarm::rl
