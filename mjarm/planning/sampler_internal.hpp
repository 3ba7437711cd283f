#pragma once

#include <array>
#include <span>

#include "mjarm/core/rng.hpp"
#include "mjarm/planning/halton_internal.hpp"
#include "mjarm/planning/search_internal.hpp"

namespace mjarm::detail {

/// Where samples are drawn: an even sequence in a box round start and goals, which widens to all
/// that the limits allow. Most ways are near to where they lead; the rest is reached a little
/// later.
class WideningBox {
 public:
  WideningBox(const SearchProblem& problem, Rng& rng);

  /// Writes the next sample, shape (dof,).
  void next(std::span<double> q);

 private:
  Halton halton_;
  int count_ = 0;
  std::array<double, kMaxDof> least_{}, max_{}, low_{}, high_{};
};

/// A place at a random distance (short ones are as likely as long ones) from `from` in a random
/// direction. Writes it, shape (dof,); returns the distance [rad or m, L2].
double draw_beside(std::span<const double> from, Rng& rng, std::span<double> q);

}  // namespace mjarm::detail
