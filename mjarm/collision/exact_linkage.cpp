#include <algorithm>
#include <cmath>

#include "mjarm/collision/exact_data_internal.hpp"
#include "mjarm/collision/exact_linkage_internal.hpp"
#include "mjarm/model/gripper_command.hpp"
#include "mjarm/model/mujoco_guard.hpp"

namespace mjarm::detail {
namespace {

constexpr double kRamp = 1;      // [s] in which the command changes
constexpr double kMoving = 2.5;  // [s] at most
constexpr int kMaxLinkSteps = 5000;
constexpr double kResting = 1e-3;  // [rad/s or m/s] slower is at rest

/// True for what hangs on `body`, itself not.
bool hangs_beyond(const mjModel& m, int descendant, int body) {
  int b = m.body_parentid[descendant];
  while (b > body) b = m.body_parentid[b];
  return descendant != body && b == body;
}

/// The body of an end of a connect or weld constraint.
int body_of_end(const mjModel& m, int equality, int id) {
  return m.eq_objtype[equality] == mjOBJ_SITE ? m.site_bodyid[id] : id;
}

}  // namespace

Linkage::Linkage(const mjModel& m, const Arm& arm) : m_(m) {
  if (!arm.gripper) return;
  gripper_ = *arm.gripper;
  const int last = m.dof_bodyid[arm.joints.back().dof];
  for (int j = 0; j < static_cast<int>(m.njnt); ++j) {
    const bool one = m.jnt_type[j] == mjJNT_HINGE || m.jnt_type[j] == mjJNT_SLIDE;
    if (one && hangs_beyond(m, m.jnt_bodyid[j], last)) joints_.push_back(j);
  }
  for (int e = 0; e < static_cast<int>(m.neq); ++e) {
    const bool closes = m.eq_type[e] == mjEQ_CONNECT || m.eq_type[e] == mjEQ_WELD;
    if (!closes || m.eq_active0[e] == 0) continue;
    has_loops_ = has_loops_ || (hangs_beyond(m, body_of_end(m, e, m.eq_obj1id[e]), last) &&
                                hangs_beyond(m, body_of_end(m, e, m.eq_obj2id[e]), last));
  }
}

bool Linkage::moves(int body) const {
  return std::ranges::any_of(joints_, [&](int j) { return m_.jnt_bodyid[j] == body; });
}

/// All but the joints of the hand stays as in `from`.
void Linkage::hold(mjData& d, const std::vector<double>& from) const {
  std::vector<double> qpos = from, qvel(static_cast<std::size_t>(m_.nv), 0);
  for (const int j : joints_) {
    qpos[static_cast<std::size_t>(m_.jnt_qposadr[j])] = d.qpos[m_.jnt_qposadr[j]];
    qvel[static_cast<std::size_t>(m_.jnt_dofadr[j])] = d.qvel[m_.jnt_dofadr[j]];
  }
  std::ranges::copy(qpos, d.qpos);
  std::ranges::copy(qvel, d.qvel);
}

void Linkage::note(const mjData& d) {
  std::vector<double> values;
  values.reserve(joints_.size());
  for (const int j : joints_) values.push_back(d.qpos[m_.jnt_qposadr[j]]);
  double step = 0;
  if (!way_.empty()) {
    for (std::size_t i = 0; i < values.size(); ++i) step += std::abs(values[i] - way_.back()[i]);
  }
  length_.push_back(way_.empty() ? 0.0 : length_.back() + step);
  way_.push_back(std::move(values));
}

void Linkage::find_way(const std::vector<double>& from, double grip_from, double grip) {
  way_.clear();
  length_.clear();
  const MjModelPtr still(mj_copyModel(nullptr, &m_));
  const MjDataPtr d(mj_makeData(still.get()));
  mju_zero3(still->opt.gravity);
  still->opt.disableflags |= mjDSBL_CONTACT;
  std::ranges::copy(from, d->qpos);
  note(*d);
  const double dt = m_.opt.timestep;
  const int steps = std::min(static_cast<int>(kMoving / dt), kMaxLinkSteps);
  const double ramp = std::min(kRamp, 0.5 * steps * dt);
  std::vector<double> begin(static_cast<std::size_t>(m_.nu)), end(begin);
  set_grip(gripper_, grip_from, begin);
  set_grip(gripper_, grip, end);
  bool resting = false;
  for (int k = 0; k < steps && !resting; ++k) {
    for (const GripperDrive& drive : gripper_.drives) {
      const auto row = static_cast<std::size_t>(drive.id);
      d->ctrl[row] = begin[row] + std::min(d->time / ramp, 1.0) * (end[row] - begin[row]);
    }
    if (mjarm::call_mujoco([&] { mj_step(still.get(), d.get()); }).failed) break;
    if (d->warning[mjWARN_BADQACC].number > 0) break;
    hold(*d, from);
    note(*d);
    resting = d->time > ramp + 0.1 && std::ranges::all_of(joints_, [&](int j) {
                return std::abs(d->qvel[m_.jnt_dofadr[j]]) < kResting;
              });
  }
}

void Linkage::set(double share, std::vector<double>& qpos) const {
  const double at = share * length_.back();
  const auto next = static_cast<std::size_t>(
      std::distance(length_.begin(), std::ranges::lower_bound(length_, at)));
  const std::size_t b = std::min(next, length_.size() - 1), a = b > 0 ? b - 1 : 0;
  const double gap = length_[b] - length_[a];
  const double part = gap > 0 ? (at - length_[a]) / gap : 1;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    qpos[static_cast<std::size_t>(m_.jnt_qposadr[joints_[i]])] =
        way_[a][i] + part * (way_[b][i] - way_[a][i]);
  }
}

}  // namespace mjarm::detail
