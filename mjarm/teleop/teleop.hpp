#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "mjarm/collision/exact_watch.hpp"
#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm {

/// In which axes a tool is led.
enum class TwistFrame {
  tool,   ///< its own
  world,  ///< those of the world, about the tool's origin
};
/// "tool" or "world".
[[nodiscard]] std::string_view name(TwistFrame frame) noexcept;

/// What somebody asks of an arm at one time. What is not finite counts as zero.
struct TeleopInput {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();   ///< [m/s] of the tool's origin
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  ///< [rad/s] of the tool
  TwistFrame frame = TwistFrame::world;               ///< of both
  double grip = 0;  ///< [1/s] how fast the gripper closes; negative: opens
  /// 0 open to 1 closed: where it goes instead, at TeleopOptions::grip_speed.
  std::optional<double> grip_to = {};
};

/// How an arm is led. Every default is usable as is.
struct TeleopOptions {
  double period = 4e-3;         ///< [s] of control, > 0; rounded to whole time steps
  double speed = 0.25;          ///< [m/s] the fastest that the tool goes, > 0
  double turn = 1;              ///< [rad/s] likewise
  double grip_speed = 2;        ///< [1/s] of the gripper's way, likewise
  double velocity_share = 0.5;  ///< of the joints' velocity limits, in (0, 1]
  /// Of the joints' acceleration limits, in (0, 1]; the arm starts and brakes with it.
  double acceleration_share = 0.5;
  /// [mixed units] Where the smallest singular value of the tool's Jacobian is below this and
  /// would get less, speed goes down in proportion, to a tenth at most.
  double near_singular = 0.05;
  WatchOptions watch = {};
  bool guard = true;  ///< never closer to anything than the margins of `watch`
};

/// What makes an arm slower than asked.
enum class TeleopLimit {
  none,
  joint_range,  ///< it could not stop before the end of a joint's range
  joint_speed,  ///< a joint is as fast as it may be
  singularity,  ///< TeleopOptions::near_singular
  near,         ///< it could not stop before something else
  pushed,       ///< a thing that it touches keeps it 0.02 rad or 2 cm off where it is led
};

/// How it goes, after a period.
struct TeleopState {
  double scale = 1;  ///< share of the speed that was asked for
  TeleopLimit limit = TeleopLimit::none;
  std::string joint = {};               ///< joint_range, joint_speed: its name
  std::optional<NearBodies> near = {};  ///< near: the two; else the nearest within 0.1 m, if any
  double grip = 0;                      ///< 0 open to 1 closed, as commanded
  std::string held = {};                ///< body between the fingers; empty: none
};

/// All that decides what comes next, of world and Teleop.
struct TeleopMoment {
  Snapshot world;
  JointVec q, v;    ///< (dof,) [rad or m], [rad/s or m/s] where the arm is led
  Pose X_WT;        ///< of the tool there
  double grip = 0;  ///< as TeleopState::grip
  double allowed = 1;
  int held = -1;
};

/// Leads the arm of a simulation by velocities of its tool, one period of control at a time:
/// Tracker turns them into joint velocities; these change no faster than the joints may accelerate;
/// and a period is begun only if the arm can be stopped after it, along a straight way in joint
/// space with every joint's braking, within the ranges of the joints and, by SceneWatch, away from
/// everything. Else it is slower, at the least as slow as braking makes it, which was proved in the
/// period before: so the arm never touches anything that stands, as long as it follows its
/// reference (SceneWatch::take() allows for what it is off). Where a thing that it pushes keeps it
/// off by 0.02 rad or 2 cm, the reference stops and comes after it where that is free, and the
/// gripper waits. What is proved of a stop is known from failsafe manoeuvres of vehicles (S. Petti
/// and T. Fraichard, IROS 2005). The same inputs give the same simulation, to the last bit.
class Teleop {
 public:
  /// @return bad_input for options out of range; not_available where the arm's actuators cannot be
  /// used, or SceneWatch::create() fails.
  [[nodiscard]] static Result<Teleop> create(const Robot& robot, const TeleopOptions& options = {});
  ~Teleop();
  Teleop(Teleop&&) noexcept;
  Teleop& operator=(Teleop&&) noexcept;

  /// Takes the arm over where it stands in `sim`, at rest. To be called first, and whenever the
  /// world was put somewhere.
  /// @param sim  of the robot's model.
  void begin(Sim& sim);
  /// One period: plans it, and makes its steps.
  /// @return an error where the simulation broke down.
  [[nodiscard]] Result<void> advance(Sim& sim, const TeleopInput& input);

  [[nodiscard]] TeleopState state() const;
  [[nodiscard]] double period() const noexcept;  ///< [s] of whole time steps
  /// (dof,) [rad or m] Where the arm is led.
  [[nodiscard]] const JointVec& reference() const noexcept;

  [[nodiscard]] TeleopMoment moment(const Sim& sim) const;
  /// Goes on from there.
  /// @return an error where it is of another model.
  [[nodiscard]] Result<void> go_to(Sim& sim, const TeleopMoment& moment);

 private:
  struct Impl;
  explicit Teleop(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace mjarm
