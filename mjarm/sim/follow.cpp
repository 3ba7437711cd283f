#include "mjarm/sim/follow.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "mjarm/control/actuation.hpp"
#include "mjarm/control/sag.hpp"
#include "mjarm/core/messages/sim.hpp"
#include "mjarm/sim/ghost_internal.hpp"
#include "mjarm/sim/stepper_internal.hpp"

namespace mjarm {
namespace {

using Followed = Result<FollowOutcome, FollowFailure>;

/// Joints slower than this stand still [rad/s or m/s].
constexpr double kStill = 1e-3;

/// A motion of so many joints is not one of this arm.
Followed other_arm(Eigen::Index joints, const Arm& arm) {
  return fail(FollowFailure{
      {}, Error{Errc::usage, text(msg::sim_other_arm, joints, arm.name, arm.dof())}, {}});
}

Followed broken(Error error, const Stepper& stepper) {
  return fail(FollowFailure{{}, std::move(error), stepper.outcome()});
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
    Ghost ghost(model, setup.arm);
    wait.sag = (ghost.tool(setup.sim, goal).p - ghost.tool(setup.sim, goal - sag).p).norm();
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
  Stepper stepper(setup);
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
        return fail(
            FollowFailure{explain(setup, stepper, waypoints[i], wait), {}, stepper.outcome()});
      }
      auto stepped = stepper.step(reference);
      if (!stepped) return broken(std::move(stepped.error()), stepper);
      if (!*stepped) return stepper.outcome();
      ++wait.steps;
      gap = gap_at(stepper, i);
    } while (gap.distance > tolerance);
    stepper.reached_one();
  }
  return stepper.outcome();
}

std::string cause_of(const FollowWait& wait, const Arm& arm) {
  switch (wait.cause) {
    case WaitCause::sag:
      if (wait.joint >= 0) {
        return text(msg::sim_wait_sag_joint, wait.sag, wait.torque, wait.stiffness);
      }
      return text(msg::sim_wait_sag_tool, wait.sag, wait.torque, wait.stiffness);
    case WaitCause::force_limit:
      return text(msg::sim_wait_force);
    case WaitCause::contact:
      return text(msg::sim_wait_contact, wait.contact->first, wait.contact->second);
    case WaitCause::moving:
      return text(msg::sim_wait_moving, arm.name);
    case WaitCause::unknown:
      break;
  }
  return text(msg::sim_wait_unknown);
}

}  // namespace

Followed follow_time(const FollowSetup& setup, const Trajectory& trajectory,
                     const TimeOptions& options) {
  if (trajectory.dof() != setup.arm.dof()) return other_arm(trajectory.dof(), setup.arm);
  const double h = setup.sim.model().timestep();
  const double end = trajectory.duration() + std::max(options.settle, 0.0);
  // Times are counted, not summed, so that a long run does not drift off its grid.
  const auto steps = static_cast<long long>(std::ceil(end / h - 1e-9));
  const auto q_at = [&](long long step) { return trajectory.at(static_cast<double>(step) * h).q; };
  Stepper stepper(setup);
  StepReference reference{q_at(-1), q_at(-1), q_at(0)};
  for (long long i = 0; i < steps; ++i) {
    reference = {reference.now, reference.next, q_at(i + 1)};
    auto stepped = stepper.step(reference);
    if (!stepped) return broken(std::move(stepped.error()), stepper);
    if (!*stepped) return stepper.outcome();
  }
  stepper.reached_one();
  return stepper.outcome();
}

Followed follow_joints(const FollowSetup& setup, std::span<const JointVec> waypoints,
                       const GateOptions& options) {
  return follow_gated(
      setup, waypoints, options.joint_tol, options.max_steps,
      [](const Stepper& stepper, std::size_t) { return joint_gap(stepper.error()); });
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
      wait.joint >= 0 ? text(msg::sim_wait_joint, wait.waypoint + 1, wait.count, wait.steps,
                             arm.joints[wait.joint].name, wait.distance, wait.tolerance)
                      : text(msg::sim_wait_tool, wait.waypoint + 1, wait.count, wait.steps, arm.tip,
                             wait.distance, wait.tolerance);
  return head + cause_of(wait, arm);
}

}  // namespace mjarm
