#include "mjarm/sim/state_columns.hpp"

#include <mujoco/mujoco.h>

#include <array>
#include <span>

namespace mjarm {
namespace {

/// Name of a thing of the model, else its kind and number.
std::string name_of(const mjModel& m, mjtObj kind, int id) {
  const char* name = mj_id2name(&m, kind, id);
  if (name != nullptr && *name != '\0') return name;
  return std::string(mju_type2Str(kind)) + " " + std::to_string(id);
}

std::string joint_name(const mjModel& m, int joint) {
  const int body = m.jnt_bodyid[joint];
  const char* of_body = mj_id2name(&m, mjOBJ_BODY, body);
  const bool bare = mj_id2name(&m, mjOBJ_JOINT, joint) == nullptr;
  if (bare && of_body != nullptr && m.body_jntnum[body] == 1) return of_body;
  return name_of(m, mjOBJ_JOINT, joint);
}

void add(std::vector<StateColumn>& out, const std::string& name, std::span<const char* const> parts,
         const std::string& unit, Quantity quantity = Quantity::number) {
  for (const char* part : parts) out.push_back({name + " " + part, unit, quantity});
}

void add_joint(const mjModel& m, int joint, StateColumns& out) {
  static constexpr std::array kPlace = {"x", "y", "z"};
  static constexpr std::array kTurn = {"qw", "qx", "qy", "qz"};
  static constexpr std::array kSpin = {"wx", "wy", "wz"};
  const std::string name = joint_name(m, joint);
  switch (m.jnt_type[joint]) {
    case mjJNT_FREE:
      add(out.qpos, name, kPlace, "m", Quantity::length);
      add(out.qpos, name, kTurn, "");
      add(out.qvel, name, kPlace, "m/s");
      add(out.qvel, name, kSpin, "rad/s");
      break;
    case mjJNT_BALL:
      add(out.qpos, name, kTurn, "");
      add(out.qvel, name, kSpin, "rad/s");
      break;
    case mjJNT_SLIDE:
      out.qpos.push_back({name, "m", Quantity::length});
      out.qvel.push_back({name, "m/s"});
      break;
    default:
      out.qpos.push_back({name, "rad", Quantity::angle});
      out.qvel.push_back({name, "rad/s"});
  }
}

/// A position servo straight at one joint is commanded in what the joint measures.
StateColumn ctrl_of(const mjModel& m, int actuator) {
  StateColumn column{name_of(m, mjOBJ_ACTUATOR, actuator), ""};
  const bool at_joint = m.actuator_trntype[actuator] == mjTRN_JOINT;
  const double stiffness = -m.actuator_biasprm[actuator * mjNBIAS + 1];
  const bool servo = m.actuator_biastype[actuator] == mjBIAS_AFFINE && stiffness > 0 &&
                     m.actuator_gainprm[actuator * mjNGAIN] == stiffness &&
                     m.actuator_gear[actuator * 6] == 1;
  if (!at_joint || !servo) return column;
  const int type = m.jnt_type[m.actuator_trnid[actuator * 2]];
  if (type == mjJNT_HINGE) return {column.name, "rad", Quantity::angle};
  if (type == mjJNT_SLIDE) return {column.name, "m", Quantity::length};
  return column;
}

}  // namespace

StateColumns state_columns(const Model& model) {
  const mjModel& m = *model.raw();
  StateColumns out;
  for (int joint = 0; joint < m.njnt; ++joint) add_joint(m, joint, out);
  for (int actuator = 0; actuator < m.nu; ++actuator) out.ctrl.push_back(ctrl_of(m, actuator));
  for (int sensor = 0; sensor < m.nsensor; ++sensor) {
    const std::string name = name_of(m, mjOBJ_SENSOR, sensor);
    const int size = m.sensor_dim[sensor];
    for (int i = 0; i < size; ++i) {
      out.sensors.push_back({size == 1 ? name : name + " " + std::to_string(i), ""});
    }
  }
  return out;
}

}  // namespace mjarm
