#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/collision/exact_grasp.hpp"
#include "mjarm/core/pose.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/planning/grasps.hpp"
#include "mjarm/program/program_plan.hpp"

namespace mjarm::program {

/// Where an object is to be put.
struct PlaceGoal {
  Pose X_WB;              ///< of its body in the world
  bool any_turn = false;  ///< it may be turned about the world's vertical as the arm likes
  /// Poses X_BS that are as good: a body in X_WB * X_BS looks as it does in X_WB. None but that
  /// itself where empty.
  std::vector<Pose> same = {};
};

/// One object, from where it stands to where it is to be.
struct PickTask {
  std::string object;                   ///< a body with a free joint
  std::optional<PlaceGoal> place = {};  ///< none: it is only lifted
};

/// How a pick is planned. Every default is usable as is.
struct PickOptions {
  GraspOptions grasp = {};
  double approach = 0.08;         ///< [m] > 0 of the straight way to the object, and away from it
  double lift = 0.1;              ///< [m] > 0 straight up with it, and straight down to its place
  double keep_off = 5e-4;         ///< [m] >= 0 from all but the object, where the fingers close
  double drop = 1e-3;             ///< [m] >= 0 above its place where it is let go
  double tool_speed = 0.15;       ///< [m/s] > 0 on straight ways
  std::vector<Grasp> avoid = {};  ///< that were tried in vain
  std::size_t tries = 12;         ///< grasps that are planned to the end at most, >= 1
  StopCheck stop = {};
};

/// Why a grasp was dropped, or why there is none. In the order in which they are found out.
enum class PickErrc {
  not_seen,            ///< no camera saw where it is
  no_object,           ///< no body of that name, or one that cannot be carried
  no_gripper,          ///< the arm has none, or none with two fingers that face each other
  hand_full,           ///< something is held already; of plan_place(): nothing is
  too_wide,            ///< no two opposite sides are as near together as the gripper opens
  failed_before,       ///< it is one of PickOptions::avoid
  grasp_out_of_reach,  ///< the tool cannot be had there
  grasp_blocked,       ///< it can, but not without contact
  not_held,            ///< the fingers close on something else, or on nothing
  place_out_of_reach,  ///< with that grasp the place cannot be had
  place_blocked,       ///< it can, but not without contact
  no_way,              ///< both can, but not the ways between them
  stopped,
};
/// "no_object", "too_wide", ...
[[nodiscard]] std::string_view name(PickErrc code) noexcept;

/// A grasp that will not do.
struct DroppedGrasp {
  Grasp grasp;
  PickErrc code = PickErrc::grasp_out_of_reach;
  std::string what;  ///< one line for people
};

/// What was decided, before anything moves.
struct PickPlan {
  ProgramPlan plan;  ///< from where the arm stands until it has let go and drawn back, or lifted it
  Grasp grasp;       ///< that was chosen; of plan_place(): none
  Pose X_TB;         ///< the object in the frame of the tool that holds it
  std::optional<Pose> X_WB_place;  ///< where the object will be
  std::vector<DroppedGrasp> dropped;
};

/// Why nothing can be done.
struct PickFailure {
  PickErrc code = PickErrc::no_way;  ///< of the grasps the one that came farthest
  std::string what;                  ///< one line for people, in their language
  std::vector<DroppedGrasp> dropped;
};

/// Plans to pick an object up and to put it down: above it by the planner, straight to it, close,
/// straight up, by the planner with the object attached, straight down, open, straight away. Of all
/// grasps (find_grasps()) those come first that come from above, hold it near its centre of mass
/// and keep clear of what stands beside; each is looked at with every answer of the inverse
/// kinematics, and whether the place can be had with it and the fingers may open there, before ways
/// are planned. All of it is
/// proved as plan_program() does.
/// @param scene  how things stand: where objects were seen, how far the fingers are open; empty:
///               as in the model.
/// @param q      (dof,) [rad or m] where the arm stands.
[[nodiscard]] Result<PickPlan, PickFailure> plan_pick(const Robot& robot, const SceneState& scene,
                                                      std::span<const double> q,
                                                      const PickTask& task,
                                                      const PickOptions& options = {});

/// Puts down the one thing that `scene` has attached: what follows plan_pick() without a place.
[[nodiscard]] Result<PickPlan, PickFailure> plan_place(const Robot& robot, const SceneState& scene,
                                                       std::span<const double> q,
                                                       const PlaceGoal& place,
                                                       const PickOptions& options = {});

}  // namespace mjarm::program
