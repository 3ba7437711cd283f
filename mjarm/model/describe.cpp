#include "mjarm/model/describe.hpp"

#include <array>

#include "mjarm/model/arm_parts_internal.hpp"

namespace mjarm {
namespace {

std::string joint_type(int type) {
  switch (type) {
    case mjJNT_FREE:
      return "free";
    case mjJNT_BALL:
      return "ball";
    case mjJNT_SLIDE:
      return "slide";
    default:
      return "hinge";
  }
}

std::string geom_type(int type) {
  static constexpr std::array<const char*, 9> kTypeNames = {
      "plane", "hfield", "sphere", "capsule", "ellipsoid", "cylinder", "box", "mesh", "sdf"};
  return type >= 0 && type < static_cast<int>(kTypeNames.size()) ? kTypeNames[type] : "other";
}

/// What kind of object an actuator drives, as a word and as MuJoCo's type.
std::pair<std::string, mjtObj> transmission(int type) {
  switch (type) {
    case mjTRN_JOINT:
    case mjTRN_JOINTINPARENT:
      return {"joint", mjOBJ_JOINT};
    case mjTRN_TENDON:
      return {"tendon", mjOBJ_TENDON};
    case mjTRN_SITE:
    case mjTRN_SLIDERCRANK:
      return {"site", mjOBJ_SITE};
    case mjTRN_BODY:
      return {"body", mjOBJ_BODY};
    default:
      return {"other", mjOBJ_UNKNOWN};
  }
}

JointInfo describe_joint(const mjModel* m, int j) {
  JointInfo joint;
  joint.name = object_name(m, mjOBJ_JOINT, j);
  joint.type = joint_type(m->jnt_type[j]);
  joint.axis = Eigen::Vector3d(m->jnt_axis + 3 * j);
  joint.limited = m->jnt_limited[j] != 0;
  joint.lower = m->jnt_range[2 * j];
  joint.upper = m->jnt_range[2 * j + 1];
  joint.qpos = m->jnt_qposadr[j];
  joint.dof = m->jnt_dofadr[j];
  return joint;
}

BodyInfo describe_body(const mjModel* m, int b) {
  BodyInfo body;
  body.name = object_name(m, mjOBJ_BODY, b);
  body.parent = b == 0 ? -1 : m->body_parentid[b];
  body.mass = m->body_mass[b];
  body.is_mocap = m->body_mocapid[b] >= 0;
  for (int j = m->body_jntadr[b]; j < m->body_jntadr[b] + m->body_jntnum[b]; ++j) {
    body.joints.push_back(describe_joint(m, j));
  }
  for (int g = m->body_geomadr[b]; g < m->body_geomadr[b] + m->body_geomnum[b]; ++g) {
    body.geoms.push_back({.name = object_name(m, mjOBJ_GEOM, g),
                          .type = geom_type(m->geom_type[g]),
                          .collides = m->geom_contype[g] != 0 || m->geom_conaffinity[g] != 0,
                          .group = m->geom_group[g]});
  }
  return body;
}

ActuatorInfo actuator_info(const mjModel* m, int a) {
  ActuatorInfo actuator;
  actuator.name = object_name(m, mjOBJ_ACTUATOR, a);
  const auto [word, type] = transmission(m->actuator_trntype[a]);
  actuator.drives = word;
  if (type != mjOBJ_UNKNOWN) actuator.target = object_name(m, type, m->actuator_trnid[2 * a]);
  const int ctrl = m->actuator_ctrladr[a];
  actuator.ctrl = ctrl;
  if (m->actuator_ctrlnum[a] > 0) {
    actuator.ctrl_limited = m->actuator_ctrllimited[ctrl] != 0;
    actuator.ctrl_lower = m->actuator_ctrlrange[2 * ctrl];
    actuator.ctrl_upper = m->actuator_ctrlrange[2 * ctrl + 1];
  }
  actuator.force_limited = m->actuator_forcelimited[a] != 0;
  actuator.force_lower = m->actuator_forcerange[2 * a];
  actuator.force_upper = m->actuator_forcerange[2 * a + 1];
  return actuator;
}

std::vector<std::string> names_of(const mjModel* m, mjtObj type, mjtSize count) {
  std::vector<std::string> names;
  for (int i = 0; i < count; ++i) names.push_back(object_name(m, type, i));
  return names;
}

void describe_frames(const mjModel* m, ModelInfo& info) {
  for (int s = 0; s < m->nsite; ++s) {
    const std::string body = object_name(m, mjOBJ_BODY, m->site_bodyid[s]);
    info.bodies[m->site_bodyid[s]].sites.push_back(object_name(m, mjOBJ_SITE, s));
    if (const char* name = mj_id2name(m, mjOBJ_SITE, s)) info.frames.push_back({name, true, body});
  }
  for (int b = 1; b < m->nbody; ++b) {
    if (const char* name = mj_id2name(m, mjOBJ_BODY, b)) info.frames.push_back({name, false, name});
  }
}

}  // namespace

ModelInfo describe(const Model& model) {
  const mjModel* m = model.raw();
  ModelInfo info;
  info.name = model.name();
  info.timestep = model.timestep();
  info.gravity = Eigen::Vector3d(m->opt.gravity);
  info.mass = m->body_subtreemass[0];
  for (int b = 0; b < m->nbody; ++b) {
    info.bodies.push_back(describe_body(m, b));
    if (b > 0) info.bodies[b].depth = info.bodies[m->body_parentid[b]].depth + 1;
  }
  describe_frames(m, info);
  for (int a = 0; a < m->nactuator; ++a) info.actuators.push_back(actuator_info(m, a));
  for (int k = 0; k < m->nkey; ++k) {
    const double* qpos = m->key_qpos + k * m->nq;
    info.keyframes.push_back({object_name(m, mjOBJ_KEY, k), {qpos, qpos + m->nq}});
  }
  info.sensors = names_of(m, mjOBJ_SENSOR, m->nsensor);
  info.cameras = names_of(m, mjOBJ_CAMERA, m->ncam);
  info.meshes = static_cast<int>(m->nmesh);
  return info;
}

}  // namespace mjarm
