#include "mjarm/model/find_arm.hpp"

#include <algorithm>
#include <cmath>

#include "mjarm/core/messages/model.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/model/arm_parts_internal.hpp"
#include "mjarm/model/design_overlaps_internal.hpp"
#include "mjarm/model/home.hpp"
#include "mjarm/model/load_internal.hpp"

namespace mjarm {
namespace {

/// Home of the arm's joints: of the keyframe, else the middle of the limits, else 0.
JointVec home_of(const mjModel* m, const Arm& arm) {
  const std::span<const double> qpos = home_configuration(m);
  const bool has_key = home_keyframe(m) >= 0;
  JointVec home(arm.dof());
  for (int i = 0; i < arm.dof(); ++i) {
    const double middle = 0.5 * (arm.limits.lower[i] + arm.limits.upper[i]);
    const auto at = static_cast<std::size_t>(arm.joints[i].qpos);
    home[i] = has_key ? qpos[at] : std::isfinite(middle) ? middle : 0.0;
  }
  return home;
}

}  // namespace

std::string object_name(const mjModel* m, mjtObj type, int id) {
  const char* name = mj_id2name(m, type, id);
  return name != nullptr ? name : "#" + std::to_string(id);
}

std::vector<std::string> frame_names(const mjModel* m) {
  std::vector<std::string> names;
  for (int i = 0; i < m->nsite; ++i) {
    if (const char* name = mj_id2name(m, mjOBJ_SITE, i)) names.emplace_back(name);
  }
  for (int i = 1; i < m->nbody; ++i) {
    if (const char* name = mj_id2name(m, mjOBJ_BODY, i)) names.emplace_back(name);
  }
  return names;
}

Result<TipFrame> find_frame(const Model& model, std::string_view name) {
  const mjModel* m = model.raw();
  const std::string wanted(name);
  if (const int site = mj_name2id(m, mjOBJ_SITE, wanted.c_str()); site >= 0) {
    return TipFrame{wanted, m->site_bodyid[site],
                    pose_of(m->site_pos + 3 * site, m->site_quat + 4 * site)};
  }
  if (const int body = mj_name2id(m, mjOBJ_BODY, wanted.c_str()); body >= 0) {
    return TipFrame{wanted, body, Pose()};
  }
  for (int body = 1; wanted.starts_with('#') && body < m->nbody; ++body) {
    if (object_name(m, mjOBJ_BODY, body) == wanted) return TipFrame{wanted, body, Pose()};
  }
  return fail(Errc::usage, text(msg::model_no_frame, model.file().string(), wanted,
                                did_you_mean(name, frame_names(m))));
}

std::vector<int> bodies_to(const mjModel* m, int body) {
  std::vector<int> bodies;
  for (int at = body; at > 0; at = m->body_parentid[at]) bodies.push_back(at);
  std::reverse(bodies.begin(), bodies.end());
  return bodies;
}

std::vector<int> joints_to(const mjModel* m, int body) {
  std::vector<int> joints;
  for (const int b : bodies_to(m, body)) {
    for (int j = m->body_jntadr[b]; j < m->body_jntadr[b] + m->body_jntnum[b]; ++j) {
      if (m->jnt_type[j] == mjJNT_HINGE || m->jnt_type[j] == mjJNT_SLIDE) joints.push_back(j);
    }
  }
  return joints;
}

bool hangs_on(const mjModel* m, int descendant, int body) {
  while (descendant > body) descendant = m->body_parentid[descendant];
  return descendant == body;
}

Result<void> fill_chain(const Model& model, const TipFrame& tip, const double* qpos, Arm& arm) {
  const mjModel* m = model.raw();
  Pose X_PB;  // the body's frame in the moved frame of the last joint so far (first: the world)
  for (const int b : bodies_to(m, tip.body)) {
    X_PB = X_PB * pose_of(m->body_pos + 3 * b, m->body_quat + 4 * b);
    for (int j = m->body_jntadr[b]; j < m->body_jntadr[b] + m->body_jntnum[b]; ++j) {
      const double* q = qpos + m->jnt_qposadr[j];
      if (m->jnt_type[j] == mjJNT_FREE) {
        X_PB = pose_of(q, q + 3);  // a child of the world: the pose is absolute
        continue;
      }
      if (m->jnt_type[j] == mjJNT_BALL) {
        return fail(Errc::bad_input, text(msg::model_ball_joint, model.file().string(),
                                          object_name(m, mjOBJ_JOINT, j), tip.name));
      }
      // MuJoCo turns a body about the anchor jnt_pos by q - qpos0, or shifts it by q - qpos0 along
      // the axis (Computation, Kinematics). The joint's frame has the body's axes at the anchor.
      const Eigen::Vector3d axis = Eigen::Vector3d(m->jnt_axis + 3 * j).normalized();
      const Eigen::Vector3d anchor(m->jnt_pos + 3 * j);
      const double reference = m->qpos0[m->jnt_qposadr[j]];
      ArmJoint joint;
      joint.name = object_name(m, mjOBJ_JOINT, j);
      joint.axis = axis;
      joint.qpos = m->jnt_qposadr[j];
      joint.dof = m->jnt_dofadr[j];
      joint.damping = m->dof_damping[joint.dof];
      joint.armature = m->dof_armature[joint.dof];
      if (m->jnt_type[j] == mjJNT_HINGE) {
        joint.type = JointType::hinge;
        joint.X_PJ = X_PB * Pose{anchor, rotation_exp(-reference * axis)};
        X_PB = Pose{-anchor, Eigen::Matrix3d::Identity()};
      } else {
        joint.type = JointType::slide;
        joint.X_PJ = X_PB * Pose{-reference * axis, Eigen::Matrix3d::Identity()};
        X_PB = Pose();
      }
      arm.joints.push_back(std::move(joint));
    }
  }
  arm.X_JT = X_PB * tip.X_BT;
  return {};
}

Result<Arm> find_arm(const Model& model, const ArmOptions& options) {
  const mjModel* m = model.raw();
  const Result<TipFrame> tip =
      options.tip.empty() ? find_tip(model) : find_frame(model, options.tip);
  if (!tip) return fail(tip.error());
  const std::vector<int> joints = joints_to(m, tip->body);
  if (joints.empty()) {
    return fail(Errc::usage, text(msg::model_tip_fixed, model.file().string(), tip->name));
  }
  if (joints.size() > static_cast<std::size_t>(kMaxDof)) {
    return fail(Errc::bad_input, text(msg::model_too_many_joints, model.file().string(), tip->name,
                                      joints.size(), kMaxDof));
  }
  Arm arm;
  arm.name = model.name();
  arm.tip = tip->name;
  if (auto done = fill_chain(model, *tip, home_configuration(m).data(), arm); !done) {
    return fail(done.error());
  }
  fill_actuators(m, joints, arm);
  fill_limits(model, joints, arm);
  arm.home = home_of(m, arm);
  arm.gripper = find_gripper(m, joints);
  arm.overlapping = design_overlaps(m, joints);
  return arm;
}

Result<Pose> frame_pose(const Model& model, std::string_view frame, std::span<const double> qpos) {
  const mjModel* m = model.raw();
  if (qpos.size() != static_cast<std::size_t>(m->nq)) {
    return fail(Errc::usage, text(msg::model_wrong_size, "qpos", qpos.size(), m->nq));
  }
  const Result<TipFrame> found = find_frame(model, frame);
  if (!found) return fail(found.error());
  const MjDataPtr data(mj_makeData(m));
  std::copy(qpos.begin(), qpos.end(), data->qpos);
  mj_kinematics(m, data.get());
  const int b = found->body;
  return pose_of(data->xpos + 3 * b, data->xquat + 4 * b) * found->X_BT;
}

Result<Pose> frame_pose(const Model& model, std::string_view frame) {
  return frame_pose(model, frame, home_configuration(model.raw()));
}

}  // namespace mjarm
