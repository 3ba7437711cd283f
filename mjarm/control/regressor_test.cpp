#include "mjarm/control/regressor.hpp"

#include <gtest/gtest.h>

#include "mjarm/core/rng.hpp"
#include "mjarm/model/arm_dynamics.hpp"
#include "mjarm/model/link_inertials.hpp"
#include "mjarm/model/moved_bodies.hpp"
#include "mjarm/model/payload.hpp"
#include "mjarm/model/robot.hpp"

namespace mjarm {
namespace {

JointState random_state(const Arm& arm, Rng& rng) {
  JointState out = JointState::at_rest(arm.home);
  for (int i = 0; i < arm.dof(); ++i) {
    out.q[i] += 0.5 * rng.normal();
    out.v[i] = rng.normal();
    out.a[i] = rng.normal();
  }
  return out;
}

/// Torque of links and payload by MuJoCo, less that of damping.
JointVec moved_by_links(const Robot& robot, const Model& model, const JointState& state) {
  ArmDynamics dynamics(model, robot.arm);
  JointVec out = dynamics.inverse(state.q, state.v, state.a);
  for (int i = 0; i < robot.arm.dof(); ++i) {
    const ArmJoint& joint = robot.arm.joints[static_cast<std::size_t>(i)];
    out[i] -= joint.damping * state.v[i];
  }
  return out;
}

TEST(Regressor, TorquesAreThoseOfMujoco) {
  Rng rng(3);
  for (const char* name : {"ur5e", "panda"}) {
    const Robot robot = load_robot(name).value();
    const Eigen::VectorXd phi = parameters_of(robot.model, robot.arm);
    for (int i = 0; i < 20; ++i) {
      const JointState state = random_state(robot.arm, rng);
      const Regressor at = regressor_at(robot.arm, gravity_of(robot.model), state);
      const JointVec expected = moved_by_links(robot, robot.model, state);
      EXPECT_LT((at.links * phi - expected).cwiseAbs().maxCoeff(), 1e-6) << name;
    }
  }
}

TEST(Regressor, PayloadIsThatOfMujoco) {
  Rng rng(4);
  const Robot robot = load_robot("ur5e").value();
  const Payload payload{1.7, {0.03, -0.02, 0.08}};
  const Model loaded = with_payload(robot.model, robot.arm.tip, payload).value();
  Inertial point{payload.mass, payload.mass * payload.center, {}};
  point.inertia = payload.mass * (payload.center.squaredNorm() * Eigen::Matrix3d::Identity() -
                                  payload.center * payload.center.transpose());
  for (int i = 0; i < 20; ++i) {
    const JointState state = random_state(robot.arm, rng);
    const JointVec expected =
        moved_by_links(robot, loaded, state) - moved_by_links(robot, robot.model, state);
    const Regressor at = regressor_at(robot.arm, gravity_of(robot.model), state);
    EXPECT_LT((at.payload * point.vector() - expected).cwiseAbs().maxCoeff(), 1e-6);
  }
}

TEST(Regressor, ParametersHaveTheNamesOfTheirJoints) {
  const Arm arm = load_robot("ur5e").value().arm;
  EXPECT_EQ(parameter_name(0, arm), "m " + arm.joints[0].name);
  EXPECT_EQ(parameter_name(kInertialSize + 9, arm), "Iyz " + arm.joints[1].name);
  EXPECT_EQ(parameter_name(parameter_count(arm) - 1, arm), "rotor " + arm.joints[5].name);
}

TEST(Regressor, BaseParametersSayAllThatTorquesTell) {
  Rng rng(5);
  const Robot robot = load_robot("ur5e").value();
  const Eigen::Vector3d gravity = gravity_of(robot.model);
  const BaseColumns base = base_columns(robot.arm, gravity);
  // Of six turning joints, the first one upright: 36 of links, and the rotors from the third on.
  EXPECT_EQ(base.kept.size(), 40u);
  const Eigen::VectorXd phi = parameters_of(robot.model, robot.arm);
  for (int i = 0; i < 20; ++i) {
    const JointState state = random_state(robot.arm, rng);
    const Eigen::MatrixXd links = regressor_at(robot.arm, gravity, state).links;
    const Eigen::VectorXd told = links(Eigen::all, base.kept) * base.of(phi);
    EXPECT_LT((told - links * phi).cwiseAbs().maxCoeff(), 1e-3);
  }
}

}  // namespace
}  // namespace mjarm
