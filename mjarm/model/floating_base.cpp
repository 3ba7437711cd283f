#include "mjarm/model/floating_base.hpp"

#include <mujoco/mujoco.h>

#include "mjarm/model/arm_parts_internal.hpp"

namespace mjarm {

std::optional<std::string> floating_base(const Model& model, const Arm& arm) {
  const mjModel* m = model.raw();
  const int base = m->body_rootid[m->dof_bodyid[arm.joints.front().dof]];
  const bool floats = m->body_jntnum[base] > 0 && m->jnt_type[m->body_jntadr[base]] == mjJNT_FREE;
  return floats ? std::optional(object_name(m, mjOBJ_BODY, base)) : std::nullopt;
}

}  // namespace mjarm
