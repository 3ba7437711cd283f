#include "mjarm/identification/identify.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>

#include "mjarm/control/controller.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/identification/excitation.hpp"
#include "mjarm/model/link_inertials.hpp"
#include "mjarm/model/wrong_model.hpp"

namespace mjarm {
namespace {

constexpr double kEncoder = 1.7453292519943295e-4;  // [rad] 0.01 deg

struct MujocoWorld {
  explicit MujocoWorld(const Model& source)
      : model(mj_copyModel(nullptr, source.raw())), data(mj_makeData(model)) {}
  ~MujocoWorld() {
    mj_deleteData(data);
    mj_deleteModel(model);
  }
  MujocoWorld(const MujocoWorld&) = delete;
  MujocoWorld& operator=(const MujocoWorld&) = delete;
  mjModel* model;
  mjData* data;
};

/// What is told of a run in MuJoCo itself: the arm is driven by torque, its positions have steps,
/// its torques noise.
JointLog log_of(const Robot& known, const Model& world, const Trajectory& motion) {
  const Arm& arm = known.arm;
  Controller controller =
      Controller::create(known.model, arm, ControlMode::computed_torque).value();
  MujocoWorld real(world);
  const double h = known.model.timestep();
  real.model->opt.timestep = h / 4;
  real.model->opt.disableflags |= mjDSBL_CONTACT;  // nothing looked where the arm may go
  for (int j = 0; j < arm.dof(); ++j) {
    real.data->qpos[arm.joints[static_cast<std::size_t>(j)].qpos] = motion.at(0).q[j];
  }
  mj_forward(real.model, real.data);
  std::vector<double> ctrl(static_cast<std::size_t>(known.model.nu()), 0.0);
  Rng rng(9);
  JointLog out{h, {}, {}};
  for (int i = 0; i * h < motion.duration(); ++i) {
    const std::span<const double> qpos(real.data->qpos, static_cast<std::size_t>(known.model.nq()));
    const std::span<const double> qvel(real.data->qvel, static_cast<std::size_t>(known.model.nv()));
    controller.command(qpos, qvel, reference_at(motion, i * h, h), ctrl);
    JointVec q(arm.dof()), torque(arm.dof());
    for (int j = 0; j < arm.dof(); ++j) {
      const ArmJoint& joint = arm.joints[static_cast<std::size_t>(j)];
      const auto id = static_cast<std::size_t>(joint.actuator->id);
      q[j] = kEncoder * std::round(qpos[static_cast<std::size_t>(joint.qpos)] / kEncoder);
      torque[j] = ctrl[id];
      real.data->ctrl[id] = ctrl[id] * (1 + 0.01 * rng.normal());
    }
    out.q.push_back(q);
    out.torque.push_back(torque);
    for (int k = 0; k < 4; ++k) mj_step(real.model, real.data);
  }
  return out;
}

struct Case {
  Robot bare, known;
  Trajectory motion;
};
Case case_of(const char* name, double seconds = 15) {
  const Robot bare = load_robot(name).value();
  Trajectory motion =
      excitation(bare.model, bare.arm, bare.arm.home, {.seconds = seconds, .tries = 10}).value();
  return {bare, with_torque_drives(bare), std::move(motion)};
}

TEST(Identify, PayloadAndFrictionOfAnArmWhoseLinksAreKnown) {
  const Case one = case_of("ur5e");
  Rng rng(1);
  const Model rough =
      wrong_model(one.bare.model, one.bare.arm, {.mass = 0, .center = 0}, rng).value();
  const Payload payload{1.8, {0.02, -0.01, 0.05}};
  const Model loaded = with_payload(rough, one.bare.arm.tip, payload).value();
  const JointLog log =
      log_of(one.known, with_torque_drives({loaded, one.bare.arm}).model, one.motion);
  const Identification told = identify(one.known, {.log = &log}).value();
  ASSERT_TRUE(told.payload.has_value());
  EXPECT_NEAR(told.payload->mass.value, payload.mass, 0.02 * payload.mass);
  EXPECT_LT((told.payload->payload().center - payload.center).norm(), 1e-3);
  for (int j = 0; j < one.bare.arm.dof(); ++j) {
    const double friction = ModelErrors{}.friction * one.bare.arm.limits.torque[j];
    const Estimate& found = told.joints[static_cast<std::size_t>(j)].friction;
    EXPECT_NEAR(found.value, friction, 0.05 * friction) << j;
    EXPECT_GT(found.error, 0) << j;
    EXPECT_LT(found.error, 0.05 * friction) << j;
  }
}

TEST(Identify, LinksThatAreWrongNeedALogOfTheEmptyArm) {
  const Case one = case_of("ur5e");
  Rng rng(2);
  const Model wrong = wrong_model(one.bare.model, one.bare.arm, {}, rng).value();
  const Payload payload{2.2, {0.01, 0.015, -0.005}};
  const Model loaded = with_payload(wrong, one.bare.arm.tip, payload).value();
  const auto driven = [&](const Model& model) {
    return log_of(one.known, with_torque_drives({model, one.bare.arm}).model, one.motion);
  };
  const JointLog log = driven(loaded), empty = driven(wrong);
  const Identification alone = identify(one.known, {.log = &log}).value();
  const Identification both = identify(one.known, {.log = &log, .empty = &empty}).value();
  const auto off = [&](const Identification& told) {
    return (told.payload->payload().center - payload.center).norm();
  };
  EXPECT_NEAR(both.payload->mass.value, payload.mass, 0.05 * payload.mass);
  EXPECT_LT(off(both), 1.5e-3);
  EXPECT_GT(off(alone), 2 * off(both));
}

TEST(Identify, TheDelayOfTorquesIsFound) {
  const Case one = case_of("ur5e", 10);
  JointLog log = log_of(one.known, one.known.model, one.motion);
  const double before = identify(one.known, {.log = &log}).value().delay;
  constexpr std::size_t kLate = 3;
  // Told three rows before they act.
  log.torque.erase(log.torque.begin(), log.torque.begin() + kLate);
  log.q.resize(log.torque.size());
  const Identification told = identify(one.known, {.log = &log}).value();
  EXPECT_NEAR(told.delay - before, kLate * log.timestep, 0.2 * log.timestep);
  EXPECT_NEAR(told.payload->mass.value, 0, 0.05);
}

TEST(Identify, EstimatesAreWrittenAsFarAsTheirErrorsLeave) {
  EXPECT_EQ(describe({1.5, 0.002}), "1.5000 +- 0.0020");
  EXPECT_EQ(describe({123.4, 20}), "123 +- 20");
  EXPECT_EQ(describe({1, 1, false}), "-");
  EXPECT_TRUE(PayloadEstimate({.mass = {1.5, 0.4}, .center = {}}).is_told());
  EXPECT_FALSE(PayloadEstimate({.mass = {1.5, 0.6}, .center = {}}).is_told());
  EXPECT_FALSE(PayloadEstimate({.mass = {1.5, 0, false}, .center = {}}).is_told());
}

TEST(Identify, IsStopped) {
  const Case one = case_of("ur5e", 5);
  const JointLog log = log_of(one.known, one.known.model, one.motion);
  int looks = 0;
  const auto after = [&](int count) {
    looks = 0;
    return identify(one.known, {.log = &log, .stop = [&, count] { return ++looks > count; }});
  };
  EXPECT_TRUE(after(1'000'000).has_value());
  const int all = looks;
  for (const int count : {0, 100, all - 1}) EXPECT_EQ(after(count).error().what, stopped().what);
}

TEST(Identify, RefusesWhatTellsNothing) {
  const Robot robot = load_robot("ur5e").value();
  JointLog log{0.002, {}, {}};
  log.q.assign(100, robot.arm.home);
  log.torque.assign(100, robot.arm.home);
  EXPECT_NE(identify(robot, {.log = &log}).error().what.find("100 rows"), std::string::npos);
  log.q.assign(5000, robot.arm.home);
  log.torque.assign(5000, robot.arm.home);
  EXPECT_NE(identify(robot, {.log = &log}).error().what.find("no joint"), std::string::npos);
  log.timestep = 0.1;
  EXPECT_NE(identify(robot, {.log = &log}).error().what.find("every 0.1 s"), std::string::npos);
}

}  // namespace
}  // namespace mjarm
