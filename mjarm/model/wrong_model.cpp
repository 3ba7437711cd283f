#include "mjarm/model/wrong_model.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "mjarm/core/messages/model.hpp"
#include "mjarm/model/arm_parts_internal.hpp"
#include "mjarm/model/load_internal.hpp"

namespace mjarm {
namespace {

/// Impedance of dry friction within its bound: nearly rigid.
constexpr double kRigid = 0.99;

void change_body(mjModel& m, int body, const ModelErrors& errors, Rng& rng) {
  const double factor = 1 + errors.mass * rng.uniform(-1, 1);
  const Eigen::Vector3d way(rng.normal(), rng.normal(), rng.normal());
  if (!(m.body_mass[body] > 0)) return;
  m.body_mass[body] *= factor;
  Eigen::Map<Eigen::Vector3d>(m.body_inertia + 3 * body) *= factor;
  Eigen::Map<Eigen::Vector3d>(m.body_ipos + 3 * body) += errors.center * way.normalized();
  m.body_sameframe[body] = mjSAMEFRAME_NONE;
  m.body_simple[body] = 0;
}

}  // namespace

Result<Model> wrong_model(const Model& model, const Arm& arm, const ModelErrors& errors, Rng& rng) {
  const bool usable = errors.mass >= 0 && errors.mass < 1 && errors.center >= 0 &&
                      errors.friction >= 0 && std::isfinite(errors.center + errors.friction);
  if (!usable) {
    return fail(Errc::bad_input,
                text(msg::model_bad_errors, errors.mass, errors.center, errors.friction));
  }
  const MjModelPtr m(mj_copyModel(nullptr, model.raw()));
  const int first = m->dof_bodyid[arm.joints.front().dof];
  for (int body = first; body < m->nbody; ++body) {
    if (hangs_on(m.get(), body, first)) change_body(*m, body, errors, rng);
  }
  for (int i = 0; errors.friction > 0 && i < arm.dof(); ++i) {
    const std::ptrdiff_t dof = arm.joints[i].dof;
    m->dof_frictionloss[dof] = errors.friction * arm.limits.torque[i];
    mjtNum* const solref = m->dof_solref + mjNREF * dof;
    solref[0] = 2 * m->opt.timestep;
    solref[1] = 1;
    mjtNum* const solimp = m->dof_solimp + mjNIMP * dof;
    solimp[0] = solimp[1] = kRigid;
  }
  const MjDataPtr data(mj_makeData(m.get()));
  mj_setConst(m.get(), data.get());
  return Model::copy_of(m.get());
}

Robot with_torque_drives(const Robot& robot) {
  const MjModelPtr m(mj_copyModel(nullptr, robot.model.raw()));
  Arm arm = robot.arm;
  for (ArmJoint& joint : arm.joints) {
    if (!joint.actuator) continue;
    ArmActuator& actuator = *joint.actuator;
    const std::ptrdiff_t id = actuator.id;
    std::fill_n(m->actuator_gainprm + mjNGAIN * id, mjNGAIN, 0.0);
    std::fill_n(m->actuator_biasprm + mjNBIAS * id, mjNBIAS, 0.0);
    m->actuator_gainprm[mjNGAIN * id] = actuator.gain = 1;
    std::ranges::fill(actuator.bias, 0.0);
    m->actuator_gaintype[id] = mjGAIN_FIXED;
    m->actuator_biastype[id] = mjBIAS_NONE;
    m->actuator_ctrllimited[id] = 0;
    actuator.ctrl_lower = -std::numeric_limits<double>::infinity();
    actuator.ctrl_upper = std::numeric_limits<double>::infinity();
  }
  return {Model::copy_of(m.get()), std::move(arm)};
}

}  // namespace mjarm
