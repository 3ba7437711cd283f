#pragma once

#include <span>
#include <vector>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/dynamics.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/model/step_rule.hpp"

namespace mjarm {

/// Which torque gives which acceleration over one time step. Owns its scratch memory: one a thread.
///
/// A step takes the velocity from v to v + h a with (M + h D) a = torque + passive - bias, where D
/// is the part of the damping that the integrator takes at the end of the step (MuJoCo
/// documentation, Computation, "Numerical integration"): joint damping for Euler; also the
/// actuators' velocity gains for implicitfast; also the derivative of the Coriolis forces for
/// implicit. `discrete` has h^2 K beside it and -h K v on the right, K the position gains.
/// The arm's rows of this equation, with every joint outside the arm held as it moves, give the
/// torque. Exact without contact, where no limit cuts the command; for RK4 to first order in h. Dry
/// friction is inverted as MuJoCo models it (see DryFriction).
class StepInverse {
 public:
  StepInverse(const Model& model, const Arm& arm);

  /// Joint torque, shape (dof,) [N m or N], that the arm's actuators must give at the start of the
  /// step so that the velocity changes by timestep * `a`.
  /// @param qpos, qvel  full state of the model, (nq,) and (nv,).
  /// @param a           [rad/s^2 or m/s^2] shape (dof,).
  [[nodiscard]] JointVec torque(std::span<const double> qpos, std::span<const double> qvel,
                                const JointVec& a);

  /// Joint torque that keeps the arm still at `qpos` against gravity and springs, (dof,).
  [[nodiscard]] JointVec holding_torque(std::span<const double> qpos);

  /// (dof,) [kg m^2 or kg] What the integrator adds to the diagonal of the mass matrix.
  [[nodiscard]] const JointVec& implicit_mass() const noexcept { return mass_; }
  /// The arm's part of the mass matrix, (dof, dof) [kg m^2].
  [[nodiscard]] Eigen::MatrixXd mass_matrix(std::span<const double> qpos);

  [[nodiscard]] double timestep() const noexcept { return rule_.timestep; }

 private:
  /// Arm's rows of (dc/dv) h a, where c are the Coriolis and centrifugal forces.
  JointVec coriolis_change(std::span<const double> qpos, std::span<const double> qvel,
                           const JointVec& a);
  /// Torque (dof,) that makes up for dry friction at velocity `v`, where `implicit` is what the
  /// integrator needs beside the explicit torque.
  JointVec friction(std::span<const double> qpos, const JointVec& v, const JointVec& a,
                    const JointVec& implicit);
  [[nodiscard]] JointVec rows(const Eigen::VectorXd& full) const;

  StepRule rule_;
  Dynamics dynamics_;
  std::vector<int> dof_;      ///< the arm's rows of the full vectors
  JointVec mass_;             ///< diagonal that the integrator adds to M
  JointVec stiffness_;        ///< K of `discrete`, else 0
  std::vector<double> full_;  ///< (nv,) scratch
  std::vector<double> rest_;  ///< (nv,) zeros
};

}  // namespace mjarm
