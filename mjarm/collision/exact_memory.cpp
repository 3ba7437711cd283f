#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "mjarm/collision/exact_memory_internal.hpp"

namespace mjarm::detail {
using Eigen::Vector3d;

std::vector<double> longest_levers(const mjModel& m, const mjData& d, const ArmBodies& bodies) {
  const std::size_t dof = bodies.joints.size();
  const auto anchor = [&](std::size_t k) { return Vector3d(d.xanchor + 3 * bodies.joints[k]); };
  // How far the geoms that hang on each joint, and on none after it, reach from its anchor.
  std::vector<double> reach(dof, 0.0);
  for (int g = 0; g < static_cast<int>(m.ngeom); ++g) {
    const int piece = bodies.pieces[static_cast<std::size_t>(m.geom_bodyid[g])];
    if (piece == 0) continue;
    const auto k = static_cast<std::size_t>(piece - 1);
    const Vector3d p_W(d.geom_xpos + 3 * g);
    reach[k] = std::max(reach[k], (p_W - anchor(k)).norm() + m.geom_rbound[g]);
  }
  std::vector<double> levers(dof, 1.0);
  double beyond = 0;  // that all after a joint reach from its anchor
  for (std::size_t k = dof; k-- > 0;) {
    if (k + 1 < dof) beyond += (anchor(k + 1) - anchor(k)).norm();
    beyond = std::max(beyond, reach[k]);
    if (m.jnt_type[bodies.joints[k]] == mjJNT_HINGE) {
      levers[k] = beyond;
      continue;
    }
    // A slide carries what comes after it away from the joints before, nobody knows how far.
    beyond = std::numeric_limits<double>::infinity();
  }
  return levers;
}

void ClearanceMemory::remember(std::span<const double> q, const Seen& seen) {
  q_.assign(q.begin(), q.end());
  seen_ = seen;
}

double ClearanceMemory::moved(std::span<const double> q) const {
  if (q_.size() != q.size() || levers_.size() != q.size()) {
    return std::numeric_limits<double>::infinity();
  }
  double sum = 0;
  for (std::size_t k = 0; k < q.size(); ++k) {
    if (q[k] != q_[k]) sum += levers_[k] * std::abs(q[k] - q_[k]);
  }
  return sum;
}

double ClearanceMemory::least_told(double moved, double margin) const {
  double least = seen_.told - moved - kSure;
  const double near = seen_.neighbours - moved - kSure;
  if (near < kNeighboursFrom) least = std::min(least, near);
  return least < margin ? least : std::numeric_limits<double>::infinity();
}

}  // namespace mjarm::detail
