#include <algorithm>

#include "mjarm/planning/verify_kept_internal.hpp"

namespace mjarm {
namespace {

constexpr double kKeptSlack = 1e-6;  // [m]

/// @param still  those at rest as well.
SphereSet grown(SphereSet set, double by, bool still) {
  for (LinkSpheres& link : set.links) {
    if (link.joint < 0 && !still) continue;
    for (Sphere& sphere : link.spheres) sphere.radius += by;
  }
  return set;
}

}  // namespace

Result<VerifyResult> verify_kept(const VerifyScene& scene, std::span<const double> q0,
                                 std::span<const double> q1, double kept, const StopCheck& stop) {
  const double by = std::max(kept - kKeptSlack, 0.0);
  SphereSet alone = grown(scene.spheres, by, false);
  alone.pairs.clear();
  const VerifyOptions options{.stop = stop};
  auto found = verify_edge(scene.arm, alone, scene.obstacles, q0, q1, options);
  if (!found || found->verdict != EdgeVerdict::free) return found;
  return verify_edge(scene.arm, grown(scene.spheres, 0.5 * by, true), {}, q0, q1, options);
}

}  // namespace mjarm
