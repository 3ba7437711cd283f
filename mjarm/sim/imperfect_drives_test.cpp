#include "mjarm/sim/imperfect_drives.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "mjarm/model/robot.hpp"

namespace mjarm {
namespace {

Robot driven_robot() { return load_robot("ur5e").value(); }

TEST(ImperfectDrives, EncodersHaveStepsAndVelocitiesAreTheirDifferences) {
  const Robot robot = driven_robot();
  const DriveFaults faults{.encoder_step = 1e-3};
  ImperfectDrives drives(robot.arm, faults, 0.002, Rng(1));
  std::vector<double> q(robot.model.nq(), 0.4567891), v(robot.model.nv(), 9.0);
  drives.read(q, v);
  const ArmJoint& joint = robot.arm.joints[2];
  EXPECT_NEAR(drives.qpos()[joint.qpos], 0.457, 1e-12);
  EXPECT_EQ(drives.qvel()[joint.dof], 0) << "nothing was read before";
  q[joint.qpos] += 0.0031;
  drives.read(q, v);
  EXPECT_NEAR(drives.qpos()[joint.qpos], 0.46, 1e-12);
  EXPECT_NEAR(drives.qvel()[joint.dof], 0.003 / 0.002, 1e-9);
}

TEST(ImperfectDrives, CommandsComeLateAndTheFirstOneCountsForBefore) {
  const Robot robot = driven_robot();
  ImperfectDrives drives(robot.arm, {.noise = 0, .late_steps = 3}, 0.002, Rng(1));
  const int id = robot.arm.joints[0].actuator->id;
  for (int i = 0; i < 20; ++i) {
    std::vector<double> ctrl(robot.model.nu(), 10.0 + i);
    drives.pass(ctrl);
    EXPECT_EQ(ctrl[id], 10.0 + std::max(0, i - 3)) << i;
  }
}

TEST(ImperfectDrives, TorquesAreAsNoisyAsAskedForAndTheSameForOneSeed) {
  const Robot robot = driven_robot();
  ImperfectDrives one(robot.arm, {.noise = 0.02}, 0.002, Rng(3)),
      same(robot.arm, {.noise = 0.02}, 0.002, Rng(3));
  const int id = robot.arm.joints[4].actuator->id;
  constexpr int kDraws = 20000;
  double sum = 0, sum2 = 0;
  for (int i = 0; i < kDraws; ++i) {
    std::vector<double> ctrl(robot.model.nu(), -50.0), other = ctrl;
    one.pass(ctrl);
    same.pass(other);
    ASSERT_EQ(ctrl, other);
    sum += ctrl[id] + 50;
    sum2 += (ctrl[id] + 50) * (ctrl[id] + 50);
  }
  EXPECT_NEAR(sum / kDraws, 0, 0.04);
  EXPECT_NEAR(std::sqrt(sum2 / kDraws), 1, 0.03);
}

}  // namespace
}  // namespace mjarm
