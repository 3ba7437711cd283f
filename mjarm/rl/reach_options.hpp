#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "mjarm/core/result.hpp"

namespace mjarm::rl {

/// Where goals are drawn from, evenly by volume; only points that the arm can reach without
/// touching anything count (inverse kinematics is asked).
enum class ReachRegion {
  tutorial,  ///< 0.4 to 0.5 m from the start position of the tool, x > 0.2, 0.2 < z < 0.3,
             ///< within x -0.5 to 0.8, y -0.5 to 0.5
  wide,      ///< in front: x > 0.2, y -0.8 to 0.8, 0.05 < z < 1.0, at least 0.3 m from the z axis
};
/// "tutorial" or "wide".
[[nodiscard]] std::string_view name(ReachRegion region) noexcept;
/// The region of that name, or an error with the nearest one.
[[nodiscard]] Result<ReachRegion> reach_region(std::string_view name);

/// What an action of -1 to 1 a joint means. Gravity is fed forward in all of them.
enum class ReachAction {
  joint_delta,     ///< moves the joint's reference by so much of its greatest step
  joint_velocity,  ///< moves the joint at so much of its greatest speed, from where it is
  joint_position,  ///< where the reference goes, from the lower to the upper limit of the joint
  torque,          ///< torque beyond gravity, as a share of `ReachOptions::torque`
};
/// "joint_delta", "joint_velocity", "joint_position" or "torque".
[[nodiscard]] std::string_view name(ReachAction action) noexcept;
/// The action of that name, or an error with the nearest one.
[[nodiscard]] Result<ReachAction> reach_action(std::string_view name);

/// What the gripper does; it is never moved by actions.
enum class ReachGripper {
  open,      ///< held open, which simulates faster: its fingers touch nothing
  as_model,  ///< as the initial state of the model has it: closed, in the case of the Panda
};
/// "open" or "as_model".
[[nodiscard]] std::string_view name(ReachGripper gripper) noexcept;
/// The gripper setting of that name, or an error with the nearest one.
[[nodiscard]] Result<ReachGripper> reach_gripper(std::string_view name);

/// Weights of the reward of one step: with d the distance of the tool from the goal and t the turn
/// that the tool is off (both after the step),
///
///     coarse exp(-d / coarse_scale) + fine exp(-d / fine_scale) - distance d
///     - action mean(a^2) - collision [touching] - limit (joints near a limit, 0 to 1 each)
///     + turn_fine exp(-t / turn_scale) - turn t  // with `orientation`
struct ReachReward {
  double distance = 2;         ///< [1/m] >= 0
  double coarse = 0.5;         ///< >= 0
  double coarse_scale = 0.05;  ///< [m] > 0
  double fine = 0.5;           ///< >= 0
  double fine_scale = 0.005;   ///< [m] > 0
  double action = 0.01;        ///< >= 0
  double collision = 0.5;      ///< >= 0
  double limit = 0.1;          ///< >= 0
  double limit_margin = 0.05;  ///< [rad] from where on a joint counts as near a limit, > 0
  double turn = 0.3;           ///< [1/rad] >= 0
  double turn_fine = 0.5;      ///< >= 0
  double turn_scale = 0.1;     ///< [rad] > 0
};

/// The task: bring the tool to a goal and hold it there. Every default is usable as is.
struct ReachOptions {
  int environments = 16;  ///< worlds that are stepped together, 1 to 100000
  int threads = 1;        ///< that step them, 1 to 1024; results are the same for any number
  ReachRegion region = ReachRegion::tutorial;
  ReachAction action = ReachAction::joint_delta;
  ReachGripper gripper = ReachGripper::open;
  int frame_skip = 20;     ///< simulation steps an action, 1 to 10000; 20 of 2 ms: 25 Hz
  int episode_steps = 50;  ///< actions before an episode is cut, 1 to 1000000
  /// [rad] joints at the start, shape (dof,); default: the tutorial's. Empty: the home of the arm.
  std::vector<double> start = {0, -0.785398, 0, -2.356194, 0, 1.570796, 0.785398};
  double start_spread = 0;   ///< [rad] most that a joint may start away from there, 0 to 1
  double speed = 0.5;        ///< greatest speed of a joint, as a share of its limit, > 0 to 1
  double torque = 0.2;       ///< greatest torque beyond gravity, as a share of its limit, > 0 to 1
  bool orientation = false;  ///< the tool's z axis is to point down as well
  bool obstacle = false;     ///< a ball stands between start and goal; see reach_model()
  /// The environment of the tutorial, in which its checkpoints can be judged: `guide_options()`.
  bool guide = false;
  /// Goals and starts come from streams of random numbers that are never drawn from without this:
  /// for evaluation on what training has not seen.
  bool held_out = false;
  ReachReward reward = {};
};

/// The tutorial's own environment: observation = 7 joint angles [rad] and the goal [m], as they
/// are; action = joint targets, -1 to 1 from the lower to the upper limit of each joint, straight
/// into the servos without gravity; one simulation step an action, gripper closed. An episode ends
/// as terminated when the point 0.105 m out of the hand is within 5 mm of the goal, measured as the
/// tutorial does: at the positions before the step. After 2,000 steps it is cut (the tutorial: 20 s
/// of wall-clock time). The reward is ours.
/// `action`, `frame_skip`, `region`, `gripper`, `orientation`, `obstacle` must be as given here.
[[nodiscard]] ReachOptions guide_options();

}  // namespace mjarm::rl
