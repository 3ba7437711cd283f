#include "mjarm/execution/held_part.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mjarm/control/controller.hpp"
#include "mjarm/core/messages/execution.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/model/gripper_command.hpp"
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

}  // namespace

struct HeldPart::Impl {
  Arm arm;
  Sim sim;
  Controller controller;
  int part;
  StopCheck stop;
  IkSolver ik;
  StepReference reference;  ///< of the step that was done last
  std::vector<double> ctrl = {};

  [[nodiscard]] Pose in_tool() const { return sim.tool(arm).inverse() * sim.body_pose(part); }

  /// @param q  where the arm shall be after the step.
  Result<void> step_to(const JointVec& q) {
    if (is_stopped(stop)) return fail(stopped());
    reference = {reference.now, reference.next, q};
    controller.command(sim.qpos(), sim.qvel(), reference, ctrl);
    return sim.step(ctrl);
  }
  Result<void> stand() { return step_to(reference.next); }

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
    set_grip(*arm.gripper, 1, ctrl);
    for (const double end = sim.time() + kClosing; sim.time() < end;) {
      if (Result<void> done = stand(); !done) return done;
      sim.place_free(name, sim.tool(arm) * X_TB);
    }
    for (const double end = sim.time() + kSettling; sim.time() < end;) {
      if (Result<void> done = stand(); !done) return done;
    }
    return {};
  }

  /// @param where  where(t) [rad or m] is where the arm shall be at t [s] after the beginning.
  template <class Where>
  Result<Creep> watch(double seconds, const Where& where) {
    Creep out;
    const Pose X_TB = in_tool();
    const double begin = sim.time();
    for (Pose last = sim.body_pose(part); sim.time() < begin + seconds;) {
      const Result<JointVec> q = where(sim.time() + sim.model().timestep() - begin);
      if (!q) return fail(q.error());
      if (Result<void> done = step_to(*q); !done) return fail(done.error());
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
  const Result<int> body = number_of(robot, part);
  if (!body) return fail(body.error());
  Result<Controller> controller =
      Controller::create(robot.model, robot.arm, ControlMode::computed_torque);
  if (!controller) return fail(std::move(controller.error()));
  auto impl = std::make_unique<Impl>(Impl{robot.arm, Sim(robot.model), std::move(*controller),
                                          *body, std::move(stop), IkSolver(robot.arm),
                                          hold(as_span(robot.arm.home))});
  impl->sim.reset_home();
  impl->sim.place(robot.arm, as_span(robot.arm.home));
  if (Result<void> closed = impl->close(part, X_TB); !closed) {
    return fail(std::move(closed.error()));
  }
  return HeldPart(std::move(impl));
}

Pose HeldPart::in_tool() const { return impl_->in_tool(); }

Result<Creep> HeldPart::rest(double seconds) {
  const JointVec q = impl_->reference.next;
  return impl_->watch(seconds, [&](double) { return Result<JointVec>(q); });
}

Result<Creep> HeldPart::carry(double seconds) {
  Impl& own = *impl_;
  const Pose X_WT = fk(own.arm, as_span(own.reference.next));
  return own.watch(seconds, [&](double t) -> Result<JointVec> {
    const double share = std::min(t, 1.0);
    const double y = share * share * kAmplitude * std::sin(kMiddle / kAmplitude * t);
    const auto answer =
        own.ik.solve({X_WT.p + Eigen::Vector3d(0, y, 0), X_WT.R}, as_span(own.reference.next));
    if (!answer) return fail(Errc::impossible, describe(answer.error(), own.arm));
    return answer->q;
  });
}

}  // namespace mjarm
