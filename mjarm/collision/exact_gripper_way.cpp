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

/// By how much the actuator's length grows with a joint's value.
double ratio_of(const mjModel& m, int actuator, int joint) {
  const double gear = m.actuator_gear[6 * m.actuator_outadr[actuator]];
  if (m.actuator_trntype[actuator] != mjTRN_TENDON) return gear;
  const int tendon = m.actuator_trnid[2 * actuator];
  for (int w = m.tendon_adr[tendon]; w < m.tendon_adr[tendon] + m.tendon_num[tendon]; ++w) {
    if (m.wrap_type[w] == mjWRAP_JOINT && m.wrap_objid[w] == joint) return gear * m.wrap_prm[w];
  }
  return gear;
}

}  // namespace

GripperWay::GripperWay(const mjModel& m, const Arm& arm) : m_(m), linkage_(m, arm) {
  if (!arm.gripper) return;
  const Gripper& gripper = *arm.gripper;
  ctrl_open_ = gripper.ctrl_open;
  ctrl_closed_ = gripper.ctrl_closed;
  const int actuator = actuator_of(m, gripper.id);
  if (actuator < 0) return;
  const bool ctrl_lengthens = m.actuator_gainprm[actuator * mjNGAIN] > 0;
  const bool longer_opens = (gripper.ctrl_open > gripper.ctrl_closed) == ctrl_lengthens;
  for (const std::string& name : gripper.joints) {
    const int joint = mj_name2id(&m, mjOBJ_JOINT, name.c_str());
    if (joint < 0) continue;
    has_ends_ = has_ends_ && m.jnt_limited[joint] != 0;
    const mjtNum* range = m.jnt_range + 2 * joint;
    const bool upper_opens = longer_opens == (ratio_of(m, actuator, joint) > 0);
    driven_.push_back({joint, range[upper_opens ? 1 : 0], range[upper_opens ? 0 : 1]});
  }
  has_ends_ = has_ends_ && !driven_.empty();
  find_coupled();
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

/// The command that goes with where the driven joints stand; open where they have no ends.
double GripperWay::ctrl_in(const std::vector<double>& qpos) const {
  double sum = 0;
  for (const Driven& one : driven_) {
    const double whole = one.closed - one.open;
    const double here = qpos[static_cast<std::size_t>(m_.jnt_qposadr[one.joint])];
    if (whole != 0) sum += std::clamp((here - one.open) / whole, 0.0, 1.0);
  }
  const double share = driven_.empty() ? 0.0 : sum / static_cast<double>(driven_.size());
  return ctrl_open_ + share * (ctrl_closed_ - ctrl_open_);
}

void GripperWay::find_way(const std::vector<double>& from) {
  if (linkage_.has_loops()) linkage_.find_way(from, ctrl_in(from), ctrl_closed_);
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
    linkage_.find_way(qpos, ctrl_in(qpos), ctrl_open_);
    return linkage_.set(1, qpos);
  }
  if (!has_ends_) return;
  for (const Driven& one : driven_) {
    qpos[static_cast<std::size_t>(m_.jnt_qposadr[one.joint])] = one.open;
  }
  set_coupled(qpos);
}

}  // namespace mjarm::detail
