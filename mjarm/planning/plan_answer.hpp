#pragma once

#include <optional>
#include <string>

#include "mjarm/planning/plan_file.hpp"
#include "mjarm/planning/plan_path.hpp"
#include "mjarm/planning/problem_file.hpp"

namespace mjarm {

/// What came of one problem, and how long it took.
struct PlanAnswer {
  Result<PlannedPath, PlanFailure> path;
  double us = 0;                          ///< [us] the world made ready and a path found
  double simplify_us = 0;                 ///< [us] the path shortened and proved
  std::optional<TiltLimit> tilt = {};     ///< that the path keeps
  std::optional<TaskRegion> within = {};  ///< likewise
  RuleWords rules = {};                   ///< likewise
  std::string reason = {};     ///< why there is no path, in words; empty: describe() of the failure
  JointVec same_posture = {};  ///< of WorldFailure
};

/// Solves one problem. Both times together cover everything, allocation included; with a time
/// budget all of it is in `us`.
[[nodiscard]] PlanAnswer answer_problem(const FastRobot& robot, const PlanProblem& problem,
                                        const PlanOptions& options);

/// Appends the answer as a JSON object, as read_plan_file() reads it.
/// @param robot, obstacles  that it was planned for; their names are told.
void append_answer(std::string& out, const PlanAnswer& answer, const FastRobot& robot,
                   const Obstacles& obstacles, bool timing);

}  // namespace mjarm
