#include "mjarm/control/step_inverse.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <memory>

#include "mjarm/control/actuation.hpp"
#include "mjarm/control/robots_test.hpp"
#include "mjarm/core/rng.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/test_data.hpp"

namespace mjarm {
namespace {

using testing::load_shipped;
using testing::load_text;
using testing::Loaded;
using testing::odd_arm;

/// MuJoCo without contacts and joint stops, stepped by itself.
class Oracle {
 public:
  explicit Oracle(const Model& model)
      : m_(mj_copyModel(nullptr, model.raw())), d_(mj_makeData(m_.get())) {
    m_->opt.disableflags |= mjDSBL_CONTACT | mjDSBL_LIMIT;
  }
  [[nodiscard]] mjModel& m() { return *m_; }
  [[nodiscard]] mjData& d() { return *d_; }
  [[nodiscard]] std::span<const double> qpos() { return {d_->qpos, std::size_t(m_->nq)}; }
  [[nodiscard]] std::span<const double> qvel() { return {d_->qvel, std::size_t(m_->nv)}; }

  /// The arm anywhere within its limits, moving; the rest where the model has it, at rest.
  void randomise(const Arm& arm, Rng& rng, double speed) {
    mj_resetData(m_.get(), d_.get());
    for (int i = 0; i < arm.dof(); ++i) {
      d_->qpos[arm.joints[i].qpos] = rng.uniform(arm.limits.lower[i], arm.limits.upper[i]);
      d_->qvel[arm.joints[i].dof] = rng.uniform(-speed, speed);
    }
  }

  /// Steps with `torque` from the arm's drives. @return (v+ - v) / h of the arm.
  JointVec step(const Arm& arm, const JointVec& torque) {
    JointVec v(arm.dof());
    for (int i = 0; i < arm.dof(); ++i) {
      const ArmJoint& joint = arm.joints[i];
      v[i] = d_->qvel[joint.dof];
      d_->ctrl[joint.actuator->id] =
          ctrl_for_torque(*joint.actuator, torque[i], d_->qpos[joint.qpos], v[i]);
    }
    mj_step(m_.get(), d_.get());
    JointVec a(arm.dof());
    for (int i = 0; i < arm.dof(); ++i) {
      a[i] = (d_->qvel[arm.joints[i].dof] - v[i]) / m_->opt.timestep;
    }
    return a;
  }

 private:
  struct Delete {
    void operator()(mjModel* m) const { mj_deleteModel(m); }
    void operator()(mjData* d) const { mj_deleteData(d); }
  };
  std::unique_ptr<mjModel, Delete> m_;
  std::unique_ptr<mjData, Delete> d_;
};

/// Draws states and accelerations; @return the worst |a - a*| where no actuator was at its limit.
double worst_step_error(const Loaded& robot, double speed, double accel, int cases = 400) {
  Rng rng(7);
  Oracle oracle(robot.model);
  StepInverse inverse(robot.model, robot.arm);
  double worst = 0;
  int within_limits = 0;
  for (int n = 0; n < cases; ++n) {
    oracle.randomise(robot.arm, rng, speed);
    JointVec wanted(robot.arm.dof());
    for (double& a : wanted) a = rng.uniform(-accel, accel);
    const JointVec torque = inverse.torque(oracle.qpos(), oracle.qvel(), wanted);
    bool inside = true;
    for (int i = 0; i < robot.arm.dof(); ++i) {
      const ArmActuator& actuator = *robot.arm.joints[i].actuator;
      const double force = torque[i] / actuator.gear;
      const double ctrl =
          ctrl_for_torque(actuator, torque[i], oracle.qpos()[robot.arm.joints[i].qpos],
                          oracle.qvel()[robot.arm.joints[i].dof]);
      inside = inside && force > actuator.force_lower && force < actuator.force_upper &&
               ctrl > actuator.ctrl_lower && ctrl < actuator.ctrl_upper;
    }
    if (!inside) continue;
    ++within_limits;
    worst = std::max(worst, (oracle.step(robot.arm, torque) - wanted).cwiseAbs().maxCoeff());
  }
  EXPECT_GE(within_limits, cases / 10);
  return worst;
}

TEST(StepInverse, OneStepGivesTheAccelerationUnderEveryIntegrator) {
  for (const char* integrator : {"Euler", "implicit", "implicitfast", "discrete"}) {
    SCOPED_TRACE(integrator);
    const Loaded robot = load_text(odd_arm("integrator=\"" + std::string(integrator) + "\""));
    EXPECT_LT(worst_step_error(robot, 1.5, 8), 1e-9);
  }
}

TEST(StepInverse, DryFrictionIsMadeUpFor) {
  std::string arm = odd_arm("integrator=\"implicitfast\"");
  for (std::size_t at = arm.find("<joint "); at != std::string::npos;
       at = arm.find("<joint ", at + 1)) {
    arm.insert(at + 7, "frictionloss=\"0.4\" ");
  }
  EXPECT_LT(worst_step_error(load_text(arm), 1.5, 8), 1e-5);
  EXPECT_LT(worst_step_error(load_text(arm), 0.01, 0.1), 1e-5);  // hardly moving
}

TEST(StepInverse, KnowsWhenDampingIsExplicit) {
  for (const char* flag : {"eulerdamp=\"disable\"", "damper=\"disable\"", "spring=\"disable\"",
                           "gravity=\"disable\""}) {
    SCOPED_TRACE(flag);
    EXPECT_LT(worst_step_error(load_text(odd_arm("integrator=\"Euler\"", flag)), 1.5, 8), 1e-9);
    EXPECT_LT(worst_step_error(load_text(odd_arm("integrator=\"discrete\"", flag)), 1.5, 8), 1e-9);
  }
}

TEST(StepInverse, IsOfFirstOrderUnderRungeKutta) {
  const double coarse = worst_step_error(load_text(odd_arm("integrator=\"RK4\"")), 1.5, 8);
  std::string fine_text = odd_arm("integrator=\"RK4\"");
  fine_text.replace(fine_text.find("0.002"), 5, "2e-05");
  const double fine = worst_step_error(load_text(fine_text), 1.5, 8);
  EXPECT_GT(coarse, 1e-3);
  EXPECT_LT(fine, coarse / 50);
}

TEST(StepInverse, OneStepGivesTheAccelerationOfTheShippedArms) {
  EXPECT_LT(worst_step_error(load_shipped("ur5e"), 1, 4), 1e-9);
  const auto panda = find_model_file("panda");
  ASSERT_TRUE(panda) << panda.error().what;
  EXPECT_LT(worst_step_error(testing::load_file(panda->parent_path() / "panda_nohand.xml"), 0.5, 2),
            1e-9);
}

TEST(StepInverse, OneStepGivesTheAccelerationOfArmsFromElsewhere) {
  const support::TempFolder folder;
  MJARM_TEST_ARCHIVE(ur5e, "menagerie/universal_robots_ur5e.tar.xz");
  MJARM_TEST_ARCHIVE(panda, "menagerie/franka_emika_panda.tar.xz");
  support::unpack(ur5e, folder.path());
  support::unpack(panda, folder.path());
  for (const char* file :
       {"universal_robots_ur5e/scene.xml", "franka_emika_panda/panda_nohand.xml"}) {
    SCOPED_TRACE(file);
    EXPECT_LT(worst_step_error(testing::load_file(folder.path() / file), 0.5, 2), 1e-9);
  }
}

TEST(StepInverse, LooseFingersDisturbLittle) {
  EXPECT_LT(worst_step_error(load_shipped("panda"), 0.5, 2), 0.5);
}

TEST(StepInverse, HoldingTorqueKeepsTheArmStill) {
  const Loaded robot = load_text(odd_arm("integrator=\"implicitfast\""));
  Rng rng(3);
  Oracle oracle(robot.model);
  StepInverse inverse(robot.model, robot.arm);
  for (int n = 0; n < 50; ++n) {
    oracle.randomise(robot.arm, rng, 0);
    const JointVec a = oracle.step(robot.arm, inverse.holding_torque(oracle.qpos()));
    EXPECT_LT(a.cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(Actuation, CtrlAndForceAreInverse) {
  const ArmActuator actuator{.name = "a", .id = 0, .gear = -3, .gain = 70, .bias = {1.5, -65, -4}};
  const double ctrl = ctrl_for_torque(actuator, 12, 0.3, -0.7);
  EXPECT_NEAR(actuator.gear * actuator_force(actuator, ctrl, 0.3, -0.7), 12, 1e-12);
  EXPECT_DOUBLE_EQ(servo_stiffness(actuator), 585);
  EXPECT_DOUBLE_EQ(servo_damping(actuator), 36);
}

}  // namespace
}  // namespace mjarm
