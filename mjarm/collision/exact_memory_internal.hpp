#pragma once

#include <span>
#include <utility>
#include <vector>

namespace mjarm::detail {

/// What a look at one configuration proves of those beside it: distances change by no more than
/// what the arm moves.
class ClearanceMemory {
 public:
  /// [m] of pairs of geoms that the arm can change, each at least as far as was looked.
  struct Seen {
    double all = 0;         ///< the least of those that can meet
    double told = 0;        ///< of those whose distance is told
    double neighbours = 0;  ///< of those that are told once they are nearer than kNeighboursFrom
  };
  static constexpr double kNeighboursFrom = 0.02;  ///< [m]

  /// Without them nothing is remembered.
  /// @param levers  [m a radian or metre] (dof,) by which a joint moves any point at most.
  void set_levers(std::vector<double> levers) { levers_ = std::move(levers); }
  void remember(std::span<const double> q, const Seen& seen);

  /// [m] no point is farther from where it was; infinite where nothing is remembered.
  [[nodiscard]] double moved(std::span<const double> q) const;
  [[nodiscard]] bool is_free(double moved) const { return seen_.all - moved > kSure; }
  /// [m] what is told is not less; infinite from `margin` on.
  [[nodiscard]] double least_told(double moved, double margin) const;

 private:
  static constexpr double kSure = 1e-5;  // [m] more than a distance is uncertain by

  std::vector<double> levers_, q_;
  Seen seen_;
};

}  // namespace mjarm::detail
