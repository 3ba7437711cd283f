#pragma once

#include <span>

#include "mjarm/collision/verify_edge.hpp"

namespace mjarm {

/// A robot of spheres among its obstacles.
struct VerifyScene {
  const Arm& arm;
  const SphereSet& spheres;
  const Obstacles& obstacles;
};

/// verify_edge() for a distance that is kept: moving links from obstacles, paired links from each
/// other. A micrometre less will do.
/// @param kept  [m] >= 0.
[[nodiscard]] Result<VerifyResult> verify_kept(const VerifyScene& scene, std::span<const double> q0,
                                               std::span<const double> q1, double kept,
                                               const StopCheck& stop);

}  // namespace mjarm
