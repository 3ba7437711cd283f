// A pen that is pressed on paper: planned, executed and measured, on a sheet that is tilted by more
// than the plan knows.
#include <gmock/gmock.h>

#include <cmath>
#include <map>

#include "mjarm/execution/motion_run.hpp"
#include "mjarm/model/force_sensor.hpp"
#include "mjarm/program/program_plan.hpp"
#include "mjarm/program/program_reader.hpp"

namespace mjarm::program {
namespace {

using ::testing::HasSubstr;

constexpr const char* kPenHead =
    "scene: universal_robots_ur5e/calligraphy.xml\n"
    "tool: pen_tcp\n"
    "branch: {elbow: up}\n"
    "program:\n";

const Robot& pen_robot() {
  static const Robot kRobot = [] {
    const Program program =
        parse_program(std::string(kPenHead) + "  - wait: 0\n", "p.yaml").value();
    return load_program_robot(program, "p.yaml").value();
  }();
  return kRobot;
}

/// Strokes of `word` in the middle of the sheet, `above` the place that the plan takes it for.
ProgramPlan plan_of(const std::string& word, double above = 0) {
  const std::string text = std::string(kPenHead) + "  - text: {text: " + word +
                           ", pos: [-0.05, -0.5, " + std::to_string(0.08 + above) +
                           "], height: 60mm, press: 1, speed: 40mm/s, euler: [180deg, 0, 0]}\n";
  const Result<Program> program = parse_program(text, "p.yaml");
  EXPECT_TRUE(program.has_value()) << program.error().what;
  return plan_program(pen_robot().model, pen_robot().arm, *program);
}

/// A run with the sheet turned by so much about x and y [rad].
struct Written {
  MotionRun run{pen_robot().model, pen_robot().arm};
  Report report;

  Written(const ProgramPlan& plan, double pitch, double roll) {
    EXPECT_TRUE(plan.ok());
    std::vector<double> qpos(run.sim().qpos().begin(), run.sim().qpos().end());
    qpos[0] = pitch;
    qpos[1] = roll;
    run.sim().set_state(qpos, std::vector<double>(run.sim().qvel().size(), 0.0));
    const Result<void> done = run.execute(plan, ControlMode::tool_impedance);
    EXPECT_TRUE(done.has_value()) << done.error().what;
    report = run.report(plan, run.measured_runs(), 5e-4);
  }
  [[nodiscard]] double fact(const std::string& key) const {
    for (const Fact& one : report.facts) {
      if (one.name == "ink") return std::get<std::map<std::string, double>>(one.value).at(key);
    }
    return std::nan("");
  }
};

TEST(Press, TheForceSensorOfThePenIsFound) {
  const auto sensor = find_force_sensor(pen_robot().model, pen_robot().arm);
  ASSERT_TRUE(sensor.has_value());
  EXPECT_EQ(sensor->name, "pen_force");
  EXPECT_LT((sensor->R_TS - Eigen::Matrix3d::Identity()).norm(), 1e-9);
  // At rest, what hangs on it: 80 g.
  Sim sim(pen_robot().model);
  sim.reset_home();
  const std::vector<double> ctrl(sim.ctrl().begin(), sim.ctrl().end());
  for (int i = 0; i < 3000; ++i) ASSERT_TRUE(sim.step(ctrl).has_value());
  const double up = (sim.tool(pen_robot().arm).R * sensor->force(sim.sensor_data())).z();
  EXPECT_NEAR(up, 0.08 * 9.81, 1e-3);
  EXPECT_FALSE(find_force_sensor(load_robot("ur5e")->model, load_robot("ur5e")->arm).has_value());
}

TEST(Press, InkIsOnTheStrokesAndTheForceIsRight) {
  const Written level(plan_of("L"), 0, 0);
  EXPECT_TRUE(level.report.ok) << level.report.detail;
  ASSERT_EQ(level.run.strokes().size(), 1U);
  EXPECT_LT(level.fact("max"), 5e-4);
  EXPECT_GT(level.fact("force_min"), 0.9);
  EXPECT_LT(level.fact("force_max"), 1.1);
  EXPECT_GT(level.run.ink().size(), 1000U);
  EXPECT_NEAR(level.run.strokes()[0].depth, 0.02, 1e-3);
  // All of it counts, the pen's way down as well.
  EXPECT_NEAR(level.report.duration, level.run.sim().time(), 1e-6);
}

TEST(Press, ATiltThatThePlanDoesNotKnowChangesNeither) {
  const ProgramPlan plan = plan_of("TI");
  for (const double sign : {1.0, -1.0}) {
    const Written tilted(plan, sign * 0.0617, -0.0617);
    EXPECT_TRUE(tilted.report.ok) << tilted.report.detail;
    EXPECT_EQ(tilted.run.strokes().size(), 3U);
    EXPECT_LT(tilted.fact("max"), 5e-4);
    EXPECT_GT(tilted.fact("force_min"), 0.9);
    EXPECT_LT(tilted.fact("force_max"), 1.1);
    EXPECT_TRUE(tilted.report.first_contact.empty()) << tilted.report.first_contact;
  }
}

TEST(Press, NothingUnderThePenIsToldAndThePenComesBack) {
  const Written high(plan_of("I", 0.1), 0, 0);
  EXPECT_FALSE(high.report.ok);
  EXPECT_EQ(high.report.reason, "nothing_met");
  EXPECT_TRUE(high.run.ink().empty());
  EXPECT_LT(high.report.static_error->position, 1e-3);
}

TEST(Press, WhatItNeedsIsTold) {
  const ProgramPlan plan = plan_of("I");
  const auto stiff = Execution::create(pen_robot().model, plan, {});
  ASSERT_FALSE(stiff.has_value());
  EXPECT_THAT(stiff.error().what, HasSubstr("tool_impedance"));
  ProgramPlan bare = plan;
  const Robot ur5e = load_robot("ur5e").value();
  bare.arms = {ur5e.arm};
  const auto blind = Execution::create(ur5e.model, bare, {.control = ControlMode::tool_impedance});
  ASSERT_FALSE(blind.has_value());
  EXPECT_THAT(blind.error().what, HasSubstr("force sensor"));
}

}  // namespace
}  // namespace mjarm::program
