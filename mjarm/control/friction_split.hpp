#pragma once

namespace mjarm {

/// Tells the load of one joint, which changes slowly, from its dry friction, which turns with the
/// motion: a Kalman filter of the two numbers with what disturbs the joint as its measurement,
///   disturbance = load - friction * s,   s in [-1, 1] the direction of motion,
/// so that one reversal says how much of it is friction. All figures are relative to `scale`.
class FrictionSplit {
 public:
  /// @param scale  [N m or N] > 0, the largest torque of the joint.
  explicit FrictionSplit(double scale);

  /// The load may have changed since: once a step.
  /// @param timestep  [s]
  void drift(double timestep);
  /// @param disturbance  [N m or N] as it is measured in this step, the joint moving.
  /// @param s            direction of motion, as slow as that measurement.
  /// @return by how much the friction is now taken to be larger than before.
  double measure(double disturbance, double s, double timestep);

  [[nodiscard]] double friction() const noexcept { return friction_; }  ///< [N m or N] >= 0
  [[nodiscard]] double load() const noexcept { return load_; }          ///< [N m or N]

 private:
  double scale_;
  double load_ = 0, friction_ = 0;
  double p_ll_, p_lf_ = 0, p_ff_;  ///< covariance [N^2 m^2 or N^2]
};

}  // namespace mjarm
