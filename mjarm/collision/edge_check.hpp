#pragma once

#include <span>
#include <vector>

#include "mjarm/collision/edge_verdict.hpp"
#include "mjarm/collision/fast_check.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm {

/// How an edge is checked. Every default is usable as is.
struct EdgeOptions {
  double resolution = 1e-3;  ///< [rad or m, L2] narrowest interval that is tried, > 0
  /// [rad or m] shape (dof,), >= 0: what is within this of the edge, in every joint, is proved as
  /// well, limits included; `hit` is then as good as `undecided`. Empty: the edge alone.
  std::span<const double> beside = {};
};

/// What check_edge() found. `hit` is also what is as near to a collision as the padding;
/// `undecided` an interval as narrow as the resolution that could not be proved.
struct EdgeResult {
  EdgeVerdict verdict = EdgeVerdict::free;
  double t = 0;      ///< where on the edge it is not free, 0 to 1
  int stations = 0;  ///< configurations that were looked at
};

/// Proves or refutes that the straight edge q(t) = q0 + t (q1 - q0), t in [0, 1], is free. The edge
/// is cut into intervals. In the middle of each, every radius grows by what its sphere can move
/// within the interval: its speed there, and a bound of the second derivative from the largest
/// distances to the joints' axes. Where nothing overlaps the whole interval is free; else it is cut
/// in two. Wide intervals come first, so that most collisions show early. What lies beside the edge
/// makes every radius grow by the sum over the joints of how far they are off times their largest
/// distance. Never allocates.
/// @param q0, q1  shape (dof,) [rad or m].
[[nodiscard]] EdgeResult check_edge(const FastChecker& checker, std::span<const double> q0,
                                    std::span<const double> q1,
                                    const EdgeOptions& options = {}) noexcept;

/// A proved part of an edge: [t - half, t + half].
struct EdgeInterval {
  double t = 0;
  double half = 0;
};

/// What proves that an edge is free.
struct EdgeCertificate {
  std::vector<EdgeInterval> intervals;  ///< in order; together they cover [0, 1]
  double step = 0;                      ///< [rad or m, L2] length of the narrowest
  SphereClearance nearest;              ///< the least clearance in the middle of any interval
  double nearest_t = 0;                 ///< where that is
};

/// check_edge(), and the proof.
/// @return what check_edge() found instead where the edge is not proved to be free.
[[nodiscard]] Result<EdgeCertificate, EdgeResult> certify_edge(const FastChecker& checker,
                                                               std::span<const double> q0,
                                                               std::span<const double> q1,
                                                               const EdgeOptions& options = {});

}  // namespace mjarm
