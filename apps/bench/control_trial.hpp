#pragma once

#include <string>
#include <vector>

#include "mjarm/control/controller.hpp"
#include "mjarm/execution/metrics.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm::app {

/// One lap of an ellipse: quintic in arc length from rest to rest, a new IK answer for every time
/// step.
struct LapOptions {
  Eigen::Vector3d center{0, -0.45, 0.4};  ///< [m] its plane is level, its tool points down
  double a = 0.3, b = 0.15;               ///< [m]
  double seconds = 10;                    ///< [s] of the lap, > 0
  double payload = 0;  ///< [kg] >= 0 at the tool, which the controller does not know
  ControlMode mode = ControlMode::computed_torque;
  ControlOptions control = {};
};

/// How a lap went.
struct LapResult {
  PathError error;         ///< of the tool against the ellipse, over the whole lap
  double second_half = 0;  ///< [m] worst distance from the ellipse from half way on
  double lag = 0;          ///< [m] worst distance of the tool from where it should be just then
  double peak_speed = 0;   ///< [m/s] of the tool, as asked for
  double peak_acceleration = 0;  ///< [rad/s^2] largest of any joint, as asked for
  double velocity_use = 0;       ///< largest share of a joint's velocity limit, as asked for
  long limited_steps = 0;        ///< in which a limit cut the command
  double rtf = 0;                ///< simulated seconds a second of wall clock, all in one thread
};
[[nodiscard]] Result<LapResult> drive_lap(const Model& model, const Arm& arm,
                                          const LapOptions& options = {});

/// Errors at rest, the worst over many poses.
struct RestResult {
  int poses = 0;
  PoseError worst;
};
/// Asks the arm to stand at each of `poses` random postures that touch nothing, from 0.05 rad
/// beside them; the errors are read after 2 s.
[[nodiscard]] Result<RestResult> rest_errors(const Model& model, const Arm& arm, ControlMode mode,
                                             int poses, std::uint64_t seed = 1);

}  // namespace mjarm::app
