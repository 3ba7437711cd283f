#include <algorithm>

#include "mjarm/collision/exact_gripper_way_internal.hpp"

namespace mjarm::detail {
namespace {

/// The actuator that one row of ctrl drives; -1 where there is none.
int actuator_of(const mjModel& m, int ctrl) {
  for (int a = 0; a < static_cast<int>(m.nactuator); ++a) {
    if (m.actuator_ctrladr[a] == ctrl) return a;
  }
  return -1;
}

/// By how much the actuator's length grows with a joint's value; 0 where it does not move it.
double ratio_of(const mjModel& m, int actuator, int joint) {
  const double gear = m.actuator_gear[6 * m.actuator_outadr[actuator]];
  const int target = m.actuator_trnid[2 * actuator];
  if (m.actuator_trntype[actuator] != mjTRN_TENDON) return target == joint ? gear : 0;
  for (int w = m.tendon_adr[target]; w < m.tendon_adr[target] + m.tendon_num[target]; ++w) {
    if (m.wrap_type[w] == mjWRAP_JOINT && m.wrap_objid[w] == joint) return gear * m.wrap_prm[w];
  }
  return 0;
}

}  // namespace

GripperWay::GripperWay(const mjModel& m, const Arm& arm) : m_(m), linkage_(m, arm) {
  if (!arm.gripper) return;
  for (const std::string& name : arm.gripper->joints) {
    const int joint = mj_name2id(&m, mjOBJ_JOINT, name.c_str());
    if (joint < 0) continue;
    for (const GripperDrive& drive : arm.gripper->drives) add_driven(joint, drive);
  }
  has_ends_ = has_ends_ && !driven_.empty();
  find_coupled();
}

/// Nothing where the drive does not move the joint.
void GripperWay::add_driven(int joint, const GripperDrive& drive) {
  const int actuator = actuator_of(m_, drive.id);
  const double ratio = actuator < 0 ? 0 : ratio_of(m_, actuator, joint);
  if (ratio == 0) return;
  const bool ctrl_lengthens = m_.actuator_gainprm[actuator * mjNGAIN] > 0;
  const bool longer_opens = (drive.ctrl_open > drive.ctrl_closed) == ctrl_lengthens;
  has_ends_ = has_ends_ && m_.jnt_limited[joint] != 0;
  const mjtNum* range = m_.jnt_range + 2 * joint;
  const bool upper_opens = longer_opens == (ratio > 0);
  driven_.push_back({joint, range[upper_opens ? 1 : 0], range[upper_opens ? 0 : 1]});
}

/// Chains of couplings, link by link.
void GripperWay::find_coupled() {
  const auto is_known = [this](int joint) {
    return std::ranges::find(driven_, joint, &Driven::joint) != driven_.end() ||
           std::ranges::find(coupled_, joint, &Coupled::joint) != coupled_.end();
  };
  for (bool found = true; found;) {
    found = false;
    for (int e = 0; e < static_cast<int>(m_.neq); ++e) {
      if (m_.eq_type[e] != mjEQ_JOINT || m_.eq_active0[e] == 0) continue;
      const int joint = m_.eq_obj1id[e], to = m_.eq_obj2id[e];
      if (to < 0 || is_known(joint) || !is_known(to)) continue;
      coupled_.push_back({joint, to, m_.eq_data + mjNEQDATA * e});
      found = true;
    }
  }
}

/// How far closed the driven joints stand; open where they have no ends.
double GripperWay::grip_in(const std::vector<double>& qpos) const {
  double sum = 0;
  for (const Driven& one : driven_) {
    const double whole = one.closed - one.open;
    const double here = qpos[static_cast<std::size_t>(m_.jnt_qposadr[one.joint])];
    if (whole != 0) sum += std::clamp((here - one.open) / whole, 0.0, 1.0);
  }
  return driven_.empty() ? 0.0 : sum / static_cast<double>(driven_.size());
}

void GripperWay::find_way(const std::vector<double>& from) {
  if (linkage_.has_loops()) linkage_.find_way(from, grip_in(from), 1);
}

bool GripperWay::moves(int body) const {
  if (linkage_.has_loops()) return linkage_.moves(body);
  const auto on = [&](const auto& one) { return m_.jnt_bodyid[one.joint] == body; };
  return std::ranges::any_of(driven_, on) || std::ranges::any_of(coupled_, on);
}

void GripperWay::set_coupled(std::vector<double>& qpos) const {
  for (const Coupled& one : coupled_) {
    const int at = m_.jnt_qposadr[one.joint], from = m_.jnt_qposadr[one.to];
    const double x = qpos[static_cast<std::size_t>(from)] - m_.qpos0[from];
    double sum = 0;
    for (int k = 4; k >= 0; --k) sum = sum * x + one.polynomial[k];
    qpos[static_cast<std::size_t>(at)] = m_.qpos0[at] + sum;
  }
}

void GripperWay::set(const std::vector<double>& from, double share,
                     std::vector<double>& qpos) const {
  if (linkage_.has_loops()) return linkage_.set(share, qpos);
  if (!has_ends_) return;
  for (const Driven& one : driven_) {
    const auto at = static_cast<std::size_t>(m_.jnt_qposadr[one.joint]);
    qpos[at] = from[at] + share * (one.closed - from[at]);
  }
  set_coupled(qpos);
}

void GripperWay::set_open(std::vector<double>& qpos) {
  if (linkage_.has_loops()) {
    linkage_.find_way(qpos, grip_in(qpos), 0);
    return linkage_.set(1, qpos);
  }
  if (!has_ends_) return;
  for (const Driven& one : driven_) {
    qpos[static_cast<std::size_t>(m_.jnt_qposadr[one.joint])] = one.open;
  }
  set_coupled(qpos);
}

}  // namespace mjarm::detail
