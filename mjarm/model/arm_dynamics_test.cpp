#include "mjarm/model/arm_dynamics.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>

#include "mjarm/core/rng.hpp"
#include "mjarm/model/find_arm.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

JointVec draw_joints(Rng& rng, int dof, double size) {
  JointVec values(dof);
  for (double& value : values) value = rng.uniform(-size, size);
  return values;
}

/// Torques of the arm's joints by mj_inverse, every other joint at rest as in the first keyframe.
void expect_as_mujoco(const Model& model, double tolerance) {
  const Arm arm = find_arm(model).value();
  mjModel* m = mj_copyModel(nullptr, model.raw());
  m->opt.disableflags |= mjDSBL_CONTACT | mjDSBL_LIMIT;
  mjData* data = mj_makeData(m);
  if (m->nkey > 0) mj_resetDataKeyframe(m, data, 0);
  ArmDynamics dynamics(model, arm);
  Rng rng(8);
  for (int n = 0; n < 50; ++n) {
    const JointVec q = draw_joints(rng, arm.dof(), 2), a = draw_joints(rng, arm.dof(), 5);
    JointVec v = draw_joints(rng, arm.dof(), 2);
    for (double& x : v) x += std::copysign(0.2, x);  // soft friction does not slip at once
    for (int i = 0; i < arm.dof(); ++i) {
      const ArmJoint& joint = arm.joints[static_cast<std::size_t>(i)];
      data->qpos[joint.qpos] = q[i];
      data->qvel[joint.dof] = v[i];
      data->qacc[joint.dof] = a[i];
    }
    mj_inverse(m, data);
    const JointVec torque = dynamics.inverse(q, v, a);
    for (int i = 0; i < arm.dof(); ++i) {
      const double expected = data->qfrc_inverse[arm.joints[static_cast<std::size_t>(i)].dof];
      EXPECT_NEAR(torque[i], expected, tolerance * (1 + std::abs(expected))) << n << " " << i;
    }
  }
  mj_deleteData(data);
  mj_deleteModel(m);
}

TEST(ArmDynamics, IsMujocosInverseForTheShippedArms) {
  for (const char* name : {"ur5e", "panda"}) {
    SCOPED_TRACE(name);
    expect_as_mujoco(Model::load(find_model_file(name).value()).value(), 1e-9);
  }
}

TEST(ArmDynamics, HasSpringsDampingAndDryFriction) {
  const support::TempFolder folder;
  const auto file = folder.write("arm.xml", R"(<mujoco>
    <default><geom contype="0" conaffinity="0"/></default>
    <worldbody><body>
      <joint name="a" axis="0 1 0" damping="2" frictionloss="3" solreffriction="0.004 1"/>
      <geom type="capsule" fromto="0 0 0 0.5 0 0" size="0.04" mass="4"/>
      <body pos="0.5 0 0">
        <joint name="b" axis="0 1 0" stiffness="5" springref="20"/>
        <geom type="capsule" fromto="0 0 0 0.4 0 0" size="0.03" mass="2"/>
        <site name="tip" pos="0.4 0 0"/>
      </body>
    </body></worldbody>
    <actuator><motor joint="a"/><motor joint="b"/></actuator>
  </mujoco>)");
  expect_as_mujoco(Model::load(file).value(), 1e-9);
}

}  // namespace
}  // namespace mjarm
