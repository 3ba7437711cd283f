#include "mjarm/sim/batch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <numeric>
#include <vector>

#include "mjarm/core/rng.hpp"
#include "mjarm/model/dynamics.hpp"
#include "mjarm/sim/worlds_test.hpp"

namespace mjarm {
namespace {

using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using testing::load_shipped;
using testing::load_text;
using testing::Loaded;
using testing::small_world;

BatchSim batch_of(const Loaded& robot, int count, int threads = 1) {
  auto batch = BatchSim::create(robot.model, robot.arm, count, threads);
  if (!batch) throw std::runtime_error(batch.error().what);
  return std::move(*batch);
}

/// Commands near the initial state, another row for every world.
void command(BatchSim& batch, int world, Rng& rng) {
  for (double& ctrl : batch.ctrl(world)) ctrl = rng.uniform(-0.5, 0.5);
}

std::vector<int> all_of(const BatchSim& batch) {
  std::vector<int> worlds(batch.count());
  std::iota(worlds.begin(), worlds.end(), 0);
  return worlds;
}

TEST(BatchSim, StepsAsMjStepToTheLastBitForAnyThreads) {
  const Loaded robot = load_shipped("panda");
  const mjModel* m = robot.model.raw();
  for (const int threads : {1, 2, 4}) {
    SCOPED_TRACE(threads);
    BatchSim batch = batch_of(robot, 5, threads);
    std::vector<Rng> rngs;
    for (int world = 0; world < 5; ++world) rngs.emplace_back(7, world);
    for (int i = 0; i < 30; ++i) {
      for (int world = 0; world < 5; ++world) command(batch, world, rngs[world]);
      ASSERT_EQ(batch.step(20), 0);
    }
    for (int world = 0; world < 5; ++world) {
      mjData* d = mj_makeData(m);
      Rng rng(7, world);
      for (int i = 0; i < 30; ++i) {
        for (int k = 0; k < m->nu; ++k) d->ctrl[k] = rng.uniform(-0.5, 0.5);
        for (int k = 0; k < 20; ++k) mj_step(m, d);
      }
      EXPECT_THAT(batch.qpos(world), ElementsAreArray(d->qpos, m->nq));
      EXPECT_THAT(batch.qvel(world), ElementsAreArray(d->qvel, m->nv));
      EXPECT_EQ(batch.time(world), d->time);
      mj_deleteData(d);
    }
  }
}

TEST(BatchSim, IsASimInEveryReadAfterPlacesAndSteps) {
  const Loaded robot = load_text(small_world());
  BatchSim batch = batch_of(robot, 3, 2);
  Sim sim(robot.model);
  Dynamics dynamics(robot.model);
  Rng rng(3);
  // The second world starts with its hand in the floor, so that there are contacts to be counted.
  std::vector<double> qpos(robot.model.qpos0().begin(), robot.model.qpos0().end());
  qpos[robot.arm.joints[0].qpos] = 1.2;
  const std::vector<double> ctrl{1.2, 0};
  const std::vector<int> second{1};
  batch.place(second, qpos, ctrl);
  const std::vector<double> still(sim.qvel().size(), 0.0);
  sim.set_ctrl(0, 1.2);
  sim.set_state(qpos, still);
  EXPECT_GT(batch.contacts(1), 0);
  EXPECT_EQ(batch.contacts(0), 0) << "the box that lies on the floor is not the arm";
  for (int i = 0; i < 50; ++i) {
    EXPECT_THAT(batch.qpos(1), ElementsAreArray(sim.qpos()));
    EXPECT_THAT(batch.qvel(1), ElementsAreArray(sim.qvel()));
    EXPECT_EQ(batch.tool(1).p, sim.tool(robot.arm).p);
    EXPECT_EQ(batch.tool(1).R, sim.tool(robot.arm).R);
    EXPECT_EQ(batch.contacts(1) > 0, !sim.contacts(robot.arm).empty());
    const Eigen::VectorXd& bias = dynamics.bias(sim.qpos(), sim.qvel());
    for (int dof = 0; dof < robot.model.nv(); ++dof) {
      EXPECT_NEAR(batch.bias(1)[dof], bias[dof], 1e-9);
    }
    EXPECT_EQ(batch.snapshot(1).state, sim.snapshot().state);
    command(batch, 0, rng);
    command(batch, 1, rng);
    const std::vector<double> now(batch.ctrl(1).begin(), batch.ctrl(1).end());
    ASSERT_EQ(batch.step(3), 0);
    for (int k = 0; k < 3; ++k) ASSERT_TRUE(sim.step(now));
  }
}

TEST(BatchSim, FingersThatTouchEachOtherDoNotCount) {
  const Loaded robot = load_shipped("panda");
  Sim sim(robot.model);
  sim.place(robot.arm, as_span(robot.arm.home));
  std::vector<double> qpos(sim.qpos().begin(), sim.qpos().end());
  for (std::size_t i = robot.arm.dof(); i < qpos.size(); ++i) qpos[i] = -0.001;  // pressed together
  sim.set_state(qpos, sim.qvel());
  EXPECT_FALSE(sim.contacts(robot.arm).empty());
  for (const Contact& contact : sim.contacts(robot.arm)) {
    EXPECT_THAT(contact.first, HasSubstr("pad"));
    EXPECT_THAT(contact.second, HasSubstr("pad"));
  }
  BatchSim batch = batch_of(robot, 2);
  EXPECT_GT(batch.contacts(0), 0) << "the hand is in the forearm where all joints are 0";
  const std::vector<int> second{1};
  batch.place(second, sim.qpos(), sim.ctrl());
  EXPECT_EQ(batch.contacts(1), 0);
}

TEST(BatchSim, GoesOnFromAStateToTheLastBit) {
  const Loaded robot = load_shipped("panda");
  BatchSim batch = batch_of(robot, 4, 2);
  Rng rng(5);
  const auto go_on = [](BatchSim& worlds, Rng random) {
    for (int i = 0; i < 10; ++i) {
      for (int world = 0; world < worlds.count(); ++world) command(worlds, world, random);
      EXPECT_EQ(worlds.step(7), 0);
    }
    return worlds.state();
  };
  go_on(batch, rng);
  const std::vector<double> middle = batch.state();
  const std::vector<double> end = go_on(batch, Rng(6));
  EXPECT_NE(end, middle);
  for (const int threads : {1, 4}) {
    BatchSim other = batch_of(robot, 4, threads);
    ASSERT_TRUE(other.set_state(middle));
    EXPECT_EQ(other.state(), middle);
    EXPECT_EQ(go_on(other, Rng(6)), end);
  }
  // Also from a state that was just placed, where the accelerations have been computed.
  const std::vector<int> worlds = all_of(batch);
  std::vector<double> qpos, ctrl;
  for (int i = 0; i < 4; ++i) {
    qpos.insert(qpos.end(), robot.model.qpos0().begin(), robot.model.qpos0().end());
    ctrl.insert(ctrl.end(), robot.model.nu(), 0.1);
  }
  batch.place(worlds, qpos, ctrl);
  const std::vector<double> placed = batch.state();
  const std::vector<double> after = go_on(batch, Rng(8));
  BatchSim other = batch_of(robot, 4);
  ASSERT_TRUE(other.set_state(placed));
  EXPECT_EQ(go_on(other, Rng(8)), after);

  EXPECT_FALSE(other.set_state(std::vector<double>(3)));
  EXPECT_EQ(other.state(), after);
}

/// A light joint under a servo far too stiff for the time step.
constexpr const char* kWild = R"(<mujoco><option timestep="0.05" integrator="Euler"/>
  <worldbody><body><joint name="wild" axis="0 0 1"/><geom size="0.01" pos="0.1 0 0" mass="0.01"/>
    <site name="tool"/></body></worldbody>
  <actuator><position joint="wild" kp="50000"/></actuator>
</mujoco>)";

TEST(BatchSim, AWorldThatFailsIsReportedAndTheOthersGoOn) {
  const Loaded robot = load_text(kWild);
  for (const int threads : {1, 2}) {
    BatchSim batch = batch_of(robot, 3, threads);
    batch.ctrl(1)[0] = 0.1;  // at 0 the servo has nothing to do
    int failures = 0;
    for (int i = 0; i < 200; ++i) failures += batch.step(2);
    EXPECT_EQ(failures, 1);
    EXPECT_TRUE(batch.failed(1));
    EXPECT_THAT(batch.error(1), HasSubstr("\"wild\""));
    for (const int calm : {0, 2}) {
      EXPECT_FALSE(batch.failed(calm));
      EXPECT_TRUE(batch.error(calm).empty());
      EXPECT_NEAR(batch.time(calm), 400 * 0.05, 1e-9);
    }
    // It says so after a restart as well, and stands until it is placed anew.
    ASSERT_TRUE(batch.set_state(batch.state()));
    EXPECT_TRUE(batch.failed(1));
    const double time = batch.time(1);
    EXPECT_EQ(batch.step(1), 0);
    EXPECT_EQ(batch.time(1), time);
    const std::vector<int> worlds{1};
    const std::vector<double> zero{0};
    batch.place(worlds, zero, zero);
    EXPECT_FALSE(batch.failed(1));
    EXPECT_TRUE(batch.error(1).empty());
    EXPECT_EQ(batch.step(4), 0);
    EXPECT_NEAR(batch.time(1), 0.2, 1e-12);
  }
  EXPECT_FALSE(std::filesystem::exists("MUJOCO_LOG.TXT"));
}

TEST(BatchSim, ACtrlThatIsNoNumberFailsItsWorldAlone) {
  const Loaded robot = load_text(small_world());
  BatchSim batch = batch_of(robot, 2);
  batch.ctrl(0)[1] = std::nan("");
  EXPECT_EQ(batch.step(1), 1);
  EXPECT_TRUE(batch.failed(0));
  EXPECT_THAT(batch.error(0), HasSubstr("\"elbow\""));
  EXPECT_FALSE(batch.failed(1));
}

TEST(BatchSim, MocapBodiesStandWhereTheyAreToldTo) {
  const Loaded robot = load_text(
      small_world("integrator=\"implicitfast\"", "400",
                  R"(<body name="ball" mocap="true" pos="0 0 5"><geom size="0.1"/></body>)"));
  BatchSim batch = batch_of(robot, 2);
  const std::vector<int> worlds = all_of(batch);
  std::vector<double> qpos, ctrl(4, 0.0);
  for (int i = 0; i < 2; ++i) {
    qpos.insert(qpos.end(), robot.model.qpos0().begin(), robot.model.qpos0().end());
  }
  // In the way of the arm in the second world, out of it in the first.
  batch.place(worlds, qpos, ctrl, std::vector<double>{0, 0, 5, 0.7, 0, 0.6});
  EXPECT_EQ(batch.contacts(0), 0);
  EXPECT_GT(batch.contacts(1), 0);
  batch.place(worlds, qpos, ctrl);
  EXPECT_EQ(batch.contacts(1), 0);
}

TEST(BatchSim, RefusesNumbersOutOfRange) {
  const Loaded robot = load_text(small_world());
  for (const auto& [count, threads] : {std::pair{0, 1}, {-3, 1}, {1000000, 1}, {1, 0}, {1, 5000}}) {
    const auto batch = BatchSim::create(robot.model, robot.arm, count, threads);
    ASSERT_FALSE(batch);
    EXPECT_EQ(batch.error().code, Errc::usage);
  }
}

}  // namespace
}  // namespace mjarm
