#include "mjarm/model/inventory.hpp"

#include <mujoco/mujoco.h>

#include <limits>

#include "mjarm/core/os.hpp"

namespace mjarm {
namespace {

std::string name_of(const mjModel* m, mjtObj type, int id) {
  const char* name = id < 0 ? nullptr : mj_id2name(m, type, id);
  return name == nullptr ? std::string() : std::string(name);
}

JointEntry joint_entry(const mjModel* m, int id) {
  constexpr const char* kTypes[] = {"free", "ball", "slide", "hinge"};
  JointEntry joint;
  joint.name = name_of(m, mjOBJ_JOINT, id);
  joint.type = kTypes[m->jnt_type[id]];
  joint.limited = m->jnt_limited[id] != 0;
  joint.force_limited = m->jnt_actfrclimited[id] != 0;
  for (int i = 0; i < m->nactuator; ++i) {
    const bool drives = m->actuator_trntype[i] == mjTRN_JOINT && m->actuator_trnid[2 * i] == id;
    joint.force_limited |= drives && m->actuator_forcelimited[i] != 0;
  }
  if (joint.limited) {
    joint.lower = m->jnt_range[2 * id];
    joint.upper = m->jnt_range[2 * id + 1];
  }
  return joint;
}

std::vector<BodyEntry> body_entries(const mjModel* m) {
  std::vector<BodyEntry> bodies(static_cast<std::size_t>(m->nbody));
  for (int i = 0; i < m->nbody; ++i) {
    BodyEntry& body = bodies[static_cast<std::size_t>(i)];
    body.name = name_of(m, mjOBJ_BODY, i);
    body.parent = m->body_parentid[i];
    body.depth = i == 0 ? 0 : bodies[static_cast<std::size_t>(body.parent)].depth + 1;
    body.mass = m->body_mass[i];
    body.geoms = m->body_geomnum[i];
    for (int k = 0; k < body.geoms; ++k) {
      const int geom = m->body_geomadr[i] + k;
      body.colliding += m->geom_contype[geom] != 0 || m->geom_conaffinity[geom] != 0;
    }
    for (int k = 0; k < m->body_jntnum[i]; ++k) {
      body.joints.push_back(joint_entry(m, m->body_jntadr[i] + k));
    }
  }
  for (int i = 0; i < m->nsite; ++i) {
    bodies[static_cast<std::size_t>(m->site_bodyid[i])].sites.push_back(name_of(m, mjOBJ_SITE, i));
  }
  return bodies;
}

/// What kind of element an actuator's transmission acts on.
mjtObj target_type(int transmission) {
  switch (transmission) {
    case mjTRN_JOINT:
    case mjTRN_JOINTINPARENT:
      return mjOBJ_JOINT;
    case mjTRN_TENDON:
      return mjOBJ_TENDON;
    case mjTRN_BODY:
      return mjOBJ_BODY;
    default:
      return mjOBJ_SITE;
  }
}

ActuatorEntry actuator_entry(const mjModel* m, int id) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  ActuatorEntry actuator;
  actuator.name = name_of(m, mjOBJ_ACTUATOR, id);
  actuator.target = name_of(m, target_type(m->actuator_trntype[id]), m->actuator_trnid[2 * id]);
  const int ctrl = m->actuator_ctrladr[id];
  const bool has_ctrl = m->actuator_ctrlnum[id] > 0 && m->actuator_ctrllimited[ctrl] != 0;
  actuator.ctrl_lower = has_ctrl ? m->actuator_ctrlrange[2 * ctrl] : -kInfinity;
  actuator.ctrl_upper = has_ctrl ? m->actuator_ctrlrange[2 * ctrl + 1] : kInfinity;
  const bool has_force = m->actuator_forcelimited[id] != 0;
  actuator.force_lower = has_force ? m->actuator_forcerange[2 * id] : -kInfinity;
  actuator.force_upper = has_force ? m->actuator_forcerange[2 * id + 1] : kInfinity;
  return actuator;
}

/// "4.0.1" from the number of mjVERSION_HEADER (4000001).
std::string version_text(int number) {
  return std::to_string(number / 1000000) + "." + std::to_string(number / 1000 % 1000) + "." +
         std::to_string(number % 1000);
}

}  // namespace

ModelInventory inventory(const Model& model) {
  const mjModel* m = model.raw();
  ModelInventory result;
  result.bodies = body_entries(m);
  for (int i = 0; i < m->nactuator; ++i) result.actuators.push_back(actuator_entry(m, i));
  for (int i = 0; i < m->nkey; ++i) result.keyframes.push_back(name_of(m, mjOBJ_KEY, i));
  result.joints = static_cast<int>(m->njnt);
  result.geoms = static_cast<int>(m->ngeom);
  result.sites = static_cast<int>(m->nsite);
  result.sensors = static_cast<int>(m->nsensor);
  result.tendons = static_cast<int>(m->ntendon);
  result.meshes = static_cast<int>(m->nmesh);
  result.equalities = static_cast<int>(m->neq);
  result.mass = m->body_subtreemass[0];
  return result;
}

MujocoLibrary mujoco_library() {
  return {mj_versionString(), version_text(mjVERSION_HEADER),
          library_of(reinterpret_cast<const void*>(&mj_versionString))};
}

}  // namespace mjarm
