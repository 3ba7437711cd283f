// A user's own checkout of MuJoCo Menagerie loads, and its robots equal ours.
#include <algorithm>

#include "tests/robots.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/test_data.hpp"

namespace mjarm {
namespace {

/// Unpacks one packed folder of Menagerie into `folder`.
void unpack(const std::filesystem::path& archive, const support::TempFolder& folder) {
  const auto result = support::run_program("/bin/sh", {"-c", "exec tar -xJf \"$1\" -C \"$2\"", "sh",
                                                       archive.string(), folder.path().string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
}

/// Both models move, weigh and fall alike, within rounding.
void expect_equal(const std::filesystem::path& theirs_file, const char* ours_file,
                  const char* frame) {
  SCOPED_TRACE(ours_file);
  const Model theirs = testing::load(theirs_file);
  const Model ours = testing::load(testing::models_folder() / ours_file);
  ASSERT_EQ(theirs.nq(), ours.nq());
  ASSERT_EQ(theirs.nu(), ours.nu());
  const Arm their_arm = testing::arm_of(theirs, frame);
  const Arm our_arm = testing::arm_of(ours, frame);
  Dynamics their_dynamics(theirs);
  Dynamics our_dynamics(ours);
  Rng rng(21);
  for (int i = 0; i < 100; ++i) {
    const auto q = testing::random_qpos(ours, rng);
    const Pose X = fk(their_arm, as_span(testing::joints_of(their_arm, q)));
    const Pose Y = fk(our_arm, as_span(testing::joints_of(our_arm, q)));
    EXPECT_LT((X.p - Y.p).norm(), 1e-9);
    EXPECT_LT(angle_between(X.R, Y.R), 1e-9);
    const Eigen::MatrixXd dM = their_dynamics.mass_matrix(q) - our_dynamics.mass_matrix(q);
    EXPECT_LT(dM.cwiseAbs().maxCoeff(), 1e-9);
    const Eigen::VectorXd dg = their_dynamics.gravity(q) - our_dynamics.gravity(q);
    EXPECT_LT(dg.cwiseAbs().maxCoeff(), 1e-9);
  }
}

/// Same names, limits, drives and home of the arm.
void expect_same_drives(const std::filesystem::path& theirs_file, const char* ours_file,
                        const char* frame) {
  SCOPED_TRACE(ours_file);
  const Arm theirs = testing::arm_of(testing::load(theirs_file), frame);
  const Arm ours = testing::arm_of(testing::load(testing::models_folder() / ours_file), frame);
  ASSERT_EQ(theirs.dof(), ours.dof());
  EXPECT_EQ(theirs.home, ours.home);
  EXPECT_EQ(theirs.limits.lower, ours.limits.lower);
  EXPECT_EQ(theirs.limits.upper, ours.limits.upper);
  EXPECT_EQ(theirs.limits.torque, ours.limits.torque);
  for (std::size_t i = 0; i < ours.joints.size(); ++i) {
    const ArmJoint& a = theirs.joints[i];
    const ArmJoint& b = ours.joints[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.damping, b.damping);
    EXPECT_EQ(a.armature, b.armature);
    ASSERT_TRUE(a.actuator.has_value() && b.actuator.has_value()) << a.name;
    EXPECT_EQ(a.actuator->name, b.actuator->name);
    EXPECT_EQ(a.actuator->gain, b.actuator->gain);
    EXPECT_TRUE(std::ranges::equal(a.actuator->bias, b.actuator->bias)) << a.name;
    EXPECT_EQ(a.actuator->ctrl_lower, b.actuator->ctrl_lower);
    EXPECT_EQ(a.actuator->ctrl_upper, b.actuator->ctrl_upper);
    EXPECT_EQ(a.actuator->force_lower, b.actuator->force_lower);
    EXPECT_EQ(a.actuator->force_upper, b.actuator->force_upper);
  }
}

TEST(Menagerie, Ur5e) {
  MJARM_TEST_FILE(archive, "menagerie/universal_robots_ur5e.tar.xz");
  const support::TempFolder folder;
  ASSERT_NO_FATAL_FAILURE(unpack(archive, folder));
  const auto theirs = folder.path() / "universal_robots_ur5e";
  expect_equal(theirs / "scene.xml", "universal_robots_ur5e/ur5e.xml", "attachment_site");
  expect_same_drives(theirs / "ur5e.xml", "universal_robots_ur5e/ur5e.xml", "attachment_site");
  EXPECT_EQ(testing::arm_of(testing::load(theirs / "scene.xml")).tip, "attachment_site");
}

TEST(Menagerie, Panda) {
  MJARM_TEST_FILE(archive, "menagerie/franka_emika_panda.tar.xz");
  const support::TempFolder folder;
  ASSERT_NO_FATAL_FAILURE(unpack(archive, folder));
  const auto theirs = folder.path() / "franka_emika_panda";
  expect_equal(theirs / "scene.xml", "franka_emika_panda/panda.xml", "hand");
  expect_equal(theirs / "panda_nohand.xml", "franka_emika_panda/panda_nohand.xml",
               "attachment_site");
  expect_same_drives(theirs / "panda.xml", "franka_emika_panda/panda.xml", "hand");
  EXPECT_EQ(testing::load(theirs / "hand.xml").nv(), 2);
}

}  // namespace
}  // namespace mjarm
