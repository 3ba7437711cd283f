#pragma once

#include <array>
#include <span>

#include "mjarm/core/rng.hpp"
#include "mjarm/planning/halton_internal.hpp"
#include "mjarm/planning/search_internal.hpp"

namespace mjarm::detail {

/// Where samples are drawn: in boxes that widen with every sample, so that ways are found first
/// that are near to where they lead.
class Sampler {
 public:
  Sampler(const SearchProblem& problem, Rng& rng);

  /// Writes the next place of an even sequence in a box round start and goals, which widens to all
  /// that the limits allow, shape (dof,).
  void between_ends(std::span<double> q);
  /// Writes a random place in a box round a node, which widens to 2 rad or m to every side, or half
  /// of what the limits allow; what is beyond a limit is moved onto it, so that many samples are
  /// where joints are at their limits.
  void beside(std::span<const double> node, std::span<double> q);

 private:
  Rng& rng_;
  Halton halton_;
  int count_ = 0;
  std::array<double, kMaxDof> least_{}, max_{}, low_{}, high_{};
};

}  // namespace mjarm::detail
