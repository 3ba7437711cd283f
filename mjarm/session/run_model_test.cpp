#include "mjarm/session/run_model.hpp"

#include <gmock/gmock.h>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/session/model_run_output.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::session {
namespace {

using ::testing::HasSubstr;

constexpr const char* kFalling = R"(<mujoco model="ball">
  <option timestep="0.001" gravity="0 0 -10"/>
  <worldbody><body pos="0 0 5"><freejoint name="ball"/><geom size="0.1"/></body></worldbody>
  <keyframe><key name="low" qpos="0 0 2 1 0 0 0"/><key name="high" qpos="0 0 9 1 0 0 0"/></keyframe>
</mujoco>)";
constexpr auto kGoOn = [](const Sim&, std::span<const double>) { return true; };

class RunModel : public ::testing::Test {
 protected:
  LanguageScope english_{Language::english};
  Model ball_ = Model::from_mjcf(kFalling).value();
};

TEST_F(RunModel, WhatHasAJointFallsAsNewtonSays) {
  Sim sim = start_model(ball_, {}).value();
  int looks = 0;
  const auto whole =
      run_model(sim, {.seconds = 0.5}, [&](const Sim&, auto) { return ++looks > 0; });
  ASSERT_TRUE(whole && *whole);
  EXPECT_EQ(looks, 501) << "before each step and at the end";
  EXPECT_NEAR(sim.time(), 0.5, 1e-9);
  // Semi-implicit Euler: the fall of n steps is g dt^2 n (n + 1) / 2.
  EXPECT_NEAR(sim.qpos()[2], 5 - 10 * 1e-6 * 500 * 501 / 2, 1e-9);
}

TEST_F(RunModel, StartsWhereItIsTold) {
  EXPECT_EQ(start_model(ball_, {.keyframe = "low"})->qpos()[2], 2);
  EXPECT_EQ(start_model(ball_, {})->qpos()[2], 5);
  const std::string both = kFalling, one = both.substr(0, both.find("<key name=\"high\"")) +
                                           "</keyframe></mujoco>";  // is home, whatever its name
  EXPECT_EQ(start_model(Model::from_mjcf(one).value(), {})->qpos()[2], 2);
  EXPECT_EQ(start_model(ball_, {.qpos = std::vector<double>{0, 0, 3, 1, 0, 0, 0}})->qpos()[2], 3);
  EXPECT_THAT(start_model(ball_, {.keyframe = "lwo"}).error().what, HasSubstr("\"low\""));
  EXPECT_EQ(start_model(ball_, {.qpos = std::vector<double>{1}}).error().what,
            "qpos has 1 values, the model 7");
}

/// A plain servo without a command of its own holds its arm, sagging by less than a degree or two.
TEST_F(RunModel, ServosHoldTheirArmWhereItStarts) {
  for (const char* name : {"ur5e", "panda"}) {
    const Robot robot = load_robot(name).value();
    std::vector<double> bent(robot.model.qpos0().begin(), robot.model.qpos0().end());
    for (int i = 0; i < robot.arm.dof(); ++i) {
      bent[static_cast<std::size_t>(robot.arm.joints[i].qpos)] = robot.arm.home[i] + 0.2;
    }
    for (const ModelStart& start : {ModelStart{}, ModelStart{.qpos = bent}}) {
      Sim sim = start_model(robot.model, start).value();
      const JointVec before = sim.arm_state(robot.arm).q;
      ASSERT_TRUE(run_model(sim, {.seconds = 1}, kGoOn)) << name;
      EXPECT_LT((sim.arm_state(robot.arm).q - before).cwiseAbs().maxCoeff(), 0.05) << name;
    }
  }
}

TEST_F(RunModel, AWishedEndIsNoError) {
  Sim sim = start_model(ball_, {}).value();
  const auto half =
      run_model(sim, {.seconds = 1}, [](const Sim& now, auto) { return now.time() < 0.25; });
  ASSERT_TRUE(half);
  EXPECT_FALSE(*half);
  EXPECT_NEAR(sim.time(), 0.25, 1e-9);
}

TEST_F(RunModel, AbsurdLengthsAreRefused) {
  for (const double seconds : {0.0, -1.0, 1e-9, 3601.0, 1e300}) {
    EXPECT_FALSE(check_run_length(ball_, seconds)) << seconds;
  }
  EXPECT_TRUE(check_run_length(ball_, 0.001));
  EXPECT_TRUE(check_run_length(ball_, 3600));
  const Model fine = Model::from_mjcf("<mujoco><option timestep=\"1e-6\"/></mujoco>").value();
  EXPECT_FALSE(check_run_length(fine, 200)) << "2e8 steps";
  EXPECT_THAT(check_run_length(fine, 200).error().what, HasSubstr("at most 100 s"));
}

TEST_F(RunModel, OneThatBecomesUnstableLeavesWhatThereWas) {
  const Model wild = Model::from_mjcf(R"(<mujoco model="wild">
    <option timestep="0.01"/>
    <worldbody><body><joint name="wild"/><geom size="0.1" pos="0.2 0 0"/></body></worldbody>
    <actuator><general joint="wild" gainprm="0" biastype="affine" biasprm="0 1e6 0"/></actuator>
  </mujoco>)")
                         .value();
  const support::TempFolder folder;
  const ModelRunOptions options{.start = {.qpos = std::vector<double>{0.1}}, .seconds = 5};
  const auto report =
      simulate_model(wild, options, {.out = folder.path() / "out", .timing = false});
  ASSERT_TRUE(report) << report.error().what;
  EXPECT_FALSE(report->ok);
  EXPECT_EQ(report->reason, "unstable");
  EXPECT_THAT(report->detail, HasSubstr("\"wild\""));
  EXPECT_GT(report->duration, 0);
  EXPECT_LT(report->duration, 5);
  for (const char* file : {"out/log.csv", "out/report.json", "out/plot.svg", "out/plot.png"}) {
    EXPECT_TRUE(folder.exists(file)) << file;
  }
  EXPECT_THAT(folder.read("out/report.json"), HasSubstr("\"reason\": \"unstable\""));
}

TEST_F(RunModel, PlotsWhatThereIsAndAtMostEightCurves) {
  std::string chain, ends;
  for (int i = 0; i < 12; ++i) {
    chain +=
        "<body pos=\"0 0 -0.1\"><joint axis=\"0 1 0\"/><geom size=\"0.02\" pos=\"0.1 0 0\" "
        "contype=\"0\"/>";
    ends += "</body>";
  }
  const Model model =
      Model::from_mjcf("<mujoco><worldbody>" + chain + ends + "</worldbody></mujoco>").value();
  Sim sim = start_model(model, {}).value();
  StateLog log(model);
  ASSERT_TRUE(run_model(sim, {.seconds = 0.2}, [&log](const Sim& now, auto ctrl) {
    log.record(now, ctrl);
    return true;
  }));
  const render::Plot plot = state_plot("chain", log);
  ASSERT_EQ(plot.panels.size(), 2U) << "angles and their speeds; no command, no sensor";
  for (const render::PlotPanel& panel : plot.panels) EXPECT_EQ(panel.lines.size(), 8U);
  // Of what only falls the turning speeds, which are noise, have no panel.
  Sim falling = start_model(ball_, {}).value();
  StateLog fall(ball_);
  ASSERT_TRUE(run_model(falling, {.seconds = 0.2}, [&fall](const Sim& now, auto ctrl) {
    fall.record(now, ctrl);
    return true;
  }));
  EXPECT_EQ(state_plot("ball", fall).panels.size(), 2U) << "places and their speeds";
  const Model still = Model::from_mjcf("<mujoco/>").value();
  EXPECT_TRUE(state_plot("", StateLog(still)).panels.empty());
}

}  // namespace
}  // namespace mjarm::session
