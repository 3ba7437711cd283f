#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "mjarm/collision/fast_tables_internal.hpp"

namespace mjarm::detail {

/// The order of places along a curve that fills space (G. M. Morton, 1966), so that neighbours in
/// it are near each other: indices of `places`, which are finite. Takes the same time whatever the
/// places are.
[[nodiscard]] std::vector<int> curve_order(std::span<const Eigen::Vector3f> places);

/// A box with sides along the axes.
struct FastBounds {
  Eigen::Vector3f low, high;
};

/// The arrays behind a FastTree over leaves in the order of the curve. Nodes are filled up from the
/// first to the last leaf, so that no node has to say where its children are.
struct FastTreeNodes {
  std::vector<FastNode> levels[kFastLevels];

  /// @param leaves  at most kFan^kFastLevels.
  void build(std::span<const FastBounds> leaves);
  [[nodiscard]] FastTree tables() const;
};

}  // namespace mjarm::detail
