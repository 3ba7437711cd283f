#include "mjarm/execution/motion_run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "mjarm/execution/execution_test.hpp"
#include "mjarm/trajectory/tool_down_test.hpp"

namespace mjarm {
namespace {

using ::testing::HasSubstr;
using testing::kDown;
using testing::load_shipped;
using testing::load_text;
using testing::Loaded;
using testing::shifted;
using testing::small_world;
using testing::there_and_half_back;

constexpr ControlMode kMode = ControlMode::computed_torque;
constexpr double kTolerance = 5e-4;  // [m]

/// A line of 0.2 m in front of the UR5e.
struct Line {
  Loaded robot = load_shipped("ur5e");
  ToolMotion motion = plan_tool_motion(IkSolver(robot.arm), line_from({{0.1, -0.45, 0.4}, kDown}),
                                       as_span(robot.arm.home))
                          .value();

  static Curve line_from(const Pose& X) {
    return Curve::line(X, {X.p - Eigen::Vector3d(0.2, 0, 0), X.R}).value();
  }

  /// An approach to it from home, and the line.
  [[nodiscard]] MotionPlan plan() const {
    const Arm& arm = robot.arm;
    MotionPlan plan = MotionPlan::of(
        arm,
        time_joint_move(as_span(arm.home), as_span(motion.path.q.front()), arm.limits).value());
    plan.moves.front().word = "approach";
    plan.moves.push_back(
        {.word = "movel", .place = {7, 5}, .trajectory = motion.trajectory, .curve = motion.curve});
    return plan;
  }
};

TEST(MotionRun, ReportsWhatAPlanDid) {
  const Line line;
  const MotionPlan plan = line.plan();
  MotionRun run(line.robot.model, line.robot.arm);
  ASSERT_TRUE(run.execute(plan, kMode));
  const std::vector<MeasuredRun> runs = run.measured_runs();
  ASSERT_EQ(runs.size(), 1U) << "the approach is not measured";
  EXPECT_GE(runs.front().rows.front().time, plan.moves.front().trajectory.duration() - 1e-9);
  const Report report = run.report(plan, runs, kTolerance);
  EXPECT_TRUE(report.ok) << report.detail;
  EXPECT_EQ(report.model, line.robot.model.name());
  EXPECT_EQ(report.steps, run.outcome().steps);
  EXPECT_NEAR(report.duration, plan.duration() + kRestAtEnd, 0.01);
  ASSERT_TRUE(report.path_error);
  EXPECT_LT(report.path_error->max, 1e-6);
  EXPECT_EQ(report.done, report.path_error->coverage);
  EXPECT_GT(report.done, 0.999);
  EXPECT_NEAR(report.tool_speed_max.value(), 0.25, 1e-3);
  EXPECT_LT(report.static_error.value().position, 1e-6);
  ASSERT_EQ(report.moves.size(), 2U);
  EXPECT_FALSE(report.moves[0].path_error);
  EXPECT_EQ(report.moves[1].line, 7);
  EXPECT_EQ(report.moves[1].path_error->max, report.path_error->max);
}

TEST(MotionRun, TheReportComesBackFromItsFile) {
  const Line line;
  const MotionPlan plan = line.plan();
  MotionRun run(line.robot.model, line.robot.arm);
  ASSERT_TRUE(run.execute(plan, kMode));
  const Report report = run.report(plan, run.measured_runs(), kTolerance);
  const auto json = nlohmann::json::parse(to_json(report));
  EXPECT_EQ(json["ok"], true);
  EXPECT_EQ(json["duration"].get<double>(), report.duration);
  EXPECT_EQ(json["coverage"].get<double>(), report.done);
  EXPECT_EQ(json["path_error_max"].get<double>(), report.path_error->max);
  EXPECT_EQ(json["path_error_at"].get<double>(), report.path_error->at);
  EXPECT_EQ(json["static_error"]["rotation"].get<double>(), report.static_error->rotation);
  EXPECT_EQ(json["limits_used"]["torque"].get<double>(), report.torque_use);
  EXPECT_EQ(json["cycle_time"].get<double>(), plan.duration());
  ASSERT_EQ(json["moves"].size(), 2U);
  EXPECT_FALSE(json["moves"][0].contains("path_error_max"));
  EXPECT_EQ(json["moves"][1]["instruction"], "movel");
}

TEST(MotionRun, WithdrawsOkWhereATargetIsMissed) {
  const Line line;
  MotionRun run(line.robot.model, line.robot.arm);
  run.start_at(as_span(line.motion.path.q.front()));
  ASSERT_TRUE(run.follow(line.motion.trajectory, ControlMode::servo, 0.3, &line.motion.curve));
  const Report off_path = run.report(run.measured_runs(), kTolerance);
  EXPECT_FALSE(off_path.ok);
  EXPECT_EQ(off_path.reason, "path_error");
  EXPECT_GT(off_path.path_error->max, 0.003) << "servos sag";

  MotionRun still(line.robot.model, line.robot.arm);
  ASSERT_TRUE(still.jump(line.robot.arm.home, kMode, 0.1));
  Report known;
  known.static_error = PoseError{.position = 0.1};
  const Report off_goal = still.report(still.measured_runs(), kTolerance, known);
  EXPECT_EQ(off_goal.reason, "static_error");
  EXPECT_THAT(off_goal.detail, HasSubstr("100 mm"));
}

TEST(MotionRun, SaysWhenAnArmIsTooWeakForItsPath) {
  std::string weak = small_world();
  for (std::size_t at = 0; (at = weak.find("-60 60", at)) != std::string::npos;) {
    weak.replace(at, 6, "-2 2");
  }
  const Loaded robot = load_text(weak);
  MotionRun run(robot.model, robot.arm);
  ASSERT_TRUE(run.jump(robot.arm.home, kMode, 0.1));
  Report known;
  known.static_error = PoseError{.position = 0.1};
  const Report report = run.report(run.measured_runs(), kTolerance, known);
  EXPECT_THAT(report.detail, HasSubstr("100 % of the steps an actuator was at its limit"));
}

TEST(MotionRun, OnceStoppedNothingMovesAnyMore) {
  const Loaded robot = load_text(small_world());
  MotionRun run(robot.model, robot.arm);
  run.set_after_step([](const Sim& sim, MotionPart) { return sim.time() < 0.1; });
  const MotionPlan plan = there_and_half_back(robot.arm);
  ASSERT_TRUE(run.execute(plan, kMode));
  EXPECT_TRUE(run.ended_early());
  const long long steps = run.outcome().steps;
  const double time = run.sim().time();
  EXPECT_NEAR(time, 0.1, 0.003);
  ASSERT_TRUE(run.approach(as_span(robot.arm.home), kMode));
  ASSERT_TRUE(run.jump(robot.arm.home, kMode, 1));
  ASSERT_TRUE(run.wait_through(std::vector{robot.arm.home}, {}, kMode));
  EXPECT_EQ(run.outcome().steps, steps);
  EXPECT_EQ(run.sim().time(), time);
  const Report report = run.report(plan, run.measured_runs(), kTolerance);
  EXPECT_FALSE(report.ok);
  EXPECT_EQ(report.reason, "stopped");
  EXPECT_FALSE(report.static_error);
  EXPECT_EQ(report.done, 0);
}

TEST(MotionRun, AWaypointNeverReachedEndsItWithItsReason) {
  const Loaded robot = load_text(small_world("integrator=\"implicitfast\"", "100"));
  MotionRun run(robot.model, robot.arm);
  run.start_at(as_span(robot.arm.home));
  const std::vector<JointVec> goals{robot.arm.home, JointVec::Zero(2)};
  ASSERT_TRUE(run.wait_through(goals, {}, ControlMode::servo));
  EXPECT_TRUE(run.ended_early());
  const Report report = run.report(run.measured_runs(), kTolerance);
  EXPECT_EQ(report.reason, "waypoint_not_reached");
  EXPECT_THAT(report.detail, HasSubstr("sags"));
  EXPECT_EQ(run.measured_runs().size(), 1U);
}

TEST(MotionRun, ABrokenSimulationIsAnError) {
  const Loaded robot = load_text(small_world("timestep=\"0.05\" integrator=\"Euler\"", "20000"));
  MotionRun run(robot.model, robot.arm);
  run.start_at(as_span(robot.arm.home));
  const auto done = run.jump(JointVec::Zero(2), ControlMode::servo, 9);
  ASSERT_FALSE(done);
  EXPECT_THAT(done.error().what, HasSubstr("unstable"));
}

TEST(MotionRun, TellsApproachesFromWhatIsMeasured) {
  const Loaded robot = load_text(small_world());
  MotionRun run(robot.model, robot.arm);
  run.start_at(as_span(robot.arm.home));
  int measured = 0, other = 0;
  run.set_after_step([&](const Sim&, MotionPart part) {
    return ++(part != MotionPart::approach ? measured : other) > 0;
  });
  const JointVec there = shifted(robot.arm.home, 0.1);
  ASSERT_TRUE(run.approach(as_span(there), kMode));
  EXPECT_EQ(measured, 0);
  EXPECT_GT(other, 100) << "with a rest at its end";
  ASSERT_TRUE(run.jump(there, kMode, 0.2));
  EXPECT_EQ(measured, 100);
  EXPECT_EQ(run.measured_runs().size(), 1U);
  EXPECT_EQ(run.measured_runs().front().rows.size(), 101U)
      << "of the two rows at the border the second one";
}

TEST(MeasuredRuns, ErrorsOfSeveralCurvesAreWeighedByRowsAndLengths) {
  const auto line = [](double length) {
    Pose to;
    to.p.x() = length;
    return Curve::line({}, to).value();
  };
  const Curve shorter = line(1), longer = line(3);
  MeasuredRun a{.rows = std::vector<RecordRow>(1), .curve = &shorter};
  a.error = PathError{.max = 1, .rms = 1, .at = 0.5, .coverage = 1};
  MeasuredRun b{.rows = std::vector<RecordRow>(3), .curve = &longer};
  b.error = PathError{.max = 2, .rms = 2, .at = 2.5, .coverage = 0.5};
  const auto all = path_error(std::vector{a, b, MeasuredRun{}});
  ASSERT_TRUE(all);
  EXPECT_EQ(all->max, 2);
  EXPECT_EQ(all->at, 2.5);
  EXPECT_NEAR(all->rms, std::sqrt((1 + 3 * 4) / 4.0), 1e-15);
  EXPECT_NEAR(all->coverage, 2.5 / 4, 1e-15);
  EXPECT_FALSE(path_error(std::vector{MeasuredRun{}}));
  EXPECT_FALSE(max_tool_speed(std::vector{MeasuredRun{}}));
}

TEST(MeasuredRuns, AnotherToolIsMeasuredWhereItIs) {
  const Loaded robot = load_text(small_world());
  Sim sim(robot.model);
  Recorder recorder(robot.model, robot.arm);
  recorder.record(sim, robot.arm.home);
  const Pose X_TU{{0, 0, 0.1}, Eigen::Matrix3d::Identity()};
  const std::vector<MeasuredSpan> spans{{.X_TU = X_TU}};
  const auto runs = measured_runs(recorder, spans);
  ASSERT_EQ(runs.size(), 1U);
  ASSERT_EQ(runs[0].rows.size(), 1U);
  EXPECT_LT((runs[0].rows[0].X_WT.p - (sim.tool(robot.arm) * X_TU).p).norm(), 1e-15);
  EXPECT_FALSE(runs[0].error);
}

/// A second execution begins where the first one began: no run holds the jump back to there.
TEST(MotionRun, RunsEndWhereTheArmIsPutSomewhereElse) {
  const Loaded robot = load_text(small_world());
  const JointVec home = robot.arm.home;
  const MotionPlan plan = MotionPlan::of(
      robot.arm,
      time_joint_move(as_span(home), as_span(shifted(home, 0.5)), robot.arm.limits).value());
  MotionRun run(robot.model, robot.arm);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(run.execute(plan, kMode));
  const std::vector<MeasuredRun> runs = run.measured_runs();
  ASSERT_EQ(runs.size(), 3U);
  for (const MeasuredRun& one : runs) {
    ASSERT_GT(one.rows.size(), 100U);
    EXPECT_LT((one.rows.front().q - home).cwiseAbs().maxCoeff(), 0.01);
    for (std::size_t i = 1; i < one.rows.size(); ++i) {
      ASSERT_LT((one.rows[i].q - one.rows[i - 1].q).cwiseAbs().maxCoeff(), 0.02) << i;
    }
  }
}

TEST(MotionPlan, JointMovesBetweenCurvesAreTravel) {
  const Line line;
  MotionPlan plan = line.plan();
  plan.moves.push_back({.word = "movej", .trajectory = plan.moves.front().trajectory});
  EXPECT_EQ(plan.part(0), MotionPart::approach);
  EXPECT_EQ(plan.part(1), MotionPart::work);
  EXPECT_EQ(plan.part(2), MotionPart::travel);
  plan.moves.erase(plan.moves.begin(), plan.moves.begin() + 2);
  EXPECT_EQ(plan.part(0), MotionPart::work) << "all that the plan is about";
}

}  // namespace
}  // namespace mjarm
