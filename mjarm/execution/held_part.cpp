#include "mjarm/execution/held_part.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mjarm/control/actuation.hpp"
#include "mjarm/core/messages/execution.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/model/scene_bodies.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm {
namespace {

constexpr double kClosing = 0.8;     // [s] until the fingers press with all their force
constexpr double kSettling = 1;      // [s] until arm and part hang still
constexpr double kAmplitude = 0.15;  // [m] of the way to and fro
constexpr double kMiddle = 0.5;      // [m/s] in the middle of it

/// The number of the body that is to be held.
Result<int> number_of(const Robot& robot, std::string_view part) {
  std::vector<std::string> names;
  for (const SceneObject& object : scene_bodies(robot.model, robot.arm).objects) {
    if (object.name == part) return object.body;
    names.push_back(object.name);
  }
  return fail(Errc::bad_input, text(msg::execution_no_part, part, did_you_mean(part, names)));
}

bool has_servos(const Arm& arm) {
  return std::ranges::all_of(arm.joints, [](const ArmJoint& joint) {
    return joint.actuator && servo_stiffness(*joint.actuator) > 0;
  });
}

}  // namespace

struct HeldPart::Impl {
  Arm arm;
  Sim sim;
  int part;
  StopCheck stop;
  IkSolver ik;
  JointVec q;  ///< where the arm is sent
  std::vector<double> ctrl = {};

  [[nodiscard]] Pose in_tool() const { return sim.tool(arm).inverse() * sim.body_pose(part); }

  Result<void> step() {
    if (is_stopped(stop)) return fail(stopped());
    return sim.step(ctrl);
  }

  /// What the part touches.
  [[nodiscard]] std::optional<std::string> neighbour() const {
    for (const Contact& contact : sim.contacts()) {
      if (contact.body1 == part) return contact.second;
      if (contact.body2 == part) return contact.first;
    }
    return {};
  }

  Result<void> close(std::string_view name, const Pose& X_TB) {
    sim.place_free(name, sim.tool(arm) * X_TB);
    if (const auto other = neighbour()) {
      return fail(Errc::bad_input, text(msg::execution_part_blocked, name, *other));
    }
    ctrl.assign(sim.ctrl().begin(), sim.ctrl().end());
    ctrl[static_cast<std::size_t>(arm.gripper->id)] = arm.gripper->ctrl_closed;
    for (const double end = sim.time() + kClosing; sim.time() < end;) {
      if (Result<void> done = step(); !done) return done;
      sim.place_free(name, sim.tool(arm) * X_TB);
    }
    for (const double end = sim.time() + kSettling; sim.time() < end;) {
      if (Result<void> done = step(); !done) return done;
    }
    return {};
  }

  /// @param command  command(t) changes ctrl, t [s] after the beginning.
  template <class Command>
  Result<Creep> watch(double seconds, const Command& command) {
    Creep out;
    const Pose X_TB = in_tool();
    const double begin = sim.time();
    for (Pose last = sim.body_pose(part); sim.time() < begin + seconds;) {
      if (Result<void> done = command(sim.time() - begin); !done) return fail(done.error());
      if (Result<void> done = step(); !done) return fail(done.error());
      const Pose X_WB = sim.body_pose(part), now = in_tool();
      out.moved = std::max(out.moved, (now.p - X_TB.p).norm());
      out.turned = std::max(out.turned, angle_between(now.R, X_TB.R));
      out.fastest = std::max(out.fastest, (X_WB.p - last.p).norm() / sim.model().timestep());
      last = X_WB;
    }
    return out;
  }
};

HeldPart::HeldPart(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
HeldPart::~HeldPart() = default;
HeldPart::HeldPart(HeldPart&&) noexcept = default;
HeldPart& HeldPart::operator=(HeldPart&&) noexcept = default;

Result<HeldPart> HeldPart::grip(const Robot& robot, std::string_view part, const Pose& X_TB,
                                StopCheck stop) {
  if (!robot.arm.gripper) return fail(Errc::bad_input, text(msg::execution_no_gripper));
  if (!has_servos(robot.arm)) return fail(Errc::bad_input, text(msg::execution_no_servos));
  const Result<int> body = number_of(robot, part);
  if (!body) return fail(body.error());
  auto impl = std::make_unique<Impl>(Impl{robot.arm, Sim(robot.model), *body, std::move(stop),
                                          IkSolver(robot.arm), robot.arm.home});
  impl->sim.reset_home();
  impl->sim.place(robot.arm, as_span(robot.arm.home));
  if (Result<void> closed = impl->close(part, X_TB); !closed) {
    return fail(std::move(closed.error()));
  }
  return HeldPart(std::move(impl));
}

Pose HeldPart::in_tool() const { return impl_->in_tool(); }

Result<Creep> HeldPart::rest(double seconds) {
  return impl_->watch(seconds, [](double) { return Result<void>(); });
}

Result<Creep> HeldPart::carry(double seconds) {
  Impl& own = *impl_;
  const Pose X_WT = fk(own.arm, as_span(own.q));
  return own.watch(seconds, [&](double t) -> Result<void> {
    const double share = std::min(t, 1.0);
    const double y = share * share * kAmplitude * std::sin(kMiddle / kAmplitude * t);
    const auto answer = own.ik.solve({X_WT.p + Eigen::Vector3d(0, y, 0), X_WT.R}, as_span(own.q));
    if (!answer) return fail(Errc::impossible, describe(answer.error(), own.arm));
    own.q = answer->q;
    for (int i = 0; i < own.arm.dof(); ++i) {
      const ArmActuator& drive = *own.arm.joints[static_cast<std::size_t>(i)].actuator;
      own.ctrl[static_cast<std::size_t>(drive.id)] = ctrl_for_torque(drive, 0, own.q[i], 0);
    }
    return {};
  });
}

}  // namespace mjarm
