#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "mjarm/control/controller.hpp"
#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/sim/recorder.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm {

/// What a follower works with; all of it outlives the call. The arm starts where it stands;
/// actuators that are not the arm's keep the ctrl they have (Sim::set_ctrl).
struct FollowSetup {
  Sim& sim;
  Controller& controller;
  const Arm& arm;
  Recorder* recorder = nullptr;  ///< gets the state before the first step and after every step
  /// Called after every step (window, progress, Ctrl-C); returns false to stop. May be empty.
  std::function<bool(const Sim& sim, const JointVec& q_ref)> after_step = {};
};

/// The first time the arm, or what it carries along, touched something.
struct TimedContact {
  Contact contact;
  double time = 0;  ///< [s] of the simulation
};

/// What a run did. Errors and uses are taken at every step, at its end.
struct FollowOutcome {
  std::size_t reached = 0;  ///< waypoints that were reached; 1 at the end of a trajectory
  long long steps = 0;
  double duration = 0;          ///< [s] simulated
  bool stopped = false;         ///< `after_step` asked for the end
  double worst_error = 0;       ///< [rad or m] largest |q_ref - q| of any joint
  double final_error = 0;       ///< [rad or m] the same at the end
  double final_tool_error = 0;  ///< [m] distance of the tool from where q_ref puts it, at the end
  double velocity_use = 0;      ///< largest share of a joint's velocity limit
  double torque_use = 0;        ///< largest share of a joint's torque limit
  long long limited_steps = 0;  ///< steps in which a ctrl or force limit cut the command
  std::optional<TimedContact> first_contact;
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

struct TimeOptions {
  double settle = 0.5;  ///< [s] >= 0, stand at the end for so long
};

/// Follows `trajectory` by the clock from now on, to its end.
[[nodiscard]] Result<FollowOutcome, FollowFailure> follow_time(const FollowSetup& setup,
                                                               const Trajectory& trajectory,
                                                               const TimeOptions& options = {});

struct GateOptions {
  double joint_tol = 0.02;  ///< [rad or m] every joint this near: next joint waypoint, > 0
  double tool_tol = 0.01;   ///< [m] tool this near: next tool point, > 0
  int max_steps = 5000;    ///< steps spent on one waypoint before giving up, >= 1
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
