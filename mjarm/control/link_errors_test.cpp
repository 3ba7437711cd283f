#include "mjarm/control/link_errors.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <memory>

#include "mjarm/control/robots_test.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/model/home.hpp"
#include "mjarm/model/moved_bodies.hpp"

namespace mjarm::testing {
namespace {

struct FreeModel {
  void operator()(mjModel* m) const { mj_deleteModel(m); }
  void operator()(mjData* d) const { mj_deleteData(d); }
};

/// Torque of the arm's joints for a motion, as MuJoCo's inverse dynamics has it.
JointVec inverse_of(const mjModel* m, const Arm& arm, const JointVec& q, const JointVec& v,
                    const JointVec& a) {
  const std::unique_ptr<mjData, FreeModel> d(mj_makeData(m));
  std::ranges::copy(home_configuration(m), d->qpos);
  for (int i = 0; i < arm.dof(); ++i) {
    d->qpos[arm.joints[i].qpos] = q[i];
    d->qvel[arm.joints[i].dof] = v[i];
    d->qacc[arm.joints[i].dof] = a[i];
  }
  mj_fwdPosition(m, d.get());
  mj_fwdVelocity(m, d.get());
  std::vector<double> full(static_cast<std::size_t>(m->nv));
  mj_rne(m, d.get(), 1, full.data());
  JointVec out(arm.dof());
  for (int i = 0; i < arm.dof(); ++i) out[i] = full[static_cast<std::size_t>(arm.joints[i].dof)];
  return out;
}

/// Every column against differences of MuJoCo's inverse dynamics between models with this body
/// changed, in random motions.
void expect_columns(const Loaded& robot) {
  constexpr double kStep = 1e-4;  // of the errors
  const Arm& arm = robot.arm;
  const ModelErrors errors;
  LinkErrors links(robot.model, arm, errors);
  const std::vector<MovedBody> bodies = moved_bodies(robot.model, arm);
  ASSERT_EQ(links.count(), 4 * static_cast<Eigen::Index>(bodies.size()));
  Rng rng(3);
  for (int round = 0; round < 5; ++round) {
    JointVec q(arm.dof()), v(q), a(q);
    for (int i = 0; i < arm.dof(); ++i) {
      q[i] = arm.home[i] + rng.uniform(-0.5, 0.5);
      v[i] = rng.uniform(-1, 1);
      a[i] = rng.uniform(-3, 3);
    }
    const Eigen::MatrixXd torques = links.torques(q, v, a);
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const int body = bodies[b].body;
      JointVec at[2];
      for (int side = 0; side < 2; ++side) {
        const std::unique_ptr<mjModel, FreeModel> m(mj_copyModel(nullptr, robot.model.raw()));
        const double factor = 1 + (side == 0 ? -1 : 1) * kStep * errors.mass / std::sqrt(3.0);
        m->body_mass[body] *= factor;
        for (int x = 0; x < 3; ++x) m->body_inertia[3 * body + x] *= factor;
        at[side] = inverse_of(m.get(), arm, q, v, a);
      }
      const JointVec expected = (at[1] - at[0]) / (2 * kStep);
      EXPECT_LT((torques.col(4 * static_cast<Eigen::Index>(b)) - expected).norm(),
                1e-6 * (1 + expected.norm()))
          << "body " << body;
    }
  }
}

TEST(LinkErrors, MassesAsMuJoCosInverseDynamicsHasThem) {
  expect_columns(load_shipped("ur5e"));
  expect_columns(load_shipped("panda"));
}

TEST(LinkErrors, CentresAsMuJoCosInverseDynamicsHasThem) {
  const Loaded robot = load_shipped("ur5e");
  const Arm& arm = robot.arm;
  const ModelErrors errors;
  LinkErrors links(robot.model, arm, errors);
  const std::vector<MovedBody> bodies = moved_bodies(robot.model, arm);
  JointVec q = arm.home, v(q), a(q);
  for (int i = 0; i < arm.dof(); ++i) {
    q[i] += 0.1 * (i + 1);
    v[i] = 0.3 - 0.2 * i;
    a[i] = 1 - 0.5 * i;
  }
  const Eigen::MatrixXd torques = links.torques(q, v, a);
  constexpr double kStep = 1e-5;  // [m]
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    // A shift along each axis of the body: the three columns together span the same torques.
    Eigen::MatrixXd expected(arm.dof(), 3);
    for (int x = 0; x < 3; ++x) {
      JointVec at[2];
      for (int side = 0; side < 2; ++side) {
        const std::unique_ptr<mjModel, FreeModel> m(mj_copyModel(nullptr, robot.model.raw()));
        m->body_ipos[3 * bodies[b].body + x] += side == 0 ? -kStep : kStep;
        m->body_sameframe[bodies[b].body] = mjSAMEFRAME_NONE;
        m->body_simple[bodies[b].body] = 0;
        at[side] = inverse_of(m.get(), arm, q, v, a);
      }
      expected.col(x) = (at[1] - at[0]) / (2 * kStep) * errors.center / std::sqrt(3.0);
    }
    // Whatever the axes of the two frames: A A^T is the same.
    const Eigen::MatrixXd columns = torques.middleCols(4 * static_cast<Eigen::Index>(b) + 1, 3);
    EXPECT_LT((columns * columns.transpose() - expected * expected.transpose()).norm(),
              1e-5 * (1e-3 + expected.squaredNorm()))
        << "body " << bodies[b].body;
  }
}

}  // namespace
}  // namespace mjarm::testing
