#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "mjarm/core/rng.hpp"
#include "mjarm/model/arm_dynamics.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/trajectory/path_timing.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

/// Three joints with friction of both kinds, a spring and 6 kg in the hand.
constexpr const char* kHeavyArm = R"(<mujoco>
  <compiler angle="radian"/>
  <default><joint range="-9 9"/><geom contype="0" conaffinity="0"/></default>
  <worldbody><body>
    <joint name="a" axis="0 0 1" damping="2" armature="0.1"/>
    <geom type="capsule" fromto="0 0 0 0 0 0.3" size="0.05" mass="5"/>
    <body pos="0 0 0.3">
      <joint name="b" axis="0 1 0" damping="3" frictionloss="4" solreffriction="0.004 1"/>
      <geom type="capsule" fromto="0 0 0 0.5 0 0" size="0.04" mass="4"/>
      <body pos="0.5 0 0">
        <joint name="c" axis="0 1 0" damping="0.5" frictionloss="1" solreffriction="0.004 1"
               stiffness="2"/>
        <geom type="capsule" fromto="0 0 0 0.4 0 0" size="0.03" mass="2"/>
        <body pos="0.4 0 0"><geom size="0.06" mass="6"/><site name="tip"/></body>
      </body>
    </body>
  </body></worldbody>
  <actuator>
    <motor joint="a" ctrlrange="-30 30"/>
    <motor joint="b" ctrlrange="-130 130"/>
    <motor joint="c" ctrlrange="-90 90"/>
  </actuator>
</mujoco>)";

struct Robot {
  Model model;
  Arm arm;
};
Robot robot_of(const std::filesystem::path& file) {
  Model model = Model::load(file).value();
  Arm arm = find_arm(model).value();
  return {std::move(model), std::move(arm)};
}
Robot shipped(std::string_view name) { return robot_of(find_model_file(name).value()); }
Robot heavy() {
  const support::TempFolder folder;
  Robot robot = robot_of(folder.write("heavy.xml", kHeavyArm));
  robot.arm.limits.velocity.setConstant(3);
  robot.arm.limits.acceleration.setConstant(8);
  robot.arm.limits.jerk.setConstant(300);
  return robot;
}

InverseDynamics dynamics_of(const Robot& robot) {
  const auto arm = std::make_shared<ArmDynamics>(robot.model, robot.arm);
  return [arm](const JointVec& q, const JointVec& v, const JointVec& a) {
    return arm->inverse(q, v, a);
  };
}

/// MuJoCo's own inverse dynamics, without contact and joint stops.
class Oracle {
 public:
  explicit Oracle(const Robot& robot)
      : arm_(robot.arm), model_(mj_copyModel(nullptr, robot.model.raw())) {
    model_->opt.disableflags |= mjDSBL_CONTACT | mjDSBL_LIMIT;
    data_ = mj_makeData(model_);
    if (model_->nkey > 0) mj_resetDataKeyframe(model_, data_, 0);
  }
  ~Oracle() {
    mj_deleteData(data_);
    mj_deleteModel(model_);
  }
  Oracle(const Oracle&) = delete;
  Oracle& operator=(const Oracle&) = delete;

  JointVec torque(const JointState& x) {
    std::fill_n(data_->qvel, model_->nv, 0.0);
    std::fill_n(data_->qacc, model_->nv, 0.0);
    for (int i = 0; i < arm_.dof(); ++i) {
      const ArmJoint& joint = arm_.joints[static_cast<std::size_t>(i)];
      data_->qpos[joint.qpos] = x.q[i];
      data_->qvel[joint.dof] = x.v[i];
      data_->qacc[joint.dof] = x.a[i];
    }
    mj_inverse(model_, data_);
    JointVec torque(arm_.dof());
    for (int i = 0; i < arm_.dof(); ++i) {
      torque[i] = data_->qfrc_inverse[arm_.joints[static_cast<std::size_t>(i)].dof];
    }
    return torque;
  }

 private:
  const Arm& arm_;
  mjModel* model_;
  mjData* data_;
};

struct Seen {
  double torque = 0;  // worst share of its limit
  double other = 0;   // of velocity and acceleration
  double busy = 0;    // share of the samples at which some limit is used to 99 %
};
Seen seen(const Trajectory& motion, const Robot& robot, const JointVec& limit) {
  Oracle oracle(robot);
  Seen result;
  constexpr int kSamples = 6007;
  const JointLimits& limits = robot.arm.limits;
  for (int i = 0; i <= kSamples; ++i) {
    const JointState x = motion.at(motion.duration() * i / kSamples);
    const double torque = oracle.torque(x).cwiseAbs().cwiseQuotient(limit).maxCoeff();
    const double other = std::max(x.v.cwiseAbs().cwiseQuotient(limits.velocity).maxCoeff(),
                                  x.a.cwiseAbs().cwiseQuotient(limits.acceleration).maxCoeff());
    result.torque = std::max(result.torque, torque);
    result.other = std::max(result.other, other);
    result.busy += std::max(torque, other) >= 0.99 ? 1. / (kSamples + 1) : 0;
  }
  return result;
}

std::vector<JointVec> waypoints_about(const JointVec& home, Rng& rng, int count) {
  std::vector<JointVec> points;
  for (int i = 0; i < count; ++i) {
    JointVec q = home;
    for (double& x : q) x += rng.uniform(-0.8, 0.8);
    points.push_back(q);
  }
  return points;
}

/// Torques of MuJoCo along many paths, with the option and without.
void expect_honoured(const Robot& robot, double share, double busy) {
  Rng rng(31);
  double without = 0;
  for (int i = 0; i < 12; ++i) {
    SCOPED_TRACE(i);
    const auto points = waypoints_about(robot.arm.home, rng, 2 + i % 6);
    const JointVec limit = share * robot.arm.limits.torque;
    PathTimingOptions options{
        .jerk_limits = false, .dynamics = dynamics_of(robot), .torque_share = share};
    const auto fast = time_waypoint_path(points, robot.arm.limits, {.jerk_limits = false});
    const auto strong = time_waypoint_path(points, robot.arm.limits, options);
    options.jerk_limits = true;
    const auto smooth = time_waypoint_path(points, robot.arm.limits, options);
    ASSERT_TRUE(fast && strong && smooth) << (strong ? "" : strong.error().what);
    without = std::max(without, seen(*fast, robot, limit).torque);
    const Seen jumps = seen(*strong, robot, limit), soft = seen(*smooth, robot, limit);
    EXPECT_LE(jumps.torque, 1.001);
    EXPECT_LE(jumps.other, 1.001);
    EXPECT_GE(jumps.busy, busy);
    EXPECT_LE(soft.torque, 1.001);
    EXPECT_LE(soft.other, 1.001);
    EXPECT_LE(check_limits(*smooth, robot.arm.limits, smooth->duration() / 7001).jerk.maxCoeff(),
              1 + 1e-6);
    EXPECT_GE(strong->duration(), 0.999 * fast->duration());
    EXPECT_LE(smooth->duration(), 1.15 * strong->duration());
    const JointVec use = check_torque(*strong, options.dynamics, limit, strong->duration() / 6007);
    EXPECT_NEAR(use.maxCoeff(), jumps.torque, 0.05);
  }
  EXPECT_GE(without, 1.2);
}

TEST(TorqueLimits, HoldForAHeavyHandWithFriction) { expect_honoured(heavy(), 1, 0.95); }
TEST(TorqueLimits, HoldForTheUr5e) { expect_honoured(shipped("ur5e"), 0.28, 0.95); }
TEST(TorqueLimits, HoldForThePanda) { expect_honoured(shipped("panda"), 0.6, 0.95); }

TEST(TorqueLimits, AreBangBangOnALineWhereGravityHelps) {
  // A sledge of 2 kg on a slope, as a function: 2 a + 3 + 1.5 v + 0.5 sign(v), at most 10.
  const InverseDynamics sledge = [](const JointVec&, const JointVec& v, const JointVec& a) {
    const double sign = v[0] > 0 ? 1 : v[0] < 0 ? -1 : 0;
    return JointVec(2 * a + 1.5 * v + JointVec::Constant(1, 3 + 0.5 * sign));
  };
  JointLimits limits;
  limits.velocity = limits.acceleration = limits.jerk = JointVec::Constant(1, 1e4);
  limits.torque = JointVec::Constant(1, 10);
  // Up by x(t) with 2 x'' = 6.5 - 1.5 x', then down with 2 x'' = -13.5 - 1.5 x', integrated here.
  const auto way = [](double up) {
    double x = 0, v = 0, t = 0;
    const double h = 1e-5;
    for (; t < up; t += h, x += h * v) v += h * (6.5 - 1.5 * v) / 2;
    for (; v > 0; t += h, x += h * v) v -= h * (13.5 + 1.5 * v) / 2;
    return std::pair{x, t};
  };
  double low = 0, high = 5;
  while (high - low > 1e-6) {
    const double middle = 0.5 * (low + high);
    (way(middle).first < 2 ? low : high) = middle;
  }
  const std::vector<JointVec> line{JointVec::Zero(1), JointVec::Constant(1, 2)};
  const auto motion = time_waypoint_path(line, limits, {.jerk_limits = false, .dynamics = sledge});
  ASSERT_TRUE(motion.has_value()) << motion.error().what;
  EXPECT_NEAR(motion->duration(), way(low).second, 2e-3 * motion->duration());
}

TEST(TorqueLimits, APathThatCannotBeHeldIsRefusedByJointAndPlace) {
  const Robot robot = heavy();
  const auto at = [](double b) { return JointVec(Eigen::Vector3d(0, b, 0)); };
  const auto what = [&](const std::vector<JointVec>& path, double share, bool jerk) {
    const auto motion = time_waypoint_path(
        path, robot.arm.limits,
        {.jerk_limits = jerk, .dynamics = dynamics_of(robot), .torque_share = share});
    return motion ? std::string() : motion.error().what;
  };
  // Upright, then lowered forward until the second joint has to give more than half of its torque.
  const std::vector<JointVec> lowered{at(-1.57), at(0)};
  for (const bool jerk : {false, true}) {
    EXPECT_EQ(what(lowered, 1, jerk), "");
    EXPECT_NE(what(lowered, 0.5, jerk).find("joint 2 "), std::string::npos)
        << what(lowered, 0.5, jerk);
    EXPECT_NE(what({at(0)}, 0.5, jerk).find("joint 2 "), std::string::npos);
    EXPECT_EQ(what({at(-1.57)}, 0.5, jerk), "");
  }
  // By MuJoCo: where on the way gravity and friction come to half of the limit.
  Oracle oracle(robot);
  double share = 0;
  const JointVec zero = JointVec::Zero(3);
  for (; share < 1; share += 1e-3) {
    const JointVec torque = oracle.torque({at(-1.57 + 1.57 * share), zero, zero});
    if (std::max(std::abs(torque[1]), std::abs(torque[1] + 4)) > 0.5 * 130) break;
  }
  const std::string text = what(lowered, 0.5, false);
  EXPECT_NEAR(std::stod(text.substr(text.find("at ") + 3)), 100 * share, 2) << text;
}

TEST(TorqueLimits, APathThatCannotBeHeldOnlyInTheMiddleIsRefusedToo) {
  const Robot robot = heavy();
  const auto at = [](double b) { return JointVec(Eigen::Vector3d(0, b, 0)); };
  // From upright to hanging: both ends take no torque, level half way takes most of it.
  const std::vector<JointVec> over{at(-1.57), at(0), at(1.57)};
  for (const bool jerk : {false, true}) {
    PathTimingOptions options{
        .jerk_limits = jerk, .dynamics = dynamics_of(robot), .torque_share = 0.5};
    for (const double end : {-1.57, 1.57}) {
      EXPECT_TRUE(time_waypoint_path(std::vector{at(end)}, robot.arm.limits, options).has_value());
    }
    const auto motion = time_waypoint_path(over, robot.arm.limits, options);
    ASSERT_FALSE(motion.has_value());
    EXPECT_EQ(motion.error().code, Errc::impossible);
    const std::string text = motion.error().what;
    EXPECT_NE(text.find("joint 2 "), std::string::npos) << text;
    const double place = std::stod(text.substr(text.find("at ") + 3));
    EXPECT_GT(place, 5);
    EXPECT_LT(place, 50);
  }
}

TEST(TorqueLimits, NoWayIsARestWhereTheArmCanBeHeld) {
  const Robot robot = heavy();
  const auto at = [](double b) { return JointVec(Eigen::Vector3d(0, b, 0)); };
  const PathTimingOptions options{.dynamics = dynamics_of(robot), .torque_share = 0.5};
  for (const std::size_t n : {1u, 2u, 5u}) {
    const auto held =
        time_waypoint_path(std::vector<JointVec>(n, at(-1.57)), robot.arm.limits, options);
    ASSERT_TRUE(held.has_value()) << held.error().what;
    EXPECT_EQ(held->duration(), 0);
    EXPECT_EQ(held->at(0).q, at(-1.57));
    const auto falls =
        time_waypoint_path(std::vector<JointVec>(n, at(0)), robot.arm.limits, options);
    ASSERT_FALSE(falls.has_value());
    EXPECT_EQ(falls.error().code, Errc::impossible);
    EXPECT_NE(falls.error().what.find("joint 2 "), std::string::npos) << falls.error().what;
    EXPECT_NE(falls.error().what.find("at 0 %"), std::string::npos) << falls.error().what;
  }
}

TEST(TorqueLimits, RefusesLimitsThatMakeNoSense) {
  const Robot robot = heavy();
  const std::vector<JointVec> path{JointVec::Zero(3), JointVec::Ones(3)};
  const auto what = [&](const JointVec& torque, double share) {
    JointLimits limits = robot.arm.limits;
    limits.torque = torque;
    const auto motion =
        time_waypoint_path(path, limits, {.dynamics = dynamics_of(robot), .torque_share = share});
    return motion ? std::string() : motion.error().what;
  };
  const JointVec fine = robot.arm.limits.torque;
  EXPECT_NE(what(JointVec(), 1).find("torque"), std::string::npos);
  EXPECT_NE(what(JointVec::Ones(2), 1).find("3 joints"), std::string::npos);
  EXPECT_NE(what(-fine, 1).find("torque"), std::string::npos);
  EXPECT_NE(what(fine * std::numeric_limits<double>::infinity(), 1).find("torque"),
            std::string::npos);
  EXPECT_NE(what(fine, 0).find("share"), std::string::npos);
  EXPECT_NE(what(fine, 1.5).find("share"), std::string::npos);
}

}  // namespace
}  // namespace mjarm
