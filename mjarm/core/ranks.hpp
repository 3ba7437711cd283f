#pragma once

#include <span>

namespace mjarm {

/// Processes that do one job together, each a share of its own: sums over all of
/// them. Every rank makes the same calls in the same order. A sum over one rank changes nothing.
class Ranks {
 public:
  virtual ~Ranks() = default;

  [[nodiscard]] virtual int rank() const noexcept = 0;  ///< of this process, from 0
  [[nodiscard]] virtual int size() const noexcept = 0;  ///< how many, >= 1

  /// Replaces each value by its sum over all ranks: the same bytes on each of them.
  virtual void sum(std::span<double> values) = 0;
  virtual void sum(std::span<float> values) = 0;
};

/// Whether it is so on any rank, on each of them; null: this process alone. By it a rank that fails
/// or is stopped takes the others along: alone, they would wait for it for ever.
[[nodiscard]] inline bool on_any_rank(Ranks* ranks, bool here) {
  if (ranks == nullptr) return here;
  double count[] = {here ? 1.0 : 0.0};
  ranks->sum(std::span<double>(count));
  return count[0] > 0;
}

}  // namespace mjarm
