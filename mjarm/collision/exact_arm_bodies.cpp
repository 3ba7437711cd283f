#include <algorithm>
#include <iterator>

#include "mjarm/collision/exact_arm_bodies_internal.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/model/home.hpp"

namespace mjarm::detail {
namespace {

/// Index of the joint whose value stands at `qpos` of the model's qpos; -1 where there is none.
int joint_at(const mjModel& m, int qpos) {
  for (int j = 0; j < static_cast<int>(m.njnt); ++j) {
    const bool single = m.jnt_type[j] == mjJNT_HINGE || m.jnt_type[j] == mjJNT_SLIDE;
    if (single && m.jnt_qposadr[j] == qpos) return j;
  }
  return -1;
}

std::string name_of(const mjModel& m, int type, int id) {
  const char* const name = mj_id2name(&m, type, id);
  return name == nullptr ? std::string() : std::string(name);
}

}  // namespace

ArmBodies::ArmBodies(const mjModel& m, const Arm& arm, const std::vector<AttachedBody>& attached_in)
    : pieces(static_cast<std::size_t>(m.nbody)), carried(static_cast<std::size_t>(m.nbody)) {
  for (const ArmJoint& joint : arm.joints) {
    const int id = joint_at(m, joint.qpos);
    if (id < 0) {
      matches = false;
      continue;
    }
    addresses.push_back(joint.qpos);
    bodies.push_back(m.jnt_bodyid[id]);
    pieces[static_cast<std::size_t>(m.jnt_bodyid[id])] = static_cast<int>(addresses.size());
  }
  for (const AttachedBody& one : attached_in) {
    const int body = find_body(m, one.body);
    attached.push_back({m.jnt_qposadr[m.body_jntadr[body]], one.X_TB});
    pieces[static_cast<std::size_t>(body)] = static_cast<int>(addresses.size());
    carried[static_cast<std::size_t>(body)] = true;
  }
  for (int b = 1; b < static_cast<int>(m.nbody); ++b) {  // parents come before their children
    const auto parent = static_cast<std::size_t>(m.body_parentid[b]);
    int& piece = pieces[static_cast<std::size_t>(b)];
    piece = std::max(piece, pieces[parent]);
    if (carried[parent]) carried[static_cast<std::size_t>(b)] = true;
  }
}

void ArmBodies::place_attached(const Pose& X_WT, mjtNum* qpos) const {
  for (const Attached& one : attached) {
    const Pose X_WB = X_WT * one.X_TB;
    const Quat turn = to_quat(X_WB.R);
    const double values[] = {X_WB.p.x(), X_WB.p.y(), X_WB.p.z(), turn.w(),
                             turn.x(),   turn.y(),   turn.z()};
    std::copy(std::begin(values), std::end(values), qpos + one.address);
  }
}

std::vector<double> rest_configuration(const mjModel& m) {
  const std::span<const double> home = home_configuration(&m);
  return {home.begin(), home.end()};
}

std::string geom_name(const mjModel& m, int geom) {
  std::string name = name_of(m, mjOBJ_GEOM, geom);
  if (!name.empty()) return name;
  const int body = m.geom_bodyid[geom];
  return body_name(m, body) + "[" + std::to_string(geom - m.body_geomadr[body]) + "]";
}

std::string body_name(const mjModel& m, int body) {
  std::string name = name_of(m, mjOBJ_BODY, body);
  return name.empty() ? "#" + std::to_string(body) : name;
}

int find_body(const mjModel& m, const std::string& name) {
  const int body = mj_name2id(&m, mjOBJ_BODY, name.c_str());
  if (body >= 0 || !name.starts_with('#')) return body;
  for (int b = 1; b < static_cast<int>(m.nbody); ++b) {
    if (body_name(m, b) == name) return b;
  }
  return -1;
}

}  // namespace mjarm::detail
