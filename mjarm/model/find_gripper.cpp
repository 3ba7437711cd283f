#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "mjarm/model/arm_parts_internal.hpp"
#include "mjarm/model/load_internal.hpp"

namespace mjarm {
namespace {

/// A joint that an actuator moves, and how: d(length) / d(joint value).
struct Drive {
  int joint;
  double ratio;
};

/// Joints that actuator `a` moves through a joint or a fixed tendon; empty for other transmissions.
std::vector<Drive> drives_of(const mjModel* m, int a) {
  const double gear = m->actuator_gear[6 * m->actuator_outadr[a]];
  const int target = m->actuator_trnid[2 * a];
  std::vector<Drive> drives;
  const int type = m->actuator_trntype[a];
  if (type == mjTRN_JOINT || type == mjTRN_JOINTINPARENT) {
    drives.push_back({target, gear});
  } else if (type == mjTRN_TENDON) {
    const int begin = m->tendon_adr[target];
    for (int w = begin; w < begin + m->tendon_num[target]; ++w) {
      if (m->wrap_type[w] != mjWRAP_JOINT) continue;
      drives.push_back({m->wrap_objid[w], gear * m->wrap_prm[w]});
    }
  }
  return drives;
}

/// An actuator that may be of a gripper, and what it moves.
struct Candidate {
  int actuator = -1;
  std::vector<Drive> drives;
};

/// Puts every driven joint at `share` (0 to 1) of its range.
void put(const mjModel* m, mjData* d, const std::vector<Drive>& drives, double share) {
  for (const Drive& drive : drives) {
    const double* range = m->jnt_range + 2 * drive.joint;
    const bool limited = m->jnt_limited[drive.joint] != 0;
    const double lower = limited ? range[0] : -0.01;
    const double upper = limited ? range[1] : 0.01;
    const double along = drive.ratio > 0 ? share : 1 - share;
    d->qpos[m->jnt_qposadr[drive.joint]] = lower + along * (upper - lower);
  }
}

/// How far the gripper is open when what `moved` drives stands at `share` of its way and what the
/// others drive in the middle: the distance of the first two fingers' centres of mass, or of a
/// single finger from the body that carries it [m].
double opening(const mjModel* m, mjData* d, const std::vector<Candidate>& all,
               const Candidate& moved, double share) {
  mj_resetData(m, d);
  std::vector<int> fingers;
  for (const Candidate& one : all) {
    put(m, d, one.drives, &one == &moved ? share : 0.5);
    for (const Drive& drive : one.drives) fingers.push_back(m->jnt_bodyid[drive.joint]);
  }
  mj_kinematics(m, d);
  mj_comPos(m, d);
  const bool pair = fingers.size() > 1;
  const double* other =
      pair ? d->subtree_com + 3 * fingers[1]
           : d->xipos + static_cast<std::ptrdiff_t>(3) * m->body_parentid[fingers[0]];
  return (Eigen::Vector3d(d->subtree_com + 3 * fingers[0]) - Eigen::Vector3d(other)).norm();
}

/// Range of ctrl from one end of the joints' way to the other; none where it has no ends.
std::optional<std::pair<double, double>> ctrl_range(const mjModel* m, int a,
                                                    const std::vector<Drive>& drives) {
  const int ctrl = m->actuator_ctrladr[a];
  if (m->actuator_ctrllimited[ctrl]) {
    return std::pair(m->actuator_ctrlrange[2 * ctrl], m->actuator_ctrlrange[2 * ctrl + 1]);
  }
  // A position servo without ctrlrange: gain * ctrl = stiffness * length where it rests.
  const double gain = m->actuator_gainprm[a * mjNGAIN];
  const double stiffness = -m->actuator_biasprm[a * mjNBIAS + 1];
  if (gain == 0 || stiffness <= 0) return std::nullopt;
  std::pair<double, double> length(0, 0);
  for (const Drive& drive : drives) {
    if (!m->jnt_limited[drive.joint]) return std::nullopt;
    const double a0 = drive.ratio * m->jnt_range[2 * drive.joint];
    const double a1 = drive.ratio * m->jnt_range[2 * drive.joint + 1];
    length.first += std::min(a0, a1);
    length.second += std::max(a0, a1);
  }
  return std::minmax({length.first * stiffness / gain, length.second * stiffness / gain});
}

/// The actuators that move joints beyond the arm's last one and nothing else.
std::vector<Candidate> beyond(const mjModel* m, const std::vector<int>& joints) {
  const int last = m->jnt_bodyid[joints.back()];
  std::vector<Candidate> out;
  for (int a = 0; a < m->nactuator; ++a) {
    std::vector<Drive> drives = drives_of(m, a);
    const bool is = !drives.empty() && std::ranges::all_of(drives, [&](const Drive& drive) {
      return std::ranges::count(joints, drive.joint) == 0 &&
             hangs_on(m, m->jnt_bodyid[drive.joint], last);
    });
    if (is) out.push_back({a, std::move(drives)});
  }
  return out;
}

/// One actuator, or two that each move one of two fingers of one kind on one body: a hand of more
/// drives is more than open and closed.
bool opens_and_closes(const mjModel* m, const std::vector<Candidate>& all) {
  if (all.size() == 1) return true;
  if (all.size() != 2 || all[0].drives.size() != 1 || all[1].drives.size() != 1) return false;
  const int a = all[0].drives[0].joint, b = all[1].drives[0].joint;
  const int on_a = m->body_parentid[m->jnt_bodyid[a]], on_b = m->body_parentid[m->jnt_bodyid[b]];
  return m->jnt_bodyid[a] != m->jnt_bodyid[b] && m->jnt_type[a] == m->jnt_type[b] &&
         m->body_weldid[on_a] == m->body_weldid[on_b];
}

}  // namespace

std::optional<Gripper> find_gripper(const mjModel* m, const std::vector<int>& joints) {
  const std::vector<Candidate> all = beyond(m, joints);
  if (!opens_and_closes(m, all)) return std::nullopt;
  const MjDataPtr data(mj_makeData(m));
  Gripper gripper;
  for (const Candidate& one : all) {
    const int a = one.actuator;
    const auto range = ctrl_range(m, a, one.drives);
    if (m->actuator_ctrlnum[a] != 1 || !range) return std::nullopt;
    const bool longer_is_wider =
        opening(m, data.get(), all, one, 1) > opening(m, data.get(), all, one, 0);
    const bool ctrl_lengthens = m->actuator_gainprm[a * mjNGAIN] > 0;
    const bool upper_opens = longer_is_wider == ctrl_lengthens;
    gripper.drives.push_back({.actuator = object_name(m, mjOBJ_ACTUATOR, a),
                              .id = m->actuator_ctrladr[a],
                              .ctrl_open = upper_opens ? range->second : range->first,
                              .ctrl_closed = upper_opens ? range->first : range->second});
    for (const Drive& drive : one.drives) {
      gripper.joints.push_back(object_name(m, mjOBJ_JOINT, drive.joint));
    }
  }
  return gripper;
}

}  // namespace mjarm
