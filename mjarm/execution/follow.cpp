#include "mjarm/execution/follow.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "mjarm/control/actuation.hpp"
#include "mjarm/control/sag.hpp"
#include "mjarm/core/messages/execution.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm {
namespace {

using Followed = Result<FollowOutcome, FollowFailure>;

/// Joints slower than this stand still [rad/s or m/s].
constexpr double kStill = 1e-3;

/// A motion of so many joints is not one of this arm.
Followed other_arm(Eigen::Index joints, const Arm& arm) {
  return fail(FollowFailure{
      {}, Error{Errc::usage, text(msg::execution_other_arm, joints, arm.name, arm.dof())}, {}});
}

/// What is waited for at a waypoint: how far it is, and which joint holds things up (-1: the tool).
struct Gap {
  double distance = 0;
  int joint = -1;
};

Gap joint_gap(const JointVec& error) {
  int worst = 0;
  const double distance = error.cwiseAbs().maxCoeff(&worst);
  return {distance, worst};
}

/// Fills in what the servo's sag explains of the gap.
void explain_sag(const FollowSetup& setup, const JointVec& goal, FollowWait& wait) {
  if (setup.controller.mode() != ControlMode::servo) return;
  const Model& model = setup.sim.model();
  const JointVec sag = static_sag(model, setup.arm, setup.sim.qpos());
  int joint = wait.joint;
  if (joint >= 0) {
    wait.sag = std::abs(sag[joint]);
  } else {
    const JointVec hanging = goal - sag;
    wait.sag = (fk(setup.arm, as_span(goal)).p - fk(setup.arm, as_span(hanging)).p).norm();
    sag.cwiseAbs().maxCoeff(&joint);
  }
  wait.stiffness = servo_stiffness(*setup.arm.joints[joint].actuator);
  wait.torque = std::abs(sag[joint]) * wait.stiffness;
}

FollowWait explain(const FollowSetup& setup, const Stepper& stepper, const JointVec& goal,
                   FollowWait wait) {
  explain_sag(setup, goal, wait);
  const auto contacts = setup.sim.contacts(setup.arm);
  if (!contacts.empty()) wait.contact = contacts.front();
  const JointVec v = setup.sim.arm_state(setup.arm).v;
  if (stepper.limited()) {
    wait.cause = WaitCause::force_limit;
  } else if (v.cwiseAbs().maxCoeff() > kStill) {
    wait.cause = WaitCause::moving;
  } else if (wait.contact) {
    wait.cause = WaitCause::contact;
  } else if (wait.sag > wait.tolerance) {
    wait.cause = WaitCause::sag;
  }
  return wait;
}

/// The gated followers: `gap_at(i)` measures how far waypoint i is.
template <class GapAt>
Followed follow_gated(const FollowSetup& setup, std::span<const JointVec> waypoints,
                      double tolerance, int max_steps, const GapAt& gap_at) {
  for (const JointVec& q : waypoints) {
    if (q.size() != setup.arm.dof()) return other_arm(q.size(), setup.arm);
  }
  Stepper stepper(setup.sim, setup.arm);
  const auto outcome = [&] { return stepper.outcome(setup.sim); };
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    const StepReference reference = hold(as_span(waypoints[i]));
    FollowWait wait;
    wait.waypoint = i;
    wait.count = waypoints.size();
    wait.tolerance = tolerance;
    Gap gap;
    do {
      if (wait.steps == max_steps) {
        wait.joint = gap.joint;
        wait.distance = gap.distance;
        return fail(FollowFailure{explain(setup, stepper, waypoints[i], wait), {}, outcome()});
      }
      auto stepped = stepper.step(setup.sim, setup.controller, reference, setup.recorder);
      if (!stepped) return fail(FollowFailure{{}, std::move(stepped.error()), outcome()});
      if (setup.after_step && !setup.after_step(setup.sim)) {
        FollowOutcome stopped = outcome();
        stopped.stopped = true;
        return stopped;
      }
      ++wait.steps;
      gap = gap_at(stepper, i);
    } while (gap.distance > tolerance);
    stepper.reached_one();
  }
  return outcome();
}

std::string cause_of(const FollowWait& wait, const Arm& arm) {
  switch (wait.cause) {
    case WaitCause::sag:
      if (wait.joint >= 0) {
        return text(msg::execution_wait_sag_joint, wait.sag, wait.torque, wait.stiffness);
      }
      return text(msg::execution_wait_sag_tool, wait.sag, wait.torque, wait.stiffness);
    case WaitCause::force_limit:
      return text(msg::execution_wait_force);
    case WaitCause::contact:
      return text(msg::execution_wait_contact, wait.contact->first, wait.contact->second);
    case WaitCause::moving:
      return text(msg::execution_wait_moving, arm.name);
    case WaitCause::unknown:
      break;
  }
  return text(msg::execution_wait_unknown);
}

}  // namespace

Followed follow_joints(const FollowSetup& setup, std::span<const JointVec> waypoints,
                       const GateOptions& options) {
  return follow_gated(
      setup, waypoints, options.joint_tol, options.max_steps,
      [&](const Stepper& stepper, std::size_t) { return joint_gap(stepper.error(setup.sim)); });
}

Followed follow_tool(const FollowSetup& setup, std::span<const JointVec> waypoints,
                     std::span<const Eigen::Vector3d> points, const GateOptions& options) {
  assert(waypoints.size() == points.size());
  return follow_gated(setup, waypoints, options.tool_tol, options.max_steps,
                      [&](const Stepper&, std::size_t i) {
                        return Gap{(setup.sim.tool(setup.arm).p - points[i]).norm(), -1};
                      });
}

std::string describe(const FollowFailure& failure, const Arm& arm) {
  if (failure.error) return failure.error->what;
  if (!failure.wait) return {};
  const FollowWait& wait = *failure.wait;
  const std::string head =
      wait.joint >= 0 ? text(msg::execution_wait_joint, wait.waypoint + 1, wait.count, wait.steps,
                             arm.joints[wait.joint].name, wait.distance, wait.tolerance)
                      : text(msg::execution_wait_tool, wait.waypoint + 1, wait.count, wait.steps,
                             arm.tip, wait.distance, wait.tolerance);
  return head + cause_of(wait, arm);
}

}  // namespace mjarm
