// Models made by others, and the columns that MuJoCo and pinocchio computed for them: poses, mass
// matrix, gravity, bias and inverse dynamics through this room's own loader.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <filesystem>

#include "mjarm/core/rotation.hpp"
#include "mjarm/model/dynamics.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/model/test_chain_internal.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/test_data.hpp"

namespace mjarm {
namespace {

namespace fs = std::filesystem;

void expect_close(const Eigen::VectorXd& ours, const nlohmann::json& theirs, const char* what) {
  ASSERT_EQ(static_cast<std::size_t>(ours.size()), theirs.size()) << what;
  for (Eigen::Index i = 0; i < ours.size(); ++i) {
    const double value = theirs[static_cast<std::size_t>(i)].get<double>();
    EXPECT_NEAR(ours[i], value, 1e-8 + 1e-9 * std::abs(value)) << what << ' ' << i;
  }
}

/// Every case of `truth` against `model`; its values are in the order of qpos.
void expect_truth(const Model& model, const nlohmann::json& truth) {
  Dynamics dynamics(model);
  const std::string tip = truth.at("ee");
  const auto arm = find_arm(model, {.tip = tip});
  ASSERT_TRUE(arm) << arm.error().what;
  ASSERT_GE(truth.at("cases").size(), 100U);
  for (const auto& item : truth.at("cases")) {
    const auto q = item.at("q").get<std::vector<double>>();
    const auto v = item.at("qd").get<std::vector<double>>();
    const auto a = item.at("qdd").get<std::vector<double>>();
    const Pose X_WT = compose(*arm, std::span(q).first(static_cast<std::size_t>(arm->dof())));
    const auto pos = item.at("pos").get<std::vector<double>>();
    const auto quat = item.at("quat").get<std::vector<double>>();
    EXPECT_LT((X_WT.p - Eigen::Vector3d(pos.data())).norm(), 1e-9);
    EXPECT_LT(angle_between(X_WT.R, to_matrix(Quat(quat[0], quat[1], quat[2], quat[3]))), 1e-9);
    const Eigen::MatrixXd M = dynamics.mass_matrix(q);
    for (int row = 0; row < model.nv(); ++row) {
      for (int column = 0; column < model.nv(); ++column) {
        EXPECT_NEAR(M(row, column), item.at("M")[row][column].get<double>(), 1e-9);
      }
    }
    expect_close(dynamics.gravity(q), item.at("gravity"), "gravity");
    expect_close(dynamics.bias(q, v), item.at("bias"), "bias");
    expect_close(dynamics.inverse(q, v, a), item.at("tau"), "tau");
  }
}

struct PublicModel {
  const char* archive;
  const char* file;
  const char* truth;
};

class Menagerie : public ::testing::TestWithParam<PublicModel> {};

TEST_P(Menagerie, MatchesItsGroundTruth) {
  MJARM_TEST_ARCHIVE(archive, GetParam().archive);
  MJARM_TEST_FILE(truth, GetParam().truth);
  const support::TempFolder folder;
  support::unpack(archive, folder.path());
  const auto model = Model::load(folder.path() / GetParam().file);
  ASSERT_TRUE(model) << model.error().what;
  expect_truth(*model, support::load_json(truth));
}

INSTANTIATE_TEST_SUITE_P(
    Files, Menagerie,
    ::testing::Values(
        PublicModel{"menagerie/universal_robots_ur5e.tar.xz", "universal_robots_ur5e/ur5e.xml",
                    "ground_truth/ur5e_menagerie.json.gz"},
        PublicModel{"menagerie/franka_emika_panda.tar.xz", "franka_emika_panda/panda.xml",
                    "ground_truth/panda_menagerie.json.gz"},
        PublicModel{"menagerie/franka_emika_panda.tar.xz", "franka_emika_panda/panda_nohand.xml",
                    "ground_truth/panda_nohand_menagerie.json.gz"}));

TEST(MenagerieScenes, ArmsAreFoundWithoutHelp) {
  MJARM_TEST_ARCHIVE(ur5e, "menagerie/universal_robots_ur5e.tar.xz");
  MJARM_TEST_ARCHIVE(panda, "menagerie/franka_emika_panda.tar.xz");
  const support::TempFolder folder;
  support::unpack(ur5e, folder.path());
  support::unpack(panda, folder.path());
  struct Expected {
    const char* file;
    int dof;
    const char* tip;
    bool gripper;
  };
  Rng rng(11);
  for (const Expected& e :
       {Expected{"universal_robots_ur5e/scene.xml", 6, "attachment_site", false},
        Expected{"universal_robots_ur5e/ur5e.xml", 6, "attachment_site", false},
        Expected{"franka_emika_panda/scene.xml", 7, "hand", true},
        Expected{"franka_emika_panda/panda.xml", 7, "hand", true},
        Expected{"franka_emika_panda/panda_nohand.xml", 7, "attachment_site", false}}) {
    const auto model = Model::load(folder.path() / e.file);
    ASSERT_TRUE(model) << model.error().what;
    EXPECT_TRUE(model->warnings().empty()) << model->warnings()[0];
    const auto arm = find_arm(*model);
    ASSERT_TRUE(arm) << arm.error().what;
    EXPECT_EQ(arm->dof(), e.dof);
    EXPECT_EQ(arm->tip, e.tip);
    EXPECT_EQ(arm->gripper.has_value(), e.gripper);
    if (arm->gripper) {
      EXPECT_DOUBLE_EQ(arm->gripper->drives[0].ctrl_open, 255);
      EXPECT_DOUBLE_EQ(arm->gripper->drives[0].ctrl_closed, 0);
    }
    for (const ArmJoint& joint : arm->joints) EXPECT_TRUE(joint.actuator) << joint.name;
    EXPECT_EQ(arm->limits.sources[0].velocity, LimitSource::table);
    EXPECT_LT(worst_chain_error(*model, *arm, rng, 100), 1e-12) << e.file;
  }
}

class PinocchioUrdf : public ::testing::TestWithParam<const char*> {};

TEST_P(PinocchioUrdf, MatchesItsGroundTruth) {
  MJARM_TEST_FILE(file, std::string("ground_truth/") + GetParam() + ".json.gz");
  const auto truth = support::load_json(file);
  const support::TempFolder folder;
  const auto model = Model::load(folder.write("robot.urdf", truth.at("urdf").get<std::string>()));
  ASSERT_TRUE(model) << model.error().what;
  EXPECT_EQ(model->format(), ModelFormat::urdf);
  EXPECT_EQ(find_arm(*model).value().tip, truth.at("ee").get<std::string>());
  expect_truth(*model, truth);
}

INSTANTIATE_TEST_SUITE_P(Files, PinocchioUrdf,
                         ::testing::Values("ur5e_official_urdf", "ur5e_legacy_urdf", "panda_urdf"));

}  // namespace
}  // namespace mjarm
