#include "mjarm/model/step_rule.hpp"

#include <mujoco/mujoco.h>

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

}  // namespace

StepRule step_rule(const Model& model) {
  const mjModel& m = *model.raw();
  StepRule rule;
  rule.integrator = integrator_of(m);
  rule.timestep = m.opt.timestep;
  rule.implicit_damping = damping_is_implicit(m);
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
