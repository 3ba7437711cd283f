#include "mjarm/session/arm_json.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/sim/body_poses.hpp"

namespace mjarm::session {
namespace {

std::vector<double> frame(const Pose& X) {
  std::vector<double> out(X.p.begin(), X.p.end());
  out.insert(out.end(), X.R.data(), X.R.data() + X.R.size());
  return out;
}

/// By body the last joint that moves it.
std::map<int, int> joints_of_bodies(BodyPoses& poses, const Arm& arm) {
  constexpr double kMove = 0.1;  // [rad or m]
  std::map<int, int> out;
  for (int i = 0; i < arm.dof(); ++i) {
    const int place = arm.joints[static_cast<std::size_t>(i)].qpos;
    const double value = poses.qpos()[static_cast<std::size_t>(place)] + kMove;
    for (const BodyPoses::Moved& moved : poses.moved({&place, 1}, {&value, 1})) out[moved.body] = i;
  }
  return out;
}

void write_bodies(JsonWriter& json, const Model& model, const Arm& arm) {
  BodyPoses poses(model);
  JointVec q(arm.dof());
  for (int i = 0; i < arm.dof(); ++i) {
    const int place = arm.joints[static_cast<std::size_t>(i)].qpos;
    q[i] = poses.qpos()[static_cast<std::size_t>(place)];
  }
  std::array<Pose, kMaxDof> X_WJ;
  fk_all(arm, as_span(q), X_WJ);
  json.key("bodies").list();
  for (const auto& [body, joint] : joints_of_bodies(poses, arm)) {
    const Pose X_JB = X_WJ[static_cast<std::size_t>(joint)].inverse() * poses.pose(body);
    const Quat turn = to_quat(X_JB.R);
    json.line_break().list().value(body).value(joint);
    for (const double value : X_JB.p) json.value(value);
    json.value(turn.w()).value(turn.x()).value(turn.y()).value(turn.z()).end_list();
  }
  json.end_list();
}

/// All but the bodies.
void write_arm(JsonWriter& json, const Arm& arm) {
  json.member("name", arm.name).key("joints").list();
  for (int i = 0; i < arm.dof(); ++i) {
    const ArmJoint& joint = arm.joints[static_cast<std::size_t>(i)];
    json.line_break().object().member("name", joint.name);
    json.member("qpos", joint.qpos).member("dof", joint.dof);
    json.member("type", joint.type == JointType::slide ? "slide" : "hinge");
    json.member("X_PJ", frame(joint.X_PJ)).member("axis", joint.axis);
    json.member("lower", arm.limits.lower[i]).member("upper", arm.limits.upper[i]).end_object();
  }
  json.end_list().line_break().member("X_JT", frame(arm.X_JT)).member("home", arm.home);
}

}  // namespace

std::vector<int> dofs_of(const Arm& arm) {
  std::vector<int> out;
  for (const ArmJoint& joint : arm.joints) out.push_back(joint.dof);
  return out;
}

std::string arm_json(const Model& model, const Arm& arm) {
  std::string out;
  JsonWriter json(out);
  write_arm(json.object(), arm);
  write_bodies(json, model, arm);
  json.end_object();
  return out;
}

std::string arm_json(const Arm& arm) {
  std::string out;
  JsonWriter json(out);
  write_arm(json.object(), arm);
  json.end_object();
  return out;
}

}  // namespace mjarm::session
