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

/// How far the gripper is open when every driven joint stands at `share` (0 to 1) of its range: the
/// distance of the first two fingers' centres of mass, or of a single finger from the body that
/// carries it [m].
double opening(const mjModel* m, mjData* d, const std::vector<Drive>& drives, double share) {
  mj_resetData(m, d);
  for (const Drive& drive : drives) {
    const double* range = m->jnt_range + 2 * drive.joint;
    const bool limited = m->jnt_limited[drive.joint] != 0;
    const double lower = limited ? range[0] : -0.01;
    const double upper = limited ? range[1] : 0.01;
    const double along = drive.ratio > 0 ? share : 1 - share;
    d->qpos[m->jnt_qposadr[drive.joint]] = lower + along * (upper - lower);
  }
  mj_kinematics(m, d);
  mj_comPos(m, d);
  const int first = m->jnt_bodyid[drives[0].joint];
  const int other = drives.size() > 1 ? m->jnt_bodyid[drives[1].joint] : m->body_parentid[first];
  const double* other_centre =
      drives.size() > 1 ? d->subtree_com + 3 * other : d->xipos + 3 * other;
  return (Eigen::Vector3d(d->subtree_com + 3 * first) - Eigen::Vector3d(other_centre)).norm();
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

}  // namespace

std::optional<Gripper> find_gripper(const mjModel* m, const std::vector<int>& joints) {
  const int last = m->jnt_bodyid[joints.back()];
  int chosen = -1;
  std::vector<Drive> drives;
  for (int a = 0; a < m->nactuator; ++a) {
    const std::vector<Drive> here = drives_of(m, a);
    const bool beyond = !here.empty() && std::all_of(here.begin(), here.end(), [&](Drive drive) {
      const bool in_arm = std::find(joints.begin(), joints.end(), drive.joint) != joints.end();
      return !in_arm && hangs_on(m, m->jnt_bodyid[drive.joint], last);
    });
    if (!beyond) continue;
    if (chosen >= 0) return std::nullopt;  // a hand of many drives is more than open and closed
    chosen = a;
    drives = here;
  }
  if (chosen < 0 || m->actuator_ctrlnum[chosen] != 1) return std::nullopt;
  const auto range = ctrl_range(m, chosen, drives);
  if (!range) return std::nullopt;

  const MjDataPtr data(mj_makeData(m));
  const bool longer_is_wider =
      opening(m, data.get(), drives, 1) > opening(m, data.get(), drives, 0);
  const bool ctrl_lengthens = m->actuator_gainprm[chosen * mjNGAIN] > 0;
  Gripper gripper;
  gripper.actuator = object_name(m, mjOBJ_ACTUATOR, chosen);
  gripper.id = m->actuator_ctrladr[chosen];
  gripper.ctrl_open = longer_is_wider == ctrl_lengthens ? range->second : range->first;
  gripper.ctrl_closed = longer_is_wider == ctrl_lengthens ? range->first : range->second;
  for (const Drive& drive : drives) {
    gripper.joints.push_back(object_name(m, mjOBJ_JOINT, drive.joint));
  }
  return gripper;
}

}  // namespace mjarm
