#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "mjarm/control/controller.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/execution/execution.hpp"
#include "mjarm/execution/grip_watch.hpp"
#include "mjarm/execution/object_watch.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/program/pick_place.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm::session {

/// Tells how things stand, as far as that can be seen.
/// @param scene  how they truly stand.
/// @param q      (dof,) [rad or m] where the arm stands.
using Look =
    std::function<Result<program::SeenScene>(const SceneState& scene, std::span<const double> q)>;

/// Where else to look from: the tool's pose there, and what tells how things stand then.
struct Vantage {
  Pose X_WT;
  Look look;
};

/// How a pick is done. Every default is usable as is.
struct PickAndPlaceOptions {
  program::PickOptions pick = {};
  int tries = 3;  ///< grasps that are executed at most, >= 1
  ControlMode control = ControlMode::computed_torque;
  /// The arm goes there in turn as long as nothing tells where the object is, and to one of them
  /// where something beside the object is hidden; those it cannot get to are passed over.
  std::vector<Vantage> vantages = {};
  Recorder* recorder = nullptr;  ///< gets every step; outlives the call; null = nobody records
  /// Called after every step. May be empty.
  std::function<void(const Sim& sim)> after_step = {};
};

/// One grasp that was executed.
struct PickTry {
  program::PickPlan planned;
  GripFault fault = GripFault::none;
  std::string what = {};                     ///< one line for people about `fault`
  double seconds = 0;                        ///< [s] simulated, from the look until the arm rested
  std::vector<ExecutedMotion> motions = {};  ///< of `planned.plan`, as far as it came
  std::vector<ObservedObject> objects = {};  ///< as the simulation knows them, for whoever judges
  std::optional<TimedContact> contact = {};  ///< the first one that the plan does not know
};

/// What came of it.
struct PickAndPlaceOutcome {
  bool done = false;           ///< as far as fingers and joints tell
  std::vector<PickTry> tries;  ///< in order; the last one is that of the end
  /// Why it was given up: no grasp that would do, or no pose of the object.
  std::optional<program::PickFailure> failure;
};

/// Looks, plans to pick an object up and to put it down (plan_pick()), and executes that in `sim`
/// from where the arm stands. What goes wrong is noticed by fingers and joints (GripWatch): with
/// nothing held, or where what was held is lost, the gripper opens, the arm draws back, looks again
/// and takes another grasp; an arm that is blocked stays where it is. What one look did not find,
/// looks from elsewhere may (PickAndPlaceOptions::vantages).
/// @param look  SceneEye::look(), or what else tells poses.
/// @return an error where the simulation broke down, or nobody could look.
[[nodiscard]] Result<PickAndPlaceOutcome> pick_and_place(const Robot& robot, Sim& sim,
                                                         const Look& look,
                                                         const program::PickTask& task,
                                                         const PickAndPlaceOptions& options = {});

/// Looks as pick_and_place() does: from elsewhere too where that does not find the object, or
/// something beside it. What only an earlier look found is in the answer.
[[nodiscard]] Result<program::SeenScene> look_for(const Robot& robot, Sim& sim, const Look& look,
                                                  const std::string& object,
                                                  const PickAndPlaceOptions& options = {});

}  // namespace mjarm::session
