#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "mjarm/control/controller.hpp"
#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/sim/recorder.hpp"
#include "mjarm/sim/sim.hpp"
#include "mjarm/sim/stepper.hpp"

namespace mjarm {

/// What a follower of waypoints works with; all of it outlives the call. The arm starts where it
/// stands.
struct FollowSetup {
  Sim& sim;
  Controller& controller;
  const Arm& arm;
  Recorder* recorder = nullptr;  ///< gets the state before the first step and after every step
  /// Called after every step (window, progress, Ctrl-C); returns false to stop. May be empty.
  std::function<bool(const Sim& sim)> after_step = {};
};

/// What a run was waiting for when it gave up.
enum class WaitCause {
  sag,          ///< the servo hangs lower under gravity than the tolerance allows
  force_limit,  ///< an actuator gives all it has
  contact,      ///< the arm touches something
  moving,       ///< still on its way: more steps would do
  unknown,      ///< stands still, off the waypoint, for no reason that shows
};

/// The waypoint that was not reached in time.
struct FollowWait {
  std::size_t waypoint = 0;  ///< index from 0
  std::size_t count = 0;     ///< number of waypoints
  int steps = 0;             ///< steps spent on it
  int joint = -1;        ///< index in the arm of the worst joint; -1 where the tool is waited for
  double distance = 0;   ///< [rad or m] of that joint, or [m] of the tool
  double tolerance = 0;  ///< same unit
  WaitCause cause = WaitCause::unknown;
  double sag = 0;        ///< expected from gravity / gain, same unit; 0 where the mode has none
  double torque = 0;     ///< [N m or N] of gravity at the worst joint, its share of `sag`
  double stiffness = 0;  ///< [N m/rad or N/m] of that joint's servo
  std::optional<Contact> contact;
};

/// Why a run ended early, and what it did before.
struct FollowFailure {
  std::optional<FollowWait> wait;  ///< set where a waypoint was waited for in vain
  std::optional<Error> error;      ///< set where the simulation broke down, or nothing could begin
  FollowOutcome outcome;
};
/// One line for people.
[[nodiscard]] std::string describe(const FollowFailure& failure, const Arm& arm);

/// When a waypoint counts as reached, and how long it may take. Every default is usable as is.
struct GateOptions {
  double joint_tol = 0.02;  ///< [rad or m] every joint this near: next joint waypoint, > 0
  double tool_tol = 0.01;   ///< [m] tool this near: next tool point, > 0
  int max_steps = 5000;     ///< steps spent on one waypoint before giving up, >= 1
};

/// Each of `waypoints` is commanded until all joints are within `joint_tol` of it.
[[nodiscard]] Result<FollowOutcome, FollowFailure> follow_joints(
    const FollowSetup& setup, std::span<const JointVec> waypoints, const GateOptions& options = {});

/// Each of `waypoints` is commanded until the tool is within `tool_tol` of the tool position that
/// belongs to it, `points` [m] in the world, equally many.
[[nodiscard]] Result<FollowOutcome, FollowFailure> follow_tool(
    const FollowSetup& setup, std::span<const JointVec> waypoints,
    std::span<const Eigen::Vector3d> points, const GateOptions& options = {});

}  // namespace mjarm
