#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "mjarm/core/rng.hpp"
#include "mjarm/model/arm.hpp"

namespace mjarm {

/// What stands between a controller and an arm.
struct DriveFaults {
  double encoder_step = 1.7453292519943295e-4;  ///< [rad or m] >= 0; 0.01 deg; 0 = none
  double noise = 0.01;  ///< >= 0, standard deviation of a torque over that torque, new every step
  int late_steps = 2;   ///< >= 0, steps of control from a command to when it acts
};

/// Encoders with steps, and drives that take torques late and give them with noise. Between a
/// controller and a simulation whose arm is driven by torque (with_torque_drives).
class ImperfectDrives {
 public:
  /// @param timestep  [s] of the controller, > 0
  ImperfectDrives(const Arm& arm, const DriveFaults& faults, double timestep, const Rng& rng);

  /// Reads the encoders; once a step of control. The arm's velocities are differences of what they
  /// said; all else is as it is.
  void read(std::span<const double> qpos, std::span<const double> qvel);
  [[nodiscard]] std::span<const double> qpos() const noexcept { return qpos_; }
  [[nodiscard]] std::span<const double> qvel() const noexcept { return qvel_; }
  /// Takes this command, and puts in its place what the drives do in this step. The first command
  /// is taken to have been given before as well.
  void pass(std::span<double> ctrl);

 private:
  Arm arm_;
  DriveFaults faults_;
  double h_;
  Rng rng_;
  std::vector<double> qpos_, qvel_;
  std::deque<JointVec> commands_;
};

}  // namespace mjarm
