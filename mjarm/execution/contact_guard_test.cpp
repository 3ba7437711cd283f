#include "mjarm/execution/contact_guard.hpp"

#include <gtest/gtest.h>

#include "mjarm/execution/execution_test.hpp"
#include "mjarm/execution/motion_run.hpp"
#include "mjarm/model/moved_bodies.hpp"
#include "mjarm/trajectory/trajectory.hpp"

namespace mjarm {
namespace {

using testing::load_shipped;
using testing::Loaded;
using testing::shifted;

/// A joint move of the UR5e within its limits, about two seconds long.
MotionPlan move_of(const Arm& arm) {
  const JointVec there = shifted(arm.home, 0.6);
  return MotionPlan::of(
      arm,
      time_joint_move(as_span(arm.home), as_span(there), arm.limits, {.joint_share = 0.5}).value());
}

/// What became of a run in which the forearm was pushed at 0.4 s.
struct PushedRun {
  std::optional<FeltContact> felt = {};
  Report report = {};
  double acceleration = 0, jerk = 0;  ///< of the commanded positions, over the limits
  double back = 0;                    ///< [m] of the tool, from where it stopped
};
PushedRun run_pushed(const Loaded& robot, const Eigen::Vector3d& force_W, ContactReaction reaction,
                     ControlMode mode = ControlMode::computed_torque) {
  constexpr double kFrom = 0.4, kTo = 0.5;  // [s]
  const MotionPlan plan = move_of(robot.arm);
  MotionRun run(robot.model, robot.arm);
  run.set_contact(reaction);
  const int body = moved_bodies(robot.model, robot.arm)[3].body;
  run.set_after_step([&](const Sim& sim, MotionPart) {
    const bool on = sim.time() >= kFrom && sim.time() < kTo;
    run.sim().set_external_force(body, on ? force_W : Eigen::Vector3d::Zero(),
                                 Eigen::Vector3d::Zero());
    return true;
  });
  PushedRun out;
  EXPECT_TRUE(run.execute(plan, mode));
  out.felt = run.felt();
  out.report = run.report(plan, run.measured_runs(), 5e-4);
  const double h = robot.model.timestep();
  std::vector<JointVec> q;
  for (std::size_t i = 0; i < run.recorder().size(); ++i) q.push_back(run.recorder().row(i).q_ref);
  const JointLimits& limits = robot.arm.limits;
  for (std::size_t i = 3; i < q.size(); ++i) {
    const JointVec a = (q[i] - 2 * q[i - 1] + q[i - 2]) / (h * h);
    const JointVec before = (q[i - 1] - 2 * q[i - 2] + q[i - 3]) / (h * h);
    out.acceleration =
        std::max(out.acceleration, a.cwiseAbs().cwiseQuotient(limits.acceleration).maxCoeff());
    out.jerk =
        std::max(out.jerk, ((a - before) / h).cwiseAbs().cwiseQuotient(limits.jerk).maxCoeff());
  }
  return out;
}

TEST(ContactGuard, APushStopsTheRunWithinItsLimitsAndIsTold) {
  const Loaded robot = load_shipped("ur5e");
  for (const ControlMode mode : {ControlMode::computed_torque, ControlMode::robust}) {
    const PushedRun run = run_pushed(robot, {25, 0, 20}, ContactReaction::stop, mode);
    ASSERT_TRUE(run.felt) << name(mode);
    EXPECT_GE(run.felt->time, 0.4);
    EXPECT_LE(run.felt->time, 0.42 + 1e-9);
    EXPECT_GT(run.felt->force, 10);
    EXPECT_LT(run.felt->force, 100);
    EXPECT_FALSE(run.report.ok);
    EXPECT_EQ(run.report.reason, "contact");
    EXPECT_NE(run.report.detail.find(run.felt->link), std::string::npos) << run.report.detail;
    EXPECT_LE(run.acceleration, 1.001);
    // The plan itself is at its limit of jerk when it is pushed.
    EXPECT_LE(run.jerk, 1.25 + 1e-6);
  }
}

TEST(ContactGuard, WithoutAPushNothingIsNoticed) {
  const Loaded robot = load_shipped("ur5e");
  for (const ControlMode mode :
       {ControlMode::servo, ControlMode::servo_gravity, ControlMode::feed_forward,
        ControlMode::computed_torque, ControlMode::robust, ControlMode::joint_impedance}) {
    EXPECT_FALSE(run_pushed(robot, {0, 0, 0}, ContactReaction::stop, mode).felt) << name(mode);
  }
}

TEST(ContactGuard, IgnoredContactsChangeNothing) {
  const PushedRun run = run_pushed(load_shipped("ur5e"), {25, 0, 20}, ContactReaction::ignore);
  EXPECT_FALSE(run.felt);
  EXPECT_NE(run.report.reason, "contact");
}

TEST(ContactGuard, ReactionsHaveNames) {
  EXPECT_EQ(contact_reaction("stop").value(), ContactReaction::stop);
  EXPECT_EQ(name(contact_reaction("ignore").value()), "ignore");
  EXPECT_FALSE(contact_reaction("halt"));
}

TEST(MotionClock, BrakesInFewerStepsThanItStops) {
  const Loaded robot = load_shipped("ur5e");
  const MotionPlan plan = move_of(robot.arm);
  MotionClock clock(plan, robot.model.timestep());
  clock.run();
  for (int i = 0; i < 150; ++i) (void)clock.next();
  clock.brake(robot.arm.limits);
  int steps = 0;
  while (clock.state() == MotionClock::State::stopping) {
    (void)clock.next();
    ++steps;
  }
  EXPECT_EQ(clock.state(), MotionClock::State::stopped);
  EXPECT_LT(steps, MotionClock::kBrakeSteps);
  EXPECT_GT(steps, 5);
}

}  // namespace
}  // namespace mjarm
