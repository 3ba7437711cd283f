#include <algorithm>
#include <cmath>
#include <vector>

#include "apps/mjarm/demos/tutorial.hpp"
#include "apps/mjarm/learn/exercise.hpp"
#include "apps/mjarm/learn/python_solver.hpp"
#include "apps/mjarm/messages/learn.hpp"
#include "mjarm/execution/execution.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/model/dynamics.hpp"
#include "mjarm/trajectory/point_to_point.hpp"

namespace mjarm::app {
namespace {

constexpr double kSagShare = 0.03;       // of gravity / gain
constexpr double kSagNoise = 1e-4;       // [rad]
constexpr double kTellTorque = 0.1;      // [N m] joints that carry less are not told
constexpr double kNoStaticError = 1e-5;  // [m]

/// Where the arm stands in the end, and how far its tool is from where it should be.
struct RestedArm {
  JointVec q;
  double tool_error = 0;  // [m]
};

Result<RestedArm> drive_to(const Robot& robot, const MotionPlan& plan, ControlMode mode) {
  Sim sim(robot.model);
  sim.place(robot.arm, as_span(plan.q_start));
  Result<Execution> execution = Execution::create(robot.model, plan, {.control = mode, .rest = 3});
  if (!execution) return fail(execution.error());
  const Result<FollowOutcome> outcome = execution->run_to_end(sim);
  if (!outcome) return fail(outcome.error());
  return RestedArm{sim.arm_state(robot.arm).q, outcome->final_tool_error};
}

/// Each joint's gravity / gain beside what was measured.
void judge_sag(const Robot& robot, const JointVec& goal, const JointVec& rested, LearnReport& out) {
  Dynamics dynamics(robot.model);
  std::vector<double> qpos(robot.model.qpos0().begin(), robot.model.qpos0().end());
  for (int i = 0; i < robot.arm.dof(); ++i) {
    qpos[static_cast<std::size_t>(robot.arm.joints[static_cast<std::size_t>(i)].qpos)] = goal[i];
  }
  const Eigen::VectorXd& gravity = dynamics.gravity(qpos);
  for (int i = 0; i < robot.arm.dof(); ++i) {
    const ArmJoint& joint = robot.arm.joints[static_cast<std::size_t>(i)];
    const double torque = gravity[joint.dof], gain = joint.actuator->gain;
    const double expected = torque / gain, measured = goal[i] - rested[i];
    const bool good = std::abs(measured - expected) < kSagNoise + kSagShare * std::abs(expected);
    if (good && std::abs(torque) < kTellTorque) continue;
    const std::string line =
        text(msg::learn_sag_joint, joint.name, torque, gain, 1e3 * expected, 1e3 * measured);
    good ? out.right(line) : out.wrong(line);
  }
}

Result<LearnReport> measure_static_error() {
  const Result<Robot> robot = load_robot({.robot = "ur5e", .looks = false});
  if (!robot) return fail(robot.error());
  const std::vector<double> start = tutorial_seed();
  const auto goal = IkSolver(robot->arm).solve(tutorial_goal(), start);
  if (!goal) return fail(Errc::impossible, describe(goal.error(), robot->arm));
  Result<Trajectory> move = time_joint_move(start, as_span(goal->q), robot->arm.limits);
  if (!move) return fail(move.error());
  const MotionPlan plan = MotionPlan::of(robot->arm, std::move(*move));
  LearnReport out;
  const Result<RestedArm> servo = drive_to(*robot, plan, ControlMode::servo);
  if (!servo) return fail(servo.error());
  judge_sag(*robot, goal->q, servo->q, out);
  out.note(text(msg::learn_sag_servo, 1e3 * servo->tool_error));
  const Result<RestedArm> torque = drive_to(*robot, plan, ControlMode::computed_torque);
  if (!torque) return fail(torque.error());
  const std::string cured = text(msg::learn_sag_computed, 1e3 * torque->tool_error);
  torque->tool_error < kNoStaticError ? out.right(cured) : out.wrong(cured);
  return out;
}

}  // namespace

Result<LearnReport> check_static_error(const Exercise& exercise) {
  return exercise.file.empty() ? measure_static_error() : check_python_solver(exercise);
}

}  // namespace mjarm::app
