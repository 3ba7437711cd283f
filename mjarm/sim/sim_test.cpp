#include "mjarm/sim/sim.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <thread>

#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/sim/worlds_test.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using testing::load_shipped;
using testing::load_text;
using testing::Loaded;
using testing::small_world;

struct DeleteData {
  void operator()(mjData* d) const { mj_deleteData(d); }
};
using Data = std::unique_ptr<mjData, DeleteData>;

std::vector<double> random_ctrl(const Model& model, Rng& rng) {
  std::vector<double> ctrl(model.nu());
  for (double& u : ctrl) u = rng.uniform(-1, 1);
  return ctrl;
}

/// MuJoCo's own data at the state of `sim`, everything recomputed.
Data recomputed(const Sim& sim) {
  const mjModel* m = sim.model().raw();
  Data d(mj_makeData(m));
  mj_setState(m, d.get(), sim.snapshot().state.data(), mjSTATE_INTEGRATION);
  mj_forward(m, d.get());
  return d;
}

/// Every read that depends on positions and velocities is that of the state it stands in.
void expect_fresh(const Sim& sim, const Loaded& robot) {
  const mjModel* m = sim.model().raw();
  const Data d = recomputed(sim);
  const int site = mj_name2id(m, mjOBJ_SITE, robot.arm.tip.c_str());
  const Pose X_WT = sim.tool(robot.arm);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(X_WT.p[i], d->site_xpos[3 * site + i]);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(X_WT.R(i / 3, i % 3), d->site_xmat[9 * site + i]);
  for (int i = 0; i < m->nsensordata; ++i) EXPECT_EQ(sim.sensor_data()[i], d->sensordata[i]);
  EXPECT_EQ(sim.contacts().empty(), d->ncon == 0);
}

/// Two free bodies without gravity: a ball of 4 kg and a box of 2 kg.
constexpr const char* kFreeBodies = R"(
<mujoco>
  <option gravity="0 0 0" integrator="Euler" timestep="0.01"/>
  <worldbody>
    <body name="ball"><freejoint/>
      <inertial pos="0.1 0 0" mass="4" diaginertia="0.5 0.5 0.5"/></body>
    <body name="box" pos="0 3 0"><freejoint/>
      <inertial pos="0 0 0" mass="2" diaginertia="0.1 0.2 0.3"/></body>
  </worldbody>
</mujoco>)";

Model free_bodies() {
  const support::TempFolder folder;
  return Model::load(folder.write("free.xml", kFreeBodies)).value();
}

TEST(Sim, AnExternalForceActsAtTheCentreOfMassUntilItIsCleared) {
  const Model model = free_bodies();
  Sim sim(model);
  const int steps = 50;
  const double dt = model.timestep();
  sim.set_external_force(1, {2, 0, -1}, {0, 0, 0});
  sim.set_external_force(2, {0, 0, 0}, {0, 0, 0.6});
  for (int i = 0; i < steps; ++i) ASSERT_TRUE(sim.step({}));
  // v = F t / m, without turning: the force goes through the centre of mass. w = M t / I.
  EXPECT_NEAR(sim.qvel()[0], 2 * steps * dt / 4, 1e-12);
  EXPECT_NEAR(sim.qvel()[2], -1 * steps * dt / 4, 1e-12);
  for (int i = 3; i < 6; ++i) EXPECT_NEAR(sim.qvel()[i], 0, 1e-12);
  EXPECT_NEAR(sim.qvel()[11], 0.6 * steps * dt / 0.3, 1e-9);
  sim.clear_external_forces();
  const std::vector<double> before(sim.qvel().begin(), sim.qvel().end());
  for (int i = 0; i < steps; ++i) ASSERT_TRUE(sim.step({}));
  for (int i = 0; i < 12; ++i) EXPECT_NEAR(sim.qvel()[i], before[i], 1e-9) << i;
}

TEST(Sim, APushThatIsOverLeavesNoTraceInTheNextRun) {
  const Loaded robot = load_text(small_world());
  Sim sim(robot.model);
  Sim untouched(robot.model);
  const std::vector<double> ctrl(robot.model.nu(), 0.1);
  sim.set_external_force(1, {3, 1, 2}, {0, 1, 0});
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(sim.step(ctrl));
  const Snapshot pushed = sim.snapshot();
  ASSERT_TRUE(sim.reset());
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(sim.step(ctrl));
    ASSERT_TRUE(untouched.step(ctrl));
  }
  EXPECT_EQ(sim.snapshot().state, untouched.snapshot().state);
  EXPECT_NE(sim.snapshot().state, pushed.state);
}

TEST(Sim, ReadsAreFreshAfterEveryWrite) {
  const Loaded robot = load_text(small_world());
  Sim sim(robot.model);
  expect_fresh(sim, robot);
  ASSERT_TRUE(sim.reset("home"));
  expect_fresh(sim, robot);
  sim.place(robot.arm, std::vector<double>{0.3, -0.8});
  expect_fresh(sim, robot);
  std::vector<double> qpos(sim.qpos().begin(), sim.qpos().end());
  const std::vector<double> qvel(sim.qvel().size(), 0.1);
  qpos.back() = 1.2;
  sim.set_state(qpos, qvel);
  expect_fresh(sim, robot);
  const Snapshot snapshot = sim.snapshot();
  Rng rng(1);
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(sim.step(random_ctrl(robot.model, rng)));
    expect_fresh(sim, robot);
  }
  ASSERT_TRUE(sim.restore(snapshot));
  expect_fresh(sim, robot);
}

TEST(Sim, StepsAsMjStepToTheLastBit) {
  for (const char* integrator : {"Euler", "RK4", "implicit", "implicitfast", "discrete"}) {
    SCOPED_TRACE(integrator);
    const Loaded robot = load_text(small_world("integrator=\"" + std::string(integrator) + "\""));
    const mjModel* m = robot.model.raw();
    const Data d(mj_makeData(m));
    Sim sim(robot.model);
    Rng rng(2);
    for (int i = 0; i < 500; ++i) {
      const std::vector<double> ctrl = random_ctrl(robot.model, rng);
      ASSERT_TRUE(sim.step(ctrl));
      std::copy(ctrl.begin(), ctrl.end(), d->ctrl);
      mj_step(m, d.get());
    }
    EXPECT_EQ(sim.time(), d->time);
    EXPECT_THAT(sim.qpos(), ElementsAreArray(d->qpos, m->nq));
    EXPECT_THAT(sim.qvel(), ElementsAreArray(d->qvel, m->nv));
    EXPECT_THAT(sim.actuator_force(), ElementsAreArray(d->actuator_force, m->nu));
  }
}

TEST(Sim, ReadingDoesNotChangeWhatComes) {
  const Loaded robot = load_shipped("panda");
  Sim read(robot.model);
  Sim left(robot.model);
  Rng rng(3);
  for (int i = 0; i < 300; ++i) {
    const std::vector<double> ctrl = random_ctrl(robot.model, rng);
    ASSERT_TRUE(read.step(ctrl));
    ASSERT_TRUE(left.step(ctrl));
    (void)read.tool(robot.arm);
    (void)read.contacts();
    (void)read.arm_state(robot.arm);
    (void)read.snapshot();
  }
  EXPECT_EQ(read.snapshot().state, left.snapshot().state);
}

TEST(Sim, GoesOnFromASnapshotToTheLastBit) {
  const Loaded robot = load_text(small_world());
  Sim sim(robot.model);
  ASSERT_TRUE(sim.reset("home"));
  Rng rng(4);
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(sim.step(random_ctrl(robot.model, rng)));
  const Snapshot middle = sim.snapshot();
  const Rng there = rng;
  const auto go_on = [&](Sim& world) {
    Rng again = there;
    for (int i = 0; i < 200; ++i) EXPECT_TRUE(world.step(random_ctrl(robot.model, again)));
    return world.snapshot();
  };
  const Snapshot end = go_on(sim);
  EXPECT_NE(end.state, middle.state);
  ASSERT_TRUE(sim.restore(middle));
  EXPECT_EQ(go_on(sim).state, end.state);
  Sim other(robot.model);
  ASSERT_TRUE(other.restore(middle));
  EXPECT_EQ(go_on(other).state, end.state);

  const auto foreign = other.restore({.time = 0, .state = {1, 2, 3}});
  ASSERT_FALSE(foreign);
  EXPECT_THAT(foreign.error().what, HasSubstr("another model"));
}

TEST(Sim, ThreadsDoNotMatter) {
  const Loaded robot = load_shipped("ur5e");
  std::vector<Snapshot> ends(4);
  {
    std::vector<std::jthread> threads;
    for (Snapshot& end : ends) {
      threads.emplace_back([&robot, &end] {
        Sim sim(robot.model);
        Rng rng(5);
        for (int i = 0; i < 300; ++i) EXPECT_TRUE(sim.step(random_ctrl(robot.model, rng)));
        end = sim.snapshot();
      });
    }
  }
  for (const Snapshot& end : ends) EXPECT_EQ(end.state, ends[0].state);
}

TEST(Sim, PlaceSetsTheCtrlThatKeepsTheServosThere) {
  const Loaded robot = load_text(small_world());
  Sim sim(robot.model);
  const std::vector<double> q{-0.4, 0.9};
  sim.place(robot.arm, q);
  EXPECT_THAT(sim.ctrl(), ElementsAreArray(q));
  EXPECT_EQ(sim.arm_state(robot.arm).q, joint_vec(q));
  EXPECT_EQ(sim.arm_state(robot.arm).v, JointVec::Zero(2));
  EXPECT_EQ(sim.arm_torque(robot.arm), JointVec::Zero(2));
}

TEST(Sim, PlacesWhatIsFreeAndNothingElse) {
  const Loaded robot = load_text(small_world());
  Sim sim(robot.model);
  const std::vector<double> before(sim.qpos().begin(), sim.qpos().end());
  sim.place_free("upper", {{7, 7, 7}, Eigen::Matrix3d::Identity()});
  sim.place_free("none", {{7, 7, 7}, Eigen::Matrix3d::Identity()});
  EXPECT_THAT(sim.qpos(), ElementsAreArray(before));
  sim.place_free("box", {{0.1, 0.2, 0.3}, to_matrix(Quat(0, 1, 0, 0))});
  const std::vector<double> placed{0.1, 0.2, 0.3, 0, 1, 0, 0};
  EXPECT_THAT(sim.qpos().first(7), ElementsAreArray(placed));
  EXPECT_THAT(sim.qpos().subspan(7),
              ElementsAreArray(std::vector<double>(before.begin() + 7, before.end())));
}

TEST(Sim, NamesContactsAndTellsTheArmsFromOthers) {
  const Loaded robot = load_text(small_world());
  Sim sim(robot.model);
  ASSERT_TRUE(sim.reset("home"));
  for (int i = 0; i < 50; ++i) ASSERT_TRUE(sim.step(std::vector<double>{-0.5, 1}));
  const auto resting = sim.contacts();
  ASSERT_EQ(resting.size(), 1U);
  EXPECT_EQ(resting[0].first, "floor");
  EXPECT_EQ(resting[0].second, "box");
  EXPECT_GE(resting[0].depth, 0);
  EXPECT_TRUE(sim.contacts(robot.arm).empty());

  sim.place(robot.arm, std::vector<double>{1.2, 0});
  const auto touching = sim.contacts(robot.arm);
  ASSERT_EQ(touching.size(), 1U);
  EXPECT_EQ(touching[0].first, "floor");
  EXPECT_EQ(touching[0].second, "lower") << "its geom has no name, so the body's is used";
  EXPECT_GT(touching[0].depth, 0.01);
}

TEST(Sim, WhatOverlapsByDesignIsNoContactOfTheArm) {
  const Loaded robot =
      load_text(small_world("integrator=\"implicitfast\"", "400",
                            R"(<geom name="knob" type="sphere" size="0.1" pos="0 0 0.6"/>)"));
  Sim sim(robot.model);
  sim.place(robot.arm, std::vector<double>{-0.5, 1});
  const auto all = sim.contacts();
  EXPECT_TRUE(std::ranges::any_of(all, [&](const Contact& contact) {
    return contact.first == "knob" && contact.second == "upper" && is_by_design(robot.arm, contact);
  })) << "the simulation has it";
  EXPECT_TRUE(sim.contacts(robot.arm).empty());
  sim.place(robot.arm, std::vector<double>{-0.5, 3});
  const auto folded = sim.contacts(robot.arm);
  EXPECT_TRUE(std::ranges::any_of(folded, [](const Contact& contact) {
    return contact.first == "knob" && contact.second == "lower";
  })) << "what meets it in some postures still counts";
}

/// A light joint under a servo far too stiff for the time step.
std::string exploding_world(const std::string& flag) {
  return R"(<mujoco><option timestep="0.05" integrator="Euler"><flag )" + flag + R"(/></option>
  <worldbody>
    <body name="ball" pos="3 0 0"><freejoint name="calm"/><geom size="0.1"/></body>
    <body><joint name="wild" axis="0 0 1"/><geom size="0.01" pos="0.1 0 0" mass="0.01"/>
      <site name="tool"/></body>
  </worldbody>
  <actuator><position joint="wild" kp="50000"/></actuator>
</mujoco>)";
}

TEST(Sim, InstabilityIsAnErrorAndNeverASilentReset) {
  for (const char* flag : {"autoreset=\"enable\"", "autoreset=\"disable\""}) {
    SCOPED_TRACE(flag);
    const Loaded robot = load_text(exploding_world(flag));
    Sim sim(robot.model);
    const std::vector<double> ctrl{0.1};
    Result<void> stepped;
    double before = 0;
    for (int i = 0; i < 1000 && stepped; ++i) {
      before = sim.time();
      stepped = sim.step(ctrl);
      for (const double q : sim.qpos()) ASSERT_TRUE(std::isfinite(q));
    }
    ASSERT_FALSE(stepped);
    EXPECT_EQ(stepped.error().code, Errc::impossible);
    EXPECT_THAT(stepped.error().what, HasSubstr("\"wild\""));
    EXPECT_GT(before, 0);
    // Back at the start, and usable again.
    EXPECT_EQ(sim.time(), 0);
    EXPECT_THAT(sim.qpos(), ElementsAreArray(robot.model.qpos0()));
    EXPECT_TRUE(sim.step(ctrl));
  }
  EXPECT_FALSE(std::filesystem::exists("MUJOCO_LOG.TXT"));
}

TEST(Sim, RefusesACtrlThatIsNoNumber) {
  const Loaded robot = load_text(small_world());
  Sim sim(robot.model);
  const Snapshot before = sim.snapshot();
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    const auto stepped = sim.step(std::vector<double>{0, bad});
    ASSERT_FALSE(stepped);
    EXPECT_THAT(stepped.error().what, HasSubstr("\"elbow\""));
    EXPECT_EQ(sim.snapshot().state, before.state);
  }
}

TEST(Sim, UnknownKeyframeNamesTheNearest) {
  const Loaded robot = load_text(small_world());
  Sim sim(robot.model);
  const auto reset = sim.reset("hom");
  ASSERT_FALSE(reset);
  EXPECT_THAT(reset.error().what, HasSubstr("did you mean \"home\""));
  EXPECT_THAT(reset.error().what, HasSubstr("arm.xml"));
}

}  // namespace
}  // namespace mjarm
