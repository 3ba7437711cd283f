#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mjarm/core/stop.hpp"
#include "mjarm/episode/record.hpp"
#include "mjarm/episode/task_internal.hpp"
#include "mjarm/program/program_plan.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm::episode {

/// How things stand at the time of one row.
struct Sample {
  Snapshot state;  ///< for the pictures
  std::vector<double> qpos, qvel, ctrl;
  JointVec q, v;              ///< (dof,) as simulated
  JointVec q_ref;             ///< (dof,) [rad] where the arm is to be
  Pose X_WT, X_WT_ref;        ///< of the tool, as simulated and where it is to be
  double grip = 0;            ///< 0 open to 1 closed, as commanded
  std::vector<Pose> objects;  ///< X_WB in the order of the drawn scene
  std::size_t motion = 0;     ///< of the plan
  std::size_t marks = 0;      ///< Task::marks()
};

/// What was done and what came of it.
struct Demonstration {
  program::ProgramPlan plan;  ///< without motions where there is none
  Pose goal;                  ///< TaskPlan::goal
  Verdict verdict;
  double tool_error = 0;   ///< [m] of the tool from where it was to be, at most
  double joint_error = 0;  ///< [rad] of any joint, at most
  std::vector<Sample> samples;
};

/// Plans and executes a task, in a simulation of its own.
/// @param robot  in the scene of the task as it was drawn: placed().
/// @param jaws   find_jaws() of the robot where it has a gripper.
/// @return an error where the simulation broke down, or it was stopped; what cannot be planned or
///         goes wrong is a verdict.
[[nodiscard]] Result<Demonstration> demonstrate(const Robot& robot, const std::optional<Jaws>& jaws,
                                                const EpisodeOptions& options, Task& task,
                                                const StopCheck& stop, EpisodeTimes& times);

}  // namespace mjarm::episode
