#include "mjarm/program/closed_way_internal.hpp"

namespace mjarm::program::detail {

std::optional<PathFix> find_fix(const IkSolver& ik, const ClosedWay& way) {
  const auto path = solve_curve(ik, way.curve, as_span(way.q_start), way.options);
  if (path) return std::nullopt;
  const auto fixes = find_fixes(ik, way.curve, as_span(way.q_start), way.options, path.error(), 1);
  if (fixes.empty()) return std::nullopt;
  return fixes.front();
}

}  // namespace mjarm::program::detail
