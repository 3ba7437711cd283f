#include <cmath>
#include <optional>
#include <vector>

#include "apps/mjarm/learn/exercise.hpp"
#include "apps/mjarm/messages/learn.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/core/units.hpp"
#include "mjarm/model/check.hpp"
#include "mjarm/model/describe.hpp"
#include "mjarm/model/dynamics.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm::app {
namespace {

constexpr double kBoxSeconds = 1, kBoxHalfWay = 0.5;  // [s]
constexpr int kMaxBoxSteps = 200000;
constexpr double kNoTorque = 1e-9;  // share of the weight: [m] of lever

constexpr double kSmallTilt = 3.15;  // [deg] no turn in radians is read as more

/// What the box did.
struct BoxFall {
  double z_start = 0, z_half = 0, z_end = 0;  // [m] at the beginning, half way, in the end
  std::optional<double> touched;              // [s]
  double depth = 0;                           // [m] in the end
};

/// The body's depth in what it touches; 0 where it touches nothing.
double contact_depth(const Sim& sim, int body) {
  double depth = 0;
  for (const Contact& contact : sim.contacts()) {
    if (contact.body1 == body || contact.body2 == body) depth = std::max(depth, contact.depth);
  }
  return depth;
}

Result<BoxFall> let_fall(const Model& model, int body) {
  Sim sim(model);
  const std::vector<double> ctrl(static_cast<std::size_t>(model.nu()), 0.0);
  BoxFall fall;
  fall.z_start = fall.z_half = sim.body_pose(body).p.z();
  int steps = 0;
  while (sim.time() < kBoxSeconds - 1e-9) {
    if (++steps > kMaxBoxSteps || interrupted()) {
      return fail(Errc::bad_input, text(msg::learn_box_timestep, model.timestep()));
    }
    if (Result<void> done = sim.step(ctrl); !done) return fail(done.error());
    if (!fall.touched && contact_depth(sim, body) > 0) fall.touched = sim.time();
    if (sim.time() < kBoxHalfWay + 1e-9) fall.z_half = sim.body_pose(body).p.z();
  }
  fall.z_end = sim.body_pose(body).p.z();
  fall.depth = contact_depth(sim, body);
  return fall;
}

/// Mass of a body and of all that hangs on it.
double mass_with_children(const ModelInfo& info, int body) {
  double mass = 0;
  for (int i = body; i < static_cast<int>(info.bodies.size()); ++i) {
    int above = i;
    while (above > body) above = info.bodies[static_cast<std::size_t>(above)].parent;
    if (above == body) mass += info.bodies[static_cast<std::size_t>(i)].mass;
  }
  return mass;
}

/// [m] the lever that gravity has at a hinge; with the hinge turned by `turn` [rad].
double gravity_lever(const Model& model, const ModelInfo& info, int body, double turn) {
  const JointInfo& joint = info.bodies[static_cast<std::size_t>(body)].joints.front();
  std::vector<double> qpos(model.qpos0().begin(), model.qpos0().end());
  qpos[static_cast<std::size_t>(joint.qpos)] += turn;
  Dynamics dynamics(model);
  const double weight = mass_with_children(info, body) * info.gravity.norm();
  return weight > 0 ? std::abs(dynamics.gravity(qpos)[joint.dof]) / weight : 0;
}

void judge_hinge(const Model& model, const ModelInfo& info, int body, const BoxFall& fall,
                 LearnReport& out) {
  const JointInfo& joint = info.bodies[static_cast<std::size_t>(body)].joints.front();
  const Eigen::Vector3d axis = Sim(model).body_pose(body).R * joint.axis;
  const double lever = gravity_lever(model, info, body, 0);
  if (lever > kNoTorque) {
    out.right(text(msg::learn_box_swings, lever, fall.z_half, kBoxHalfWay));
  } else if (axis.head<2>().norm() < 1e-9) {
    out.wrong(text(msg::learn_box_vertical_hinge));
  } else if (gravity_lever(model, info, body, 0.5) > kNoTorque) {
    out.wrong(text(msg::learn_box_hangs));
  } else {
    out.wrong(text(msg::learn_box_no_lever));
  }
}

void judge_slide(const Model& model, const ModelInfo& info, int body, const BoxFall& fall,
                 LearnReport& out) {
  const JointInfo& joint = info.bodies[static_cast<std::size_t>(body)].joints.front();
  const Eigen::Vector3d axis = Sim(model).body_pose(body).R * joint.axis;
  if (std::abs(axis.dot(info.gravity)) < 1e-9) {
    out.wrong(text(msg::learn_box_level_slide, axis.x(), axis.y(), axis.z()));
  } else {
    out.right(text(msg::learn_box_slides, axis.x(), axis.y(), axis.z(), fall.z_start - fall.z_end));
  }
}

void judge_free(const BoxFall& fall, LearnReport& out) {
  if (!fall.touched) {
    out.right(text(msg::learn_box_falls_on, fall.z_start - fall.z_end, kBoxSeconds));
  } else {
    out.right(
        text(msg::learn_box_falls, fall.z_start - fall.z_end, *fall.touched, 1e3 * fall.depth));
  }
}

/// A tilt that most likely was meant in radians and read in degrees.
void tell_small_tilt(const Model& model, int body, LearnReport& out) {
  const Eigen::Matrix3d R = Sim(model).body_pose(body).R;
  const double tilt = angle_between(R, Eigen::Matrix3d::Identity()) * kDegPerRad;
  if (tilt > 1e-6 && tilt < kSmallTilt) out.note(text(msg::learn_box_small_tilt, tilt));
}

/// Angles that are most likely meant in the other unit.
Result<void> tell_angles(const std::string& file, LearnReport& out) {
  const Result<CheckReport> report = check_model(file);
  if (!report) return fail(report.error());
  for (const Finding& finding : report->findings) {
    if (finding.code == CheckCode::degrees_for_radians ||
        finding.code == CheckCode::radians_for_degrees) {
      out.note(text(msg::learn_box_angle, finding.line, finding.element, finding.what));
    }
  }
  return {};
}

}  // namespace

Result<LearnReport> check_box(const Exercise& exercise) {
  const Result<Model> model = Model::load(exercise.file);
  if (!model) return fail(model.error());
  const ModelInfo info = describe(*model);
  int body = 0;
  while (body < static_cast<int>(info.bodies.size()) &&
         info.bodies[static_cast<std::size_t>(body)].name != "box") {
    ++body;
  }
  LearnReport out;
  if (body == static_cast<int>(info.bodies.size())) {
    out.wrong(text(msg::learn_box_missing));
    return out;
  }
  const std::vector<JointInfo>& joints = info.bodies[static_cast<std::size_t>(body)].joints;
  if (joints.empty()) {
    out.wrong(text(msg::learn_box_fixed));
  } else {
    const Result<BoxFall> fall = let_fall(*model, body);
    if (!fall) return fail(fall.error());
    if (joints.size() > 1) {
      out.note(text(msg::learn_box_joints, joints.size(), fall->z_start, fall->z_end));
    } else if (joints.front().type == "free") {
      judge_free(*fall, out);
    } else if (joints.front().type == "slide") {
      judge_slide(*model, info, body, *fall, out);
    } else if (joints.front().type == "hinge") {
      judge_hinge(*model, info, body, *fall, out);
    } else {
      out.note(text(msg::learn_box_joints, joints.size(), fall->z_start, fall->z_end));
    }
  }
  tell_small_tilt(*model, body, out);
  if (Result<void> told = tell_angles(exercise.file, out); !told) return fail(told.error());
  return out;
}

}  // namespace mjarm::app
