// Our robots, through our own model and kinematics, against figures computed by other programs.
#include <array>
#include <cmath>

#include "tests/robots.hpp"
#include "tests/support/test_data.hpp"

namespace mjarm {
namespace {

using nlohmann::json;
using Values = std::vector<double>;

Values values(const json& list) { return list.get<Values>(); }

Pose pose_of(const json& entry) {
  const auto p = entry.at("pos").get<std::array<double, 3>>();
  const auto q = entry.at("quat").get<std::array<double, 4>>();
  return {Eigen::Vector3d(p[0], p[1], p[2]), to_matrix(Quat(q[0], q[1], q[2], q[3]))};
}

Eigen::MatrixXd matrix_of(const json& rows) {
  const auto list = rows.get<std::vector<Values>>();
  Eigen::MatrixXd matrix(list.size(), list.at(0).size());
  for (std::size_t r = 0; r < list.size(); ++r) {
    matrix.row(static_cast<Eigen::Index>(r)) = Eigen::Map<const Eigen::RowVectorXd>(
        list[r].data(), static_cast<Eigen::Index>(list[r].size()));
  }
  return matrix;
}

void expect_pose(const Pose& X, const Pose& X_expected, double rot_tol = 1e-9) {
  EXPECT_LT((X.p - X_expected.p).norm(), 1e-9);
  EXPECT_LT(angle_between(X.R, X_expected.R), rot_tol);
}

/// Within 1e-8 + 1e-9 |x| of the expected torque [N m].
void expect_torque(const Eigen::VectorXd& torque, const json& expected, const char* what) {
  const Values x = values(expected);
  ASSERT_EQ(torque.size(), static_cast<Eigen::Index>(x.size())) << what;
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_NEAR(torque[static_cast<Eigen::Index>(i)], x[i], 1e-8 + 1e-9 * std::abs(x[i])) << what;
  }
}

/// Compares FK and Jacobian of the arm; `X_WU` is the pose of the data's world in the file's.
void expect_kinematics(const Arm& arm, const json& c, const Pose& X_WU = {},
                       double rot_tol = 1e-9) {
  const JointVec q = testing::joints_of(arm, values(c.at("q")));
  const auto [X_WT, J_W] = fk_jacobian(arm, as_span(q));
  expect_pose(X_WT, X_WU * pose_of(c), rot_tol);
  Eigen::MatrixXd J = matrix_of(c.at("jac"));
  J.topRows(3) = X_WU.R * J.topRows(3).eval();
  J.bottomRows(3) = X_WU.R * J.bottomRows(3).eval();
  for (int i = 0; i < arm.dof(); ++i) {
    const int dof = arm.joints[static_cast<std::size_t>(i)].dof;
    EXPECT_LT((J_W.col(i) - J.col(dof)).cwiseAbs().maxCoeff(), 1e-9) << "joint " << i;
  }
}

void expect_dynamics(Dynamics& dynamics, const json& c) {
  const Values q = values(c.at("q"));
  const Values qd = values(c.at("qd"));
  const Values qdd = values(c.at("qdd"));
  EXPECT_LT((dynamics.mass_matrix(q) - matrix_of(c.at("M"))).cwiseAbs().maxCoeff(), 1e-9);
  expect_torque(dynamics.gravity(q), c.at("gravity"), "gravity");
  expect_torque(dynamics.bias(q, qd), c.at("bias"), "bias");
  expect_torque(dynamics.inverse(q, qd, qdd), c.at("tau"), "tau");
}

/// The MuJoCo files: MJCF with armature, and the pose of every body.
void expect_mujoco(const char* model_file, const std::filesystem::path& data_file) {
  const Model model = testing::load(testing::models_folder() / model_file);
  const json data = support::load_json(data_file);
  const Arm arm = testing::arm_of(model, data.at("ee"));
  Dynamics dynamics(model);
  ASSERT_EQ(data.at("joints").size(), static_cast<std::size_t>(model.nv()));
  for (const ArmJoint& joint : arm.joints) {
    EXPECT_EQ(joint.name, data.at("joints").at(static_cast<std::size_t>(joint.dof)));
  }
  ASSERT_GE(data.at("cases").size(), 50U);
  for (const json& c : data.at("cases")) {
    expect_kinematics(arm, c);
    expect_dynamics(dynamics, c);
    for (const auto& [body, pose] : c.at("bodies").items()) {
      const auto X = frame_pose(model, body, values(c.at("q")));
      ASSERT_TRUE(X.has_value()) << X.error().what;
      SCOPED_TRACE(body);
      expect_pose(*X, pose_of(pose));
    }
  }
}

/// The URDF files; `X_WU` is the pose of the data's root in the root of our file.
void expect_urdf(const char* model_file, const std::filesystem::path& data_file, const Pose& X_WU,
                 double rot_tol = 1e-9) {
  const Model model = testing::load(testing::models_folder() / model_file);
  const json data = support::load_json(data_file);
  const Arm arm = testing::arm_of(model, data.at("ee"));
  Dynamics dynamics(model);
  ASSERT_GE(data.at("cases").size(), 50U);
  for (const json& c : data.at("cases")) {
    expect_kinematics(arm, c, X_WU, rot_tol);
    expect_dynamics(dynamics, c);
  }
}

TEST(GroundTruth, Ur5e) {
  MJARM_TEST_FILE(data, "ground_truth/ur5e_menagerie.json.gz");
  expect_mujoco("universal_robots_ur5e/ur5e.xml", data);
}

TEST(GroundTruth, PandaWithoutHand) {
  MJARM_TEST_FILE(data, "ground_truth/panda_nohand_menagerie.json.gz");
  expect_mujoco("franka_emika_panda/panda_nohand.xml", data);
}

TEST(GroundTruth, Panda) {
  MJARM_TEST_FILE(data, "ground_truth/panda_menagerie.json.gz");
  expect_mujoco("franka_emika_panda/panda.xml", data);
}

TEST(GroundTruth, Ur5eUrdf) {
  MJARM_TEST_FILE(data, "ground_truth/ur5e_legacy_urdf.json.gz");
  expect_urdf("universal_robots_ur5e/ur5e.urdf", data, testing::half_turn());
}

/// Our Panda turns the hand by a quaternion of seven digits, in both formats; the data do not.
TEST(GroundTruth, PandaUrdf) {
  MJARM_TEST_FILE(data, "ground_truth/panda_urdf.json.gz");
  expect_urdf("franka_emika_panda/panda.urdf", data, Pose(), 1e-7);
}

TEST(GroundTruth, PandaAgainstTheExactHand) {
  MJARM_TEST_FILE(file, "ground_truth/panda_urdf.json.gz");
  const Model model = testing::load(testing::models_folder() / "franka_emika_panda/panda.xml");
  const Arm arm = testing::arm_of(model, "hand_tcp");
  const json data = support::load_json(file);
  ASSERT_GE(data.at("cases").size(), 50U);
  for (const json& c : data.at("cases")) {
    const Pose X = fk(arm, as_span(testing::joints_of(arm, values(c.at("q")))));
    EXPECT_LT((X.p - pose_of(c).p).norm(), 1e-9);
    EXPECT_LT(angle_between(X.R, pose_of(c).R), 1e-7);
  }
}

/// Today's DH table of Universal Robots differs from the older figures used here: were the test
/// above blind, it would pass with this file, too.
TEST(GroundTruth, TellsTheOfficialFiguresApart) {
  MJARM_TEST_FILE(file, "ground_truth/ur5e_official_urdf.json.gz");
  const Model model = testing::load(testing::models_folder() / "universal_robots_ur5e/ur5e.urdf");
  const Arm arm = testing::arm_of(model, "tool0");
  const json data = support::load_json(file);
  double farthest = 0;
  for (const json& c : data.at("cases")) {
    const Pose X = fk(arm, as_span(testing::joints_of(arm, values(c.at("q")))));
    farthest = std::max(farthest, (X.p - pose_of(c).p).norm());
  }
  EXPECT_GT(farthest, 1e-3);
  EXPECT_LT(farthest, 2e-3);
}

}  // namespace
}  // namespace mjarm
