#include "mjarm/model/dynamics.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <Eigen/Cholesky>

#include "mjarm/core/rng.hpp"
#include "mjarm/model/shipped_test.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

std::vector<double> draw(Rng& rng, int count, double size) {
  std::vector<double> values(static_cast<std::size_t>(count));
  for (double& value : values) value = rng.uniform(-size, size);
  return values;
}

class ShippedDynamics : public ::testing::TestWithParam<const char*> {};

// What a forward simulation of MuJoCo does with a torque, inverse() must give back: qacc of
// mj_forward without contact, constraint and actuation solves M qacc + bias = passive + applied.
TEST_P(ShippedDynamics, InverseUndoesMujocosForward) {
  const Model model = testing::shipped(GetParam());
  const int nv = model.nv();
  mjModel* free_model = mj_copyModel(nullptr, model.raw());
  free_model->opt.disableflags |= mjDSBL_CONSTRAINT | mjDSBL_ACTUATION;
  mjData* data = mj_makeData(free_model);
  Dynamics dynamics(model);
  Rng rng(5);
  for (int n = 0; n < 50; ++n) {
    const auto q = draw(rng, model.nq(), 2);
    const auto v = draw(rng, nv, 2);
    const auto applied = draw(rng, nv, 20);
    std::copy(q.begin(), q.end(), data->qpos);
    std::copy(v.begin(), v.end(), data->qvel);
    std::copy(applied.begin(), applied.end(), data->qfrc_applied);
    mj_forward(free_model, data);
    const std::vector<double> a(data->qacc, data->qacc + nv);
    const Eigen::VectorXd passive = dynamics.passive(q, v);
    const Eigen::VectorXd force = dynamics.inverse(q, v, a);
    for (int i = 0; i < nv; ++i) {
      EXPECT_NEAR(force[i] - passive[i], applied[i], 1e-8 + 1e-8 * std::abs(force[i]));
    }
  }
  mj_deleteData(data);
  mj_deleteModel(free_model);
}

// The file may have the actuators compensate gravity instead; what they are asked for is the same.
TEST(Dynamics, CountsCompensationByActuators) {
  const auto passive = [](const char* by_actuators) {
    const auto model = Model::from_mjcf(std::string(R"(<mujoco><worldbody>
        <body gravcomp="0.7"><joint axis="0 1 0" actuatorgravcomp=")") +
                                        by_actuators + R"("/>
        <geom size="0.1" pos="0.5 0 0"/></body></worldbody></mujoco>)");
    return Dynamics(model.value()).passive(std::vector{0.2}, std::vector{0.0})[0];
  };
  EXPECT_GT(std::abs(passive("false")), 1);
  EXPECT_EQ(passive("true"), passive("false"));
}

TEST_P(ShippedDynamics, MassMatrixIsSymmetricAndPositive) {
  const Model model = testing::shipped(GetParam());
  Dynamics dynamics(model);
  Rng rng(6);
  for (int n = 0; n < 50; ++n) {
    const Eigen::MatrixXd& M = dynamics.mass_matrix(draw(rng, model.nq(), 3));
    ASSERT_EQ(M.rows(), model.nv());
    EXPECT_LT((M - M.transpose()).norm(), 1e-12);
    EXPECT_EQ(M.llt().info(), Eigen::Success);
  }
}

// Gravity torque is the gradient of potential energy.
TEST_P(ShippedDynamics, GravityIsTheGradientOfEnergy) {
  const Model model = testing::shipped(GetParam());
  mjData* data = mj_makeData(model.raw());
  const auto energy = [&](const std::vector<double>& q) {
    std::copy(q.begin(), q.end(), data->qpos);
    mj_kinematics(model.raw(), data);
    double sum = 0;
    for (int b = 1; b < model.raw()->nbody; ++b) {
      sum += model.raw()->body_mass[b] * 9.81 * data->xipos[3 * b + 2];
    }
    return sum;
  };
  Dynamics dynamics(model);
  Rng rng(8);
  for (int n = 0; n < 20; ++n) {
    auto q = draw(rng, model.nq(), 2);
    const Eigen::VectorXd gravity = dynamics.gravity(q);
    for (int i = 0; i < model.nv(); ++i) {
      constexpr double kStep = 1e-6;
      const double at = q[i];
      q[i] = at + kStep;
      const double above = energy(q);
      q[i] = at - kStep;
      const double below = energy(q);
      q[i] = at;
      EXPECT_NEAR(gravity[i], (above - below) / (2 * kStep), 1e-6);
    }
  }
  mj_deleteData(data);
}

INSTANTIATE_TEST_SUITE_P(Models, ShippedDynamics,
                         ::testing::Values("ur5e", "panda", "universal_robots_ur5e/ur5e.urdf",
                                           "franka_emika_panda/panda.urdf"));

TEST(Dynamics, BiasIsGravityWhereNothingMoves) {
  const Model model = testing::shipped("panda");
  Dynamics dynamics(model);
  Rng rng(9);
  const auto q = draw(rng, model.nq(), 2);
  const std::vector<double> zero(9, 0.0);
  const Eigen::VectorXd moving = dynamics.bias(q, draw(rng, 9, 2));
  const Eigen::VectorXd gravity = dynamics.gravity(q);
  EXPECT_EQ(gravity, dynamics.bias(q, zero));
  EXPECT_GT((moving - gravity).norm(), 1e-3);
}

TEST(Dynamics, PassiveHoldsDampingAndBiasDoesNot) {
  const support::TempFolder folder;
  const auto file = folder.write("a.xml",
                                 "<mujoco><worldbody><body><joint axis=\"0 0 1\" damping=\"3\"/>"
                                 "<geom size=\".1\"/></body></worldbody></mujoco>");
  const Model model = Model::load(file).value();
  Dynamics dynamics(model);
  const std::vector<double> q = {0.3};
  const std::vector<double> v = {2.0};
  EXPECT_DOUBLE_EQ(dynamics.passive(q, v)[0], -6);
  EXPECT_NEAR(dynamics.bias(q, v)[0], 0, 1e-12);
}

TEST(Dynamics, MovesAndOutlivesTheModelItWasMadeFrom) {
  Dynamics dynamics = [] {
    const Model model = testing::shipped("ur5e");
    Dynamics made(model);
    return made;
  }();
  const std::vector<double> q(6, 0.1);
  const Eigen::VectorXd gravity = dynamics.gravity(q);
  Dynamics other = std::move(dynamics);
  EXPECT_EQ(gravity, other.gravity(q));
}

}  // namespace
}  // namespace mjarm
