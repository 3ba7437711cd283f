#include "mjarm/planning/way_prover.hpp"

#include <algorithm>

#include "mjarm/collision/edge_check.hpp"

namespace mjarm {
namespace {

constexpr EdgeOptions kFine{1e-5};

}  // namespace

bool WayProver::is_proved(const JointVec& from, const JointVec& to) const {
  if (check_edge(wide_, as_span(from), as_span(to), kFine).verdict == EdgeVerdict::free) {
    return true;
  }
  return std::ranges::any_of(ends_, [&](const NearEnd& end) {
    return (from - end.q).norm() <= end.radius && (to - end.q).norm() <= end.radius &&
           check_edge(end.narrow, as_span(from), as_span(to), kFine).verdict == EdgeVerdict::free;
  });
}

std::size_t WayProver::first_unproved(std::span<const JointVec> way) const {
  std::size_t piece = 0;
  while (piece + 1 < way.size() && is_proved(way[piece], way[piece + 1])) ++piece;
  return piece;
}

}  // namespace mjarm
