#include "mjarm/model/wrong_model.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <memory>

#include "mjarm/model/robot.hpp"

namespace mjarm {
namespace {

using WrongData = std::unique_ptr<mjData, void (*)(mjData*)>;

Robot wrong_robot(const char* name) { return load_robot(name).value(); }

TEST(WrongModel, IsOffByWhatIsAskedForAndNoMore) {
  const Robot robot = wrong_robot("panda");
  const mjModel& was = *robot.model.raw();
  Rng rng(4);
  bool lighter = false, heavier = false;
  for (int draw = 0; draw < 20; ++draw) {
    const Model wrong = wrong_model(robot.model, robot.arm, {}, rng).value();
    const mjModel& is = *wrong.raw();
    for (int body = 1; body < was.nbody; ++body) {
      const double factor = is.body_mass[body] / was.body_mass[body];
      const double off = (Eigen::Map<const Eigen::Vector3d>(is.body_ipos + 3 * body) -
                          Eigen::Map<const Eigen::Vector3d>(was.body_ipos + 3 * body))
                             .norm();
      if (was.body_weldid[body] == 0 || was.body_mass[body] == 0) {
        EXPECT_EQ(off, 0) << body;
        continue;
      }
      EXPECT_NEAR(off, 0.02, 1e-12) << body;
      EXPECT_GE(factor, 0.8);
      EXPECT_LE(factor, 1.2);
      lighter = lighter || factor < 0.9;
      heavier = heavier || factor > 1.1;
    }
    for (const ArmJoint& joint : robot.arm.joints) {
      EXPECT_GT(is.dof_frictionloss[joint.dof], 0);
    }
  }
  EXPECT_TRUE(lighter && heavier);
  EXPECT_EQ(was.dof_frictionloss[robot.arm.joints.front().dof], 0) << "the model itself stays";
}

TEST(WrongModel, FrictionHoldsUpToItsBoundAndYieldsAboveIt) {
  const Robot robot = wrong_robot("ur5e");
  const Robot driven = with_torque_drives(robot);
  Rng rng(1);
  const Model wrong = wrong_model(driven.model, driven.arm, {.mass = 0, .center = 0}, rng).value();
  const mjModel* m = wrong.raw();
  const WrongData d(mj_makeData(m), mj_deleteData);
  // Without gravity's torque: the first joint stands upright.
  const auto moved_by = [&](double torque_of_first) {
    mj_resetDataKeyframe(m, d.get(), 0);
    mju_zero(d->ctrl, static_cast<int>(m->nu));
    const double before = d->qpos[robot.arm.joints[0].qpos];
    d->ctrl[robot.arm.joints[0].actuator->id] = torque_of_first;
    for (int i = 0; i < 25; ++i) mj_step(m, d.get());
    return std::abs(d->qpos[robot.arm.joints[0].qpos] - before);
  };
  EXPECT_LT(moved_by(14), 2e-4);
  EXPECT_GT(moved_by(22), 2e-3);
}

TEST(WrongModel, SameSeedSameModel) {
  const Robot robot = wrong_robot("ur5e");
  Rng one(7), other(7), third(8);
  const auto masses = [&](Rng& rng) {
    const Model wrong = wrong_model(robot.model, robot.arm, {}, rng).value();
    return std::vector<double>(wrong.raw()->body_mass, wrong.raw()->body_mass + wrong.raw()->nbody);
  };
  const std::vector<double> first = masses(one);
  EXPECT_EQ(first, masses(other));
  EXPECT_NE(first, masses(third));
}

TEST(WrongModel, RefusesErrorsOutOfRange) {
  const Robot robot = wrong_robot("ur5e");
  Rng rng(1);
  EXPECT_FALSE(wrong_model(robot.model, robot.arm, {.mass = 1}, rng));
  EXPECT_FALSE(wrong_model(robot.model, robot.arm, {.center = -0.1}, rng));
  EXPECT_FALSE(wrong_model(robot.model, robot.arm, {.friction = std::nan("")}, rng));
}

TEST(TorqueDrives, GiveTheTorqueThatTheyAreTold) {
  const Robot robot = wrong_robot("panda");
  const Robot driven = with_torque_drives(robot);
  const mjModel* m = driven.model.raw();
  const WrongData d(mj_makeData(m), mj_deleteData);
  for (const ArmJoint& joint : driven.arm.joints) {
    const ArmActuator& actuator = *joint.actuator;
    EXPECT_EQ(actuator.gain, 1);
    EXPECT_EQ(actuator.bias[1], 0);
    for (const double torque : {3.0, -500.0}) {
      d->ctrl[actuator.id] = torque;
      mj_forward(m, d.get());
      EXPECT_DOUBLE_EQ(d->actuator_force[actuator.id], std::max(torque, actuator.force_lower));
    }
  }
}

}  // namespace
}  // namespace mjarm
