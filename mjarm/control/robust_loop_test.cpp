#include "mjarm/control/robust_loop.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>

#include "mjarm/control/robots_test.hpp"
#include "mjarm/control/world_test.hpp"
#include "mjarm/core/rng.hpp"

/// The robust controller against MuJoCo with another model than its own: loads, dry friction, late
/// commands and encoders with steps.
namespace mjarm {
namespace {

using testing::controller_of;
using ::testing::HasSubstr;
using testing::load_shipped;
using testing::Loaded;
using testing::swing_reference;
using testing::World;

constexpr double kEncoderStep = 1.7453292519943295e-4;  // [rad] 0.01 deg
constexpr int kLate = 2;

/// Drives `world` by swing_reference() for `steps` through encoders with steps and with commands
/// that are late as torques.
class LateWorld {
 public:
  LateWorld(const Loaded& robot, double friction, double load) : robot_(robot) {
    world_.emplace(robot, robot.arm.home);
    mjModel& m = world_->m();
    for (int i = 0; i < robot.arm.dof(); ++i) {
      const ArmJoint& joint = robot.arm.joints[i];
      m.dof_frictionloss[joint.dof] = friction * robot.arm.limits.torque[i];
      m.dof_solref[mjNREF * joint.dof] = 2 * robot.model.timestep();
      const int id = joint.actuator->id;
      mju_zero(m.actuator_biasprm + mjNBIAS * id, mjNBIAS);
      m.actuator_gainprm[mjNGAIN * id] = 1;
      m.actuator_ctrllimited[id] = 0;
    }
    const int last =
        m.jnt_bodyid[mj_name2id(&m, mjOBJ_JOINT, robot.arm.joints.back().name.c_str())];
    m.body_mass[last] += load;
    mj_setConst(&m, &world_->d());
    for (int i = 0; i < robot.arm.dof(); ++i) {
      world_->d().qpos[robot.arm.joints[i].qpos] = robot.arm.home[i];
    }
  }

  /// Largest joint error against the reference of `kLate` steps ago, from `from` seconds on.
  double worst(Controller& controller, int steps, double from) {
    mjModel& m = world_->m();
    mjData& d = world_->d();
    const Arm& arm = robot_.arm;
    double worst = 0;
    std::deque<std::vector<double>> late;
    for (int i = 0; i < steps; ++i) {
      const double h = robot_.model.timestep();
      std::vector<double> q(d.qpos, d.qpos + m.nq), v(m.nv, 0.0), ctrl(d.ctrl, d.ctrl + m.nu);
      for (const ArmJoint& joint : arm.joints) {
        q[joint.qpos] = kEncoderStep * std::round(q[joint.qpos] / kEncoderStep);
      }
      controller.command(q, v, swing_reference(arm, i, h), ctrl);
      while (late.size() <= kLate) late.push_back(ctrl);
      std::copy(late.front().begin(), late.front().end(), d.ctrl);
      late.pop_front();
      mj_step(&m, &d);
      if (i * h < from) continue;
      const JointVec goal = swing_reference(arm, i - kLate, h).next;
      worst = std::max(worst, (world_->q() - goal).cwiseAbs().maxCoeff());
    }
    return worst;
  }

 private:
  const Loaded& robot_;
  std::optional<World> world_;
};

/// The robot as its controller knows it: torque drives.
Loaded torque_robot(const char* name) {
  Loaded robot = load_shipped(name);
  for (ArmJoint& joint : robot.arm.joints) {
    joint.actuator->gain = 1;
    std::fill_n(joint.actuator->bias, 3, 0.0);
    joint.actuator->ctrl_lower = -1e9;
    joint.actuator->ctrl_upper = 1e9;
  }
  return robot;
}

TEST(Robust, FollowsThroughFrictionLoadAndDelay) {
  const Loaded robot = torque_robot("ur5e");
  const ControlOptions late{.robust = {.late_steps = kLate}};
  Controller robust = controller_of(robot, ControlMode::robust, late);
  const double with = LateWorld(robot, 0.1, 1).worst(robust, 4000, 4);
  Controller plain = controller_of(robot, ControlMode::computed_torque, late);
  const double without = LateWorld(robot, 0.1, 1).worst(plain, 4000, 4);
  EXPECT_LT(with, 1.5e-3);
  EXPECT_GT(without, 5 * with);
}

TEST(Robust, LearnsTheFrictionOfJointsThatMove) {
  const Loaded robot = torque_robot("ur5e");
  Controller robust = controller_of(robot, ControlMode::robust, {.robust = {.late_steps = kLate}});
  (void)LateWorld(robot, 0.08, 1).worst(robust, 4000, 4);
  const JointVec learned = robust.friction();
  for (int i = 0; i < robot.arm.dof(); ++i) {
    EXPECT_NEAR(learned[i], 0.08 * robot.arm.limits.torque[i], 0.012 * robot.arm.limits.torque[i])
        << robot.arm.joints[i].name;
  }
  Controller heir = controller_of(robot, ControlMode::robust, {.robust = {.late_steps = kLate}});
  EXPECT_EQ(heir.friction().maxCoeff(), 0);
  heir.learn_from(robust);
  EXPECT_EQ(heir.friction(), learned);
  Controller other = controller_of(robot, ControlMode::computed_torque);
  other.learn_from(robust);
  EXPECT_EQ(other.friction().maxCoeff(), 0) << "it keeps none";
}

TEST(Robust, IsExactEnoughWhereTheModelIsRight) {
  EXPECT_LT(testing::worst_tracking_error(load_shipped("panda"), ControlMode::robust, 3000), 2e-4);
}

/// Largest modulus of the poles of one joint whose inertia is `ratio` times that of the model:
/// states q, v, estimates q, v, load (as acceleration), and the commands on their way.
double robust_radius(const RobustOptions& o, double ratio, double h) {
  const int late = o.late_steps, n = 6 + late;
  const double pole = std::exp(-o.observer * h), rest = 1 - pole;
  const double lq = 1 - pole * pole * pole, lv = 1.5 * rest * rest * (1 + pole) / h,
               ll = rest * rest * rest / (h * h);
  Eigen::MatrixXd A(n, n);
  for (int column = 0; column < n; ++column) {
    Eigen::VectorXd x = Eigen::VectorXd::Unit(n, column), y = x;
    double q = x[2], v = x[3], load = x[4];
    v += h * (x[5] + load);  // x[5 ..]: commands, the oldest first
    q += h * v;
    const double off = x[0] - q;
    q += lq * off;
    v += lv * off;
    load += ll * off;
    double q_then = q, v_then = v;
    for (int i = 1; i <= late; ++i) {
      v_then += h * (x[5 + i] + load);
      q_then += h * v_then;
    }
    const double w = o.bandwidth, command = -2 * w * v_then - w * w * q_then - load;
    const double acts = late > 0 ? x[6] : command;
    y[1] = x[1] + h * acts / ratio;
    y[0] = x[0] + h * y[1];
    y.segment(2, 3) << q, v, load;
    for (int i = 0; i < late; ++i) y[5 + i] = x[6 + i];
    y[5 + late] = command;
    A.col(column) = y;
  }
  return A.eigenvalues().cwiseAbs().maxCoeff();
}

TEST(Robust, OptionsThatAreTakenAreStableWithAThirdMoreOrLessInertia) {
  const Loaded robot = load_shipped("ur5e");
  const double h = robot.model.timestep();
  Rng rng(5);
  int taken = 0, refused = 0;
  for (int i = 0; i < 400; ++i) {
    const double bandwidth = std::pow(10, rng.uniform(0.5, 2.5));
    const RobustOptions options{.bandwidth = bandwidth,
                                .observer = bandwidth * rng.uniform(2, 4),
                                .late_steps = static_cast<int>(rng.below(8))};
    const auto made =
        Controller::create(robot.model, robot.arm, ControlMode::robust, {.robust = options});
    ++(made ? taken : refused);
    if (!made) continue;
    for (const double ratio : {0.75, 1.0, 1.33}) {
      EXPECT_LT(robust_radius(options, ratio, h), 1)
          << ratio << ": " << options.bandwidth << ' ' << options.observer << ' '
          << options.late_steps;
    }
  }
  EXPECT_GT(taken, 50);
  EXPECT_GT(refused, 50);
}

TEST(Robust, RefusesOptionsThatDoNotGoTogether) {
  const Loaded robot = load_shipped("ur5e");
  const auto refused = [&](const RobustOptions& options) {
    const auto made =
        Controller::create(robot.model, robot.arm, ControlMode::robust, {.robust = options});
    return made ? std::string() : made.error().what;
  };
  EXPECT_EQ(refused({}), "");
  EXPECT_THAT(refused({.bandwidth = 0}), HasSubstr("bandwidth 0"));
  EXPECT_THAT(refused({.bandwidth = std::nan("")}), HasSubstr("bandwidth nan"));
  EXPECT_THAT(refused({.observer = 600}), HasSubstr("observer 600"));
  EXPECT_THAT(refused({.late_steps = -1}), HasSubstr("late by -1"));
  EXPECT_THAT(refused({.late_steps = 5}), HasSubstr("late by 5"));
  EXPECT_THAT(refused({.friction_speed = 0}), HasSubstr("friction speed 0"));
}

TEST(FrictionSplit, TellsFrictionFromLoadByOneReversal) {
  constexpr double kStep = 0.002, kLoad = -4, kFriction = 9;
  FrictionSplit split(150);
  double sum = 0;
  for (int i = 0; i < 500; ++i) {
    const double s = i < 250 ? 1 : -1;
    split.drift(kStep);
    sum += split.measure(kLoad - kFriction * s, s, kStep);
    if (i == 249) {
      EXPECT_GT(std::abs(split.friction() - kFriction), 1) << "one direction alone cannot tell";
    }
  }
  EXPECT_NEAR(split.friction(), kFriction, 0.3);
  EXPECT_NEAR(split.load(), kLoad, 0.3);
  EXPECT_DOUBLE_EQ(sum, split.friction());
}

TEST(FrictionSplit, IsNeverNegativeNorMoreThanAFifth) {
  FrictionSplit split(100);
  for (int i = 0; i < 300; ++i) {
    const double s = i % 20 < 10 ? 1 : -1;
    split.drift(0.002);
    split.measure((i < 150 ? 30 : -60) * s, s, 0.002);
    EXPECT_GE(split.friction(), 0);
    EXPECT_LE(split.friction(), 20);
  }
  EXPECT_EQ(split.friction(), 20);
}

}  // namespace
}  // namespace mjarm
