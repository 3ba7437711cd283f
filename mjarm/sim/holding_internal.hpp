#pragma once

#include <mujoco/mujoco.h>

#include <span>
#include <vector>

#include "mjarm/model/arm.hpp"
#include "mjarm/model/held_joints.hpp"
#include "mjarm/model/step_rule.hpp"

namespace mjarm {

/// Keeps joints of a world where they stood when it was last put somewhere: as a clamp would, while
/// all else of their robots moves. Of every step it asks the force that takes each of them back to
/// its place, with what the arm's motion does to them, and leaves it to their actuators within
/// their limits. Joints without one get the force itself and are too heavy for contacts and pushes
/// to move them: they are locked.
///
/// The rows of the step's equation (StepInverse) that belong to the robots with held joints are
/// solved for that force: free dofs f accelerate as their forces make them, held dofs h as asked.
/// Exact as StepInverse; what it leaves out (contacts, constraints, pushes) is corrected in the
/// steps that follow.
class Holding {
 public:
  Holding(const Model& model, const Arm& arm);

  /// The joints stay where they are in `qpos` (nq,).
  void stand(std::span<const double> qpos);
  /// Sets ctrl and applied forces of the held joints for the step that comes; positions, velocities
  /// and the ctrl of all others are up to date.
  void hold(const mjModel& m, mjData& d);
  /// Takes down how far the joints are off their places.
  void measure(const mjModel& m, const mjData& d);

  /// Makes a model heavy where joints are locked. What stands on a base that is clamped so, with
  /// held joints between at most, no longer collides with the ground: wheels that are sunk in it
  /// would lift the base.
  void clamp(mjModel& m) const;

  [[nodiscard]] std::span<const HeldJoint> joints() const { return joints_; }
  [[nodiscard]] std::span<const double> place() const { return place_; }
  /// [rad or m] the largest so far, of any dof of each joint.
  [[nodiscard]] std::span<const double> moved() const { return moved_; }

 private:
  void collect_dofs(const mjModel& m);
  void add_mass(const StepRule& rule, int dof, double damping,
                const std::optional<ArmActuator>& actuator);
  /// Force [N m or N] on each held dof that gives them the accelerations `a_h`.
  [[nodiscard]] Eigen::VectorXd force(const mjModel& m, mjData& d, const Eigen::VectorXd& a_h);

  std::vector<HeldJoint> joints_;
  std::vector<int> held_, free_;   ///< dofs of the robots with held joints
  Eigen::VectorXd implicit_mass_;  ///< (nv,) that the integrator adds to the diagonal of M
  Eigen::MatrixXd mass_;           ///< nv x nv scratch
  Eigen::VectorXd gap_;            ///< (nv,) [rad or m] from where the model is to its place
  std::vector<double> place_;      ///< (nq,)
  std::vector<double> moved_;
};

}  // namespace mjarm
