#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/mjarm/cli/batch.hpp"
#include "apps/mjarm/cli/robot.hpp"
#include "apps/mjarm/commands/plan_show.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/planning/plan_file.hpp"
#include "mjarm/planning/plan_path.hpp"

namespace mjarm::app {

/// One way to be found for the robot of a file, as the command line has it; empty: not given.
struct RobotRequest {
  RobotChoice robot;
  std::string start;                                     ///< joint values; empty: the home position
  std::string goal;                                      ///< joint values, or else a pose:
  std::string pos, euler, quat;                          ///< of the tool
  std::string task;                                      ///< pose, position or axis
  std::string around, lean, turn;                        ///< how far off the pose will do
  std::vector<std::string> goal_regions, start_regions;  ///< of the tool, instead
  std::string upright;  ///< angle by which the tool may lean on its way
  std::string within;   ///< region that it stays in
  RuleWords rules;
};

/// Adds `--robot` and all that belongs to it.
void add_robot_request(CLI::App& app, RobotRequest& request);

/// Whether something of it was given.
[[nodiscard]] bool is_given(const RobotRequest& request);

/// Plans the way and writes it to `output` as a problem file's answers are
/// written; its id is the robot's name.
/// @param show  how it is shown then.
/// @return the exit code, or what is wrong with the request.
[[nodiscard]] Result<int> plan_for_robot(const RobotRequest& request, const PlanOptions& options,
                                         const std::optional<session::PlanShow>& show,
                                         AnswerOutput& output, bool timing);

}  // namespace mjarm::app
