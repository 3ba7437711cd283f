#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "mjarm/control/controller.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/payload.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/path/ellipse.hpp"
#include "mjarm/sim/imperfect_drives.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm::app {

/// Steps of control by which commands are late in all worlds: 4 ms of the shipped robots.
inline constexpr int kRobustLate = DriveFaults{}.late_steps;

inline constexpr int kRobustSubsteps = 4;  ///< of the simulation in a step of control

/// The same motion for every world: laps of an ellipse at constant speed, as positions of the
/// joints at every step of control.
struct RobustLaps {
  Robot robot;  ///< as the controller knows it: with its load, driven by torque
  Ellipse ellipse;
  double around = 0;               ///< [m] its length
  std::vector<JointVec> q = {};    ///< at the start of each step
  std::vector<double> s = {};      ///< [m] how far along the laps the tool shall be then
  std::vector<double> theta = {};  ///< [rad] the same as an angle of the ellipse
  std::size_t end = 0;             ///< step in which the last lap ends
};

/// Before the laps every joint goes to and fro once by 0.6 deg, and rests; after them the arm
/// rests for a second.
/// @return an error where the ellipse cannot be reached.
[[nodiscard]] Result<RobustLaps> robust_laps(const Robot& robot);

/// The robot as its controller knows it: with the load that it should have, driven by torque.
[[nodiscard]] Result<Robot> known_robot(const Robot& robot);
/// The true arm: `bare` with wrong links and friction, and a wrong load, in kRobustSubsteps steps a
/// step of control.
[[nodiscard]] Result<Model> draw_wrong_world(const Robot& bare, Rng& rng);
/// Every joint to and fro once about `q` by 0.6 deg, then a rest: positions at every step.
[[nodiscard]] std::vector<JointVec> warm_up_at(const JointVec& q, double timestep);

/// What is driven, and how.
struct WrongDrive {
  const Robot& known;           ///< known_robot() of `bare`
  const Robot& bare;            ///< as it was loaded
  std::span<const JointVec> q;  ///< positions at every step of control
  ControlMode mode = ControlMode::robust;
  ControlOptions control = {};
  bool loaded = true;  ///< the world has its payload
};
/// The true arm of a world.
struct WrongArm {
  Model empty;      ///< wrong links and friction
  Payload payload;  ///< what hangs at the tool beside them
};
[[nodiscard]] Result<WrongArm> draw_wrong_arm(const Robot& bare, std::uint64_t seed,
                                              std::uint64_t world);
/// A step of control that was done.
struct WrongStep {
  std::size_t index = 0;  ///< in WrongDrive::q, of where the arm should be now
  double torque_use = 0;  ///< largest command over the torque limit of its joint
  bool limited = false;   ///< a limit cut the command
  JointVec q = {};        ///< [rad] (dof,) what the encoders said before it
  JointVec torque = {};   ///< [N m] (dof,) the command
};
using AfterWrongStep = std::function<void(const Sim& sim, const WrongStep& step)>;
/// Drives in a world that is drawn by `seed` and `world`: payload and links of other masses with
/// other centres, dry friction; encoders, drives and delay as DriveFaults has them.
/// @return the controller as it is in the end.
[[nodiscard]] Result<Controller> drive_references(const WrongDrive& drive, std::uint64_t seed,
                                                  std::uint64_t world, const AfterWrongStep& after);

/// How the laps went in one wrong world.
struct RobustWorld {
  double first_quarter = 0;   ///< [m] worst distance of the tool from the ellipse, in that of lap 1
  double max = 0;             ///< [m] the same in all that follows
  double lag = 0;             ///< [m] worst distance from where the tool should be just then
  double ripple = 0;          ///< [m] rms of what changes within 0.1 s of that deviation
  double rest = 0;            ///< [m] how far the tool moves in the last half second, at rest
  double torque_use = 0;      ///< largest command over the torque limit of the joint
  long limited_steps = 0;     ///< in which a limit cut the command
  double friction = 0;        ///< worst error of a learned friction over the true one; 1: none
  std::vector<double> error;  ///< [m] distance from the ellipse at every step
};

/// The laps in one world of drive_references().
/// @param control  `robust` knows by how many steps commands are late, and nothing else.
[[nodiscard]] Result<RobustWorld> drive_wrong_world(const RobustLaps& laps, const Robot& bare,
                                                    ControlMode mode, const ControlOptions& control,
                                                    std::uint64_t seed, std::uint64_t world);

}  // namespace mjarm::app
