#pragma once

#include <span>
#include <string>
#include <vector>

#include "apps/mjarm/commands/path_file.hpp"
#include "apps/mjarm/commands/problem_file.hpp"
#include "apps/mjarm/cli/robot.hpp"
#include "mjarm/collision/cover.hpp"
#include "mjarm/collision/fast_check.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm::app {

/// A robot and what stands round it, covered with spheres and ready for the planner.
struct RobotWorld {
  ModelCover cover;
  FastChecker checker;
};

/// [m] of the spheres where nothing else is asked for: coarse ones first.
inline constexpr double kCoverBounds[] = {0.012, 0.003};

/// Adds `--hold BODY` and `--allow A,B`.
void add_rule_options(CLI::App& app, RuleWords& words);

/// The rules, where bodies are held as they stand while the arm is at `q`, shape (dof,).
[[nodiscard]] Result<ContactRules> rules_of(const RuleWords& words, const Robot& robot,
                                            std::span<const double> q);

/// Covers a robot; what its gripper can do counts.
/// @param bound  [m] by which spheres may stick out, > 0.
[[nodiscard]] Result<RobotWorld> cover_robot(const Robot& robot, double bound,
                                             const ContactRules& rules);

/// The same as a file of one problem, the way from the first to the last row of a path.
[[nodiscard]] ProblemFile as_problem(const Robot& robot, RobotWorld world, const GivenPath& path);

}  // namespace mjarm::app
