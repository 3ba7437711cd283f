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

/// Adds what actuators contribute to the damping of their joints; reflected through the gear.
void add_actuator_damping(const mjModel& m, std::vector<double>& damping) {
  for (int i = 0; i < m.nactuator; ++i) {
    const bool on_joint =
        m.actuator_trntype[i] == mjTRN_JOINT || m.actuator_trntype[i] == mjTRN_JOINTINPARENT;
    if (!on_joint || m.actuator_damping[i] == 0) continue;
    const int joint = m.actuator_trnid[2 * i];
    if (m.jnt_type[joint] != mjJNT_HINGE && m.jnt_type[joint] != mjJNT_SLIDE) continue;
    const double gear = m.actuator_gear[6 * m.actuator_outadr[i]];
    damping[m.jnt_dofadr[joint]] += gear * gear * m.actuator_damping[i];
  }
}

}  // namespace

StepRule step_rule(const Model& model) {
  const mjModel& m = *model.raw();
  StepRule rule;
  rule.integrator = integrator_of(m);
  rule.timestep = m.opt.timestep;
  rule.implicit_damping = damping_is_implicit(m);
  rule.damping.assign(m.dof_damping, m.dof_damping + m.nv);
  add_actuator_damping(m, rule.damping);
  rule.stiffness.assign(m.nv, 0);
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
