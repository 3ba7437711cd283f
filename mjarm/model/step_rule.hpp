#pragma once

#include <vector>

#include "mjarm/model/model.hpp"

namespace mjarm {

/// How the velocity is advanced over one time step.
enum class Integrator {
  euler,         ///< semi-implicit; joint damping implicit unless the model says otherwise
  rk4,           ///< Runge-Kutta of fourth order, everything explicit
  implicit,      ///< implicit in the velocity, with Coriolis terms
  implicitfast,  ///< implicit in the velocity, without Coriolis terms
  discrete,      ///< implicit in velocity and position
};

/// Dry friction of a joint as MuJoCo's soft constraint: against the velocity v it pulls the
/// acceleration a towards -damping v with the force mass (a + damping v), at most `max`
/// (Computation, Constraint model, "Friction loss"; Solver parameters).
struct DryFriction {
  double max = 0;      ///< [N m or N] >= 0; 0 = none
  double damping = 0;  ///< [1/s]
  double mass = 0;     ///< [kg m^2 or kg] inverse of the regularisation
};

/// What a model says about its time step, as far as it decides which force gives which velocity at
/// the end of the step. Linear terms only: polynomial damping and stiffness, fluids and tendons
/// count as explicit forces.
struct StepRule {
  Integrator integrator = Integrator::euler;
  double timestep = 0;           ///< [s] > 0
  bool implicit_damping = true;  ///< joint damping is taken at the end of the step
  std::vector<double> damping;  ///< (nv,) [N m s/rad or N s/m] of the joints, with their actuators'
  std::vector<DryFriction> friction;  ///< (nv,)
  std::vector<double> stiffness;      ///< (nv,) [N m/rad or N/m] springs of hinge and slide joints
};

[[nodiscard]] StepRule step_rule(const Model& model);

}  // namespace mjarm
