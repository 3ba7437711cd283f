#include "mjarm/model/force_sensor.hpp"

#include "mjarm/model/arm_parts_internal.hpp"
#include "mjarm/model/find_arm.hpp"

namespace mjarm {

std::optional<ForceSensor> find_force_sensor(const Model& model, const Arm& arm) {
  const mjModel* m = model.raw();
  const int last = m->body_weldid[m->dof_bodyid[arm.joints.back().dof]];
  for (int i = 0; i < m->nsensor; ++i) {
    if (m->sensor_type[i] != mjSENS_FORCE) continue;
    const int site = m->sensor_objid[i];
    if (m->body_weldid[m->site_bodyid[site]] != last) continue;
    const std::string frame = object_name(m, mjOBJ_SITE, site);
    const Result<Pose> X_WS = frame_pose(model, frame), X_WT = frame_pose(model, arm.tip);
    if (!X_WS || !X_WT) continue;
    return ForceSensor{object_name(m, mjOBJ_SENSOR, i), static_cast<std::size_t>(m->sensor_adr[i]),
                       X_WT->R.transpose() * X_WS->R};
  }
  return std::nullopt;
}

}  // namespace mjarm
