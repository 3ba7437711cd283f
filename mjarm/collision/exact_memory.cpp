#include <algorithm>
#include <cmath>
#include <limits>

#include "mjarm/collision/exact_memory_internal.hpp"

namespace mjarm::detail {

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
