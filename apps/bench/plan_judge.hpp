#pragma once

#include <span>
#include <string>
#include <vector>

#include "apps/bench/plan_sets.hpp"
#include "mjarm/core/joint_vec.hpp"

namespace mjarm::app {

/// What is wrong with a path.
enum class PathFault { none, shape, start, goal, limits, obstacle, self };
/// One word for the JSON document: "obstacle"; empty for none.
[[nodiscard]] const char* name_of(PathFault fault);

struct PathVerdict {
  PathFault fault = PathFault::none;
  double depth = 0;  ///< [m] of the deepest overlap
  double cost = 0;   ///< [rad or m] sum of the L2 lengths of the edges
};

/// Judges a path, ours or a peer's, in the plainest way: it starts at the start and ends at a goal
/// (to 1e-4 in each joint), stays within the limits (to 1e-4), and at every 0.005 rad (L2) along
/// each edge, ends included, no sphere overlaps an obstacle or a sphere it is paired with, by any
/// depth. In double precision, one sphere at a time; shares nothing with the planner and its
/// checks but the distance to a solid.
/// @param path  rows of any length; what is no path is a fault.
[[nodiscard]] PathVerdict judge_path(const PlanSet& set, const PlanProblem& problem,
                                     std::span<const std::vector<double>> path);

}  // namespace mjarm::app
