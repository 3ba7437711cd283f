#pragma once

#include <span>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/rl/reach_options.hpp"

namespace mjarm::rl {

/// What is known of one world when an action begins.
struct DriveState {
  std::span<const double> qpos;  ///< (nq,)
  std::span<const double> qvel;  ///< (nv,)
  std::span<const double> bias;  ///< (nv,) gravity, Coriolis and centrifugal torque
};

/// Turns actions into commands of the arm's own actuators. The reference of a joint moves at an
/// even speed from where it was to where the action wants it; the command is what the servo needs
/// in the middle of that way: it neither sags under gravity nor lags behind.
class ReachDrive {
 public:
  /// @param period  [s] that an action lasts.
  /// @return an error that names the joint that cannot be driven so.
  [[nodiscard]] static Result<ReachDrive> create(const Arm& arm, const ReachOptions& options,
                                                 double period);

  /// @param actions    (dof,), finite; clamped to -1 to 1
  /// @param reference  [rad or m] (dof,) where the joints should be by now, moved on
  /// @param ctrl       (nu,), the arm's rows are written
  void command(std::span<const float> actions, const DriveState& now, std::span<double> reference,
               std::span<double> ctrl) const;
  /// The commands that hold the arm at `q` (dof,), at rest.
  void hold(std::span<const double> q, std::span<const double> bias, std::span<double> ctrl) const;

  /// Whether the command has to follow the state in every simulation step.
  [[nodiscard]] bool every_step() const { return action_ == ReachAction::torque; }
  [[nodiscard]] const JointVec& lower() const { return lower_; }  ///< pi for joints without stops
  [[nodiscard]] const JointVec& upper() const { return upper_; }
  [[nodiscard]] const JointVec& speed() const { return speed_; }  ///< [rad/s or m/s] the greatest

 private:
  [[nodiscard]] double next(int joint, double action, double q, double reference) const;
  [[nodiscard]] double ctrl(int joint, double bias, double q, double v) const;

  Arm arm_;
  ReachAction action_ = ReachAction::joint_delta;
  bool guide_ = false;
  double period_ = 0;
  JointVec lower_, upper_, speed_, torque_;
};

}  // namespace mjarm::rl
