#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "mjarm/collision/random_scene_test.hpp"

/// Edges looked at sample by sample, with the oracle of random_scene_test.hpp.
namespace mjarm::testing {

inline std::vector<double> on_edge(std::span<const double> q0, std::span<const double> q1,
                                   double t) {
  std::vector<double> q;
  for (std::size_t i = 0; i < q0.size(); ++i) q.push_back(q0[i] + t * (q1[i] - q0[i]));
  return q;
}

/// The least clearance of an edge at `samples` places.
inline double least_clearance(const Arm& arm, const SphereSet& set, const Obstacles& world,
                              std::span<const double> q0, std::span<const double> q1, int samples) {
  double least = 1e9;
  for (int k = 0; k <= samples; ++k) {
    const std::vector<double> q = on_edge(q0, q1, static_cast<double>(k) / samples);
    least = std::min(least, true_clearance(arm, set, world, q));
  }
  return least;
}

}  // namespace mjarm::testing
