#include <algorithm>
#include <cmath>
#include <set>

#include "mjarm/core/messages/check.hpp"
#include "mjarm/model/arm_parts_internal.hpp"
#include "mjarm/model/check_internal.hpp"
#include "mjarm/model/check_pose_internal.hpp"
#include "mjarm/model/home.hpp"
#include "mjarm/model/load_internal.hpp"
#include "mjarm/model/mujoco_guard.hpp"

namespace mjarm {
namespace {

/// Overlap that is more than rounding [m].
constexpr double kTouch = 1e-5;
/// A servo whose command is this far off moves when the simulation starts [rad or m].
constexpr double kCtrlSlack = 0.05;

Place keyframe_place(const CheckContext& context) {
  const mjModel* m = context.model->raw();
  for (const SourceNode& node : context.description.nodes()) {
    if (node.kind() != "key" || node.section != "keyframe") continue;
    if (m->nkey == 1 || node.attribute("name") == "home") return context.description.place(node);
  }
  return context.description.root();
}

void check_keyframe(const CheckContext& context) {
  const mjModel* m = context.model->raw();
  const Arm& arm = *context.arm;
  const int key = home_keyframe(m);
  if (key < 0) {
    if (context.description.is_urdf()) return;  // URDF knows none
    context.add(CheckCode::home_missing, Grade::note, context.description.root(),
                text(msg::check_home_missing));
    return;
  }
  const double* ctrl = m->key_ctrl + key * m->nu;
  const Place place = keyframe_place(context);
  for (int i = 0; i < arm.dof(); ++i) {
    const ArmJoint& joint = arm.joints[static_cast<std::size_t>(i)];
    const double q = arm.home[i];
    if (q < arm.limits.lower[i] - 1e-6 || q > arm.limits.upper[i] + 1e-6) {
      context.add(
          CheckCode::home_outside_limits, Grade::warning, place,
          text(msg::check_home_outside, joint.name, q, arm.limits.lower[i], arm.limits.upper[i]));
    }
    if (!joint.actuator || !(joint.actuator->bias[1] < 0)) continue;
    const ArmActuator& a = *joint.actuator;
    const double rest = (a.gain * ctrl[a.id] + a.bias[0]) / (-a.bias[1] * a.gear);
    if (std::abs(rest - q) > kCtrlSlack) {
      context.add(CheckCode::home_ctrl_differs, Grade::warning, place,
                  text(msg::check_home_ctrl, joint.name, rest, q));
    }
  }
}

}  // namespace

std::vector<double> home_qpos(const CheckContext& context) {
  const std::span<const double> home = home_configuration(context.model->raw());
  std::vector<double> qpos(home.begin(), home.end());
  const Arm& arm = *context.arm;
  for (int i = 0; i < arm.dof(); ++i) {
    qpos[static_cast<std::size_t>(arm.joints[static_cast<std::size_t>(i)].qpos)] = arm.home[i];
  }
  return qpos;
}

namespace {

/// Bodies that the arm moves.
std::vector<char> moved_bodies(const mjModel* m, int first) {
  std::vector<char> moved(static_cast<std::size_t>(m->nbody), 0);
  for (int b = 1; b < m->nbody; ++b) moved[b] = hangs_on(m, b, first);
  return moved;
}

void report_contacts(const CheckContext& context, const mjData* d, const std::vector<char>& moved,
                     int root) {
  const mjModel* m = context.model->raw();
  std::set<std::pair<int, int>> told;
  for (int c = 0; c < d->ncon; ++c) {
    const mjContact& contact = d->contact[c];
    if (contact.dist > -kTouch || contact.geom[0] < 0 || contact.geom[1] < 0) continue;
    int bodies[2] = {m->geom_bodyid[contact.geom[0]], m->geom_bodyid[contact.geom[1]]};
    if (!moved[bodies[0]] && !moved[bodies[1]]) continue;
    if (context.arm->overlap_by_design({contact.geom[0], bodies[0]},
                                       {contact.geom[1], bodies[1]})) {
      continue;
    }
    if (!told.insert(std::minmax(bodies[0], bodies[1])).second) continue;
    // The outer one touches the inner one; nothing that stands still touches the arm.
    if (!moved[bodies[0]] || (moved[bodies[1]] && bodies[1] > bodies[0])) {
      std::swap(bodies[0], bodies[1]);
    }
    // The base belongs to the arm; what else stands around does not. In a URDF all is the robot.
    const bool self = moved[bodies[1]] || context.description.is_urdf() ||
                      (bodies[1] != 0 && m->body_rootid[bodies[1]] == root);
    context.add(self ? CheckCode::home_self_contact : CheckCode::home_contact, Grade::warning,
                context.description.body(object_name(m, mjOBJ_BODY, bodies[0])),
                text(self ? msg::check_self_contact : msg::check_contact,
                     object_name(m, mjOBJ_BODY, bodies[1]), -1000 * contact.dist));
  }
}

void report_design(const CheckContext& context) {
  for (const DesignOverlap& pair : context.arm->overlapping) {
    context.add(CheckCode::overlap_by_design, Grade::warning,
                context.description.body(pair.names[0]),
                text(msg::check_overlap_by_design, pair.names[1]));
  }
}

/// Whether the arm can be touched at all.
void check_collision_shapes(const CheckContext& context, const std::vector<char>& moved) {
  const mjModel* m = context.model->raw();
  int seen = 0;
  for (int g = 0; g < m->ngeom; ++g) {
    if (!moved[m->geom_bodyid[g]]) continue;
    ++seen;
    if (m->geom_contype[g] != 0 || m->geom_conaffinity[g] != 0) return;
  }
  const Place place = context.description.joint(context.arm->joints.front().name);
  context.add(CheckCode::collision_missing, seen > 0 ? Grade::warning : Grade::note, place,
              text(seen > 0 ? msg::check_no_collision_shapes : msg::check_no_shapes));
}

}  // namespace

void check_home(const CheckContext& context) {
  const mjModel* m = context.model->raw();
  check_keyframe(context);
  const int joint = mj_name2id(m, mjOBJ_JOINT, context.arm->joints.front().name.c_str());
  if (joint < 0) return;
  const int first = m->jnt_bodyid[joint];
  const std::vector<char> moved = moved_bodies(m, first);
  check_collision_shapes(context, moved);
  report_design(context);
  const MjDataPtr data(mj_makeData(m));
  const std::vector<double> qpos = home_qpos(context);
  std::copy(qpos.begin(), qpos.end(), data->qpos);
  const MujocoOutcome outcome = call_mujoco([&] { mj_fwdPosition(m, data.get()); });
  if (!outcome.failed) report_contacts(context, data.get(), moved, m->body_rootid[first]);
}

}  // namespace mjarm
