#pragma once

#include <string>
#include <vector>

#include "mjarm/core/stop.hpp"
#include "mjarm/episode/draw_scene.hpp"
#include "mjarm/episode/record.hpp"
#include "mjarm/model/jaws.hpp"
#include "mjarm/model/scene_bodies.hpp"
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
};

/// What was done and what came of it.
struct Demonstration {
  program::ProgramPlan plan;  ///< without motions where there is none
  Pose goal;                  ///< reach: of the tool; pick_place: of the object, as planned
  Verdict verdict;
  double tool_error = 0;   ///< [m] of the tool from where it was to be, at most
  double joint_error = 0;  ///< [rad] of any joint, at most
  std::vector<Sample> samples;
};

/// Plans and executes what the scene asks for, in a simulation of its own.
/// @param jaws  find_jaws() of the robot.
/// @return an error where the simulation broke down, or it was stopped; what cannot be planned or
///         goes wrong is a verdict.
[[nodiscard]] Result<Demonstration> demonstrate(const Robot& robot, const Jaws& jaws,
                                                const EpisodeOptions& options,
                                                const DrawnScene& scene, const StopCheck& stop,
                                                EpisodeTimes& times);

}  // namespace mjarm::episode
