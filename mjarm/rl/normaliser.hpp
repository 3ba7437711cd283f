#pragma once

#include <Eigen/Core>
#include <span>

#include "mjarm/core/ranks.hpp"

namespace mjarm::rl {

/// Shifts and scales observations to about N(0, 1), by what was seen so far. With `count` 0 it does
/// nothing, not even clip.
struct Normaliser {
  Eigen::VectorXd mean;
  Eigen::VectorXd variance;  ///< of the population
  double count = 0;
  double clip = 10;  ///< > 0, of the normalised values

  /// (x - mean) / sqrt(variance + 1e-8), clipped.
  /// @param rows  (n, size of the mean), row by row.  @param out  as many; may be `rows` itself.
  void apply(std::span<const float> rows, std::span<float> out) const;

  /// Takes more observations into account: exact up to rounding, in whatever portions they come
  /// (T. F. Chan, G. H. Golub and R. J. LeVeque, The American Statistician 37 (1983) 242).
  /// @param rows   (n, size of the mean), row by row.
  /// @param ranks  all take part with rows of their own and get the same result; null: this alone.
  void absorb(std::span<const float> rows, Ranks* ranks = nullptr);

  [[nodiscard]] bool operator==(const Normaliser&) const = default;
};

}  // namespace mjarm::rl
