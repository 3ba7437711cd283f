#include "mjarm/planning/way_prover.hpp"

#include <algorithm>

namespace mjarm {

/// Whether the clearance is kept; or, where all places are near an end, what is kept there.
template <class Keeps>
bool WayProver::any_keeps(std::initializer_list<const JointVec*> places, const Keeps& keeps) const {
  if (keeps(wide_)) return true;
  return std::ranges::any_of(ends_, [&](const NearEnd& end) {
    const auto is_near = [&](const JointVec* q) { return (*q - end.q).norm() <= end.radius; };
    return std::ranges::all_of(places, is_near) && keeps(end.narrow);
  });
}

bool WayProver::is_free(const JointVec& q) const {
  return any_keeps({&q}, [&](const FastChecker& checker) { return checker.is_free(as_span(q)); });
}

bool WayProver::is_edge_free(const JointVec& from, const JointVec& to,
                             const EdgeOptions& options) const {
  return any_keeps({&from, &to}, [&](const FastChecker& checker) {
    return check_edge(checker, as_span(from), as_span(to), options).verdict == EdgeVerdict::free;
  });
}

bool WayProver::is_proved(const JointVec& from, const JointVec& to) const {
  return is_edge_free(from, to, {1e-5});
}

bool WayProver::is_proved(const JointVec& from, const JointVec& to, const JointVec& beside) const {
  constexpr double kParts = 4;
  return is_edge_free(from, to, {(to - from).norm() / kParts, as_span(beside)});
}

}  // namespace mjarm
