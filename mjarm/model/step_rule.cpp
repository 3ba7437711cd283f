#include "mjarm/model/step_rule.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>

namespace mjarm {
namespace {

Integrator integrator_of(const mjModel& m) {
  switch (m.opt.integrator) {
    case mjINT_RK4:
      return Integrator::rk4;
    case mjINT_IMPLICIT:
      return Integrator::implicit;
    case mjINT_IMPLICITFAST:
      return Integrator::implicitfast;
    case mjINT_DISCRETE:
      return Integrator::discrete;
    default:
      return Integrator::euler;
  }
}

bool damping_is_implicit(const mjModel& m) {
  if ((m.opt.disableflags & mjDSBL_DAMPER) != 0) return false;
  switch (m.opt.integrator) {
    case mjINT_RK4:
      return false;
    case mjINT_EULER:
      return (m.opt.disableflags & mjDSBL_EULERDAMP) == 0;
    default:
      return true;
  }
}

DryFriction friction_of(const mjModel& m, int dof) {
  constexpr int kOff = mjDSBL_FRICTIONLOSS | mjDSBL_CONSTRAINT;
  DryFriction friction;
  if ((m.opt.disableflags & kOff) != 0 || !(m.dof_frictionloss[dof] > 0)) return friction;
  friction.max = m.dof_frictionloss[dof];
  const mjtNum* reference = m.dof_solref + mjNREF * dof;
  const mjtNum* impedance = m.dof_solimp + mjNIMP * dof;
  const double max = std::clamp(impedance[1], mjMINIMP, mjMAXIMP);
  if (reference[0] > 0) {
    const bool safe = (m.opt.disableflags & mjDSBL_REFSAFE) == 0;
    const double time = safe ? std::max(reference[0], 2 * m.opt.timestep) : reference[0];
    friction.damping = 2 / std::max(mjMINVAL, max * time);
  } else {
    friction.damping = -reference[1] / std::max(mjMINVAL, max);
  }
  const double share = std::clamp(impedance[0], mjMINIMP, mjMAXIMP);
  friction.mass = 1 / std::max(mjMINVAL, (1 - share) / share * m.dof_invweight0[dof]);
  return friction;
}

}  // namespace

StepRule step_rule(const Model& model) {
  const mjModel& m = *model.raw();
  StepRule rule;
  rule.integrator = integrator_of(m);
  rule.timestep = m.opt.timestep;
  rule.implicit_damping = damping_is_implicit(m);
  for (int i = 0; i < m.nv; ++i) rule.friction.push_back(friction_of(m, i));
  rule.stiffness.assign(static_cast<std::size_t>(m.nv), 0.0);
  if ((m.opt.disableflags & mjDSBL_SPRING) == 0) {
    for (int i = 0; i < m.njnt; ++i) {
      if (m.jnt_type[i] == mjJNT_HINGE || m.jnt_type[i] == mjJNT_SLIDE) {
        rule.stiffness[m.jnt_dofadr[i]] = m.jnt_stiffness[i];
      }
    }
  }
  return rule;
}

}  // namespace mjarm
