#include "mjarm/kinematics/compare.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/compare_internal.hpp"
#include "mjarm/model/find_arm.hpp"
#include "tests/robots.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/test_data.hpp"

namespace mjarm {
namespace {

using std::numbers::pi;

std::string read(const std::filesystem::path& file) { return support::read_data(file); }

Arm shipped(const char* file) {
  return testing::arm_of(testing::load(testing::models_folder() / file));
}

constexpr const char* kUr5e = "universal_robots_ur5e/ur5e.xml";
constexpr const char* kUrdf = "universal_robots_ur5e/ur5e.urdf";
constexpr const char* kPanda = "franka_emika_panda/panda.xml";

/// Our UR5e's URDF with one text behind another one replaced.
Model edited(const std::string& behind, const std::string& from, const std::string& to) {
  const support::TempFolder folder;
  std::string text = read(testing::models_folder() / kUrdf);
  const std::size_t at = text.find(from, text.find(behind));
  if (at == std::string::npos) throw std::runtime_error(from);
  text.replace(at, from.size(), to);
  return testing::load(folder.write("robot.urdf", text));
}

Comparison compared(const Arm& first, const Arm& second) {
  auto result = compare_arms(first, second);
  if (!result) throw std::runtime_error(result.error().what);
  return *result;
}

/// The only cause, after checking that it is and that nothing is left.
Cause only_cause(const Arm& first, const Arm& second) {
  const Comparison result = compared(first, second);
  EXPECT_GT(std::max(result.position, result.rotation), 1e-6);
  EXPECT_LT(result.position_left, 1e-9);
  EXPECT_LT(result.rotation_left, 1e-9);
  EXPECT_EQ(result.causes.size(), 1u);
  for (const Cause& cause : result.causes) {
    EXPECT_TRUE(result.causes.size() == 1) << name(cause.code) << " " << cause.joint;
  }
  return result.causes.empty() ? Cause() : result.causes.front();
}

Cause cause_of_edit(const std::string& behind, const std::string& from, const std::string& to) {
  return only_cause(shipped(kUrdf), testing::arm_of(edited(behind, from, to)));
}

TEST(CompareArms, EqualArmsAgree) {
  for (const char* file : {kUr5e, kUrdf, kPanda}) {
    const Comparison result = compared(shipped(file), shipped(file));
    EXPECT_EQ(result.position, 0);
    EXPECT_EQ(result.rotation, 0);
    EXPECT_TRUE(result.causes.empty());
    EXPECT_TRUE(result.by_name);
  }
}

TEST(CompareArms, Ur5eUrdfHasItsBaseTurned) {
  const Cause base = only_cause(shipped(kUr5e), shipped(kUrdf));
  EXPECT_EQ(base.code, CauseCode::base);
  EXPECT_LT(base.shift.norm(), 1e-12);
  EXPECT_NEAR(std::abs(base.turn.z()), pi, 1e-12);
  EXPECT_EQ(base.same_as_zero_of, 0);
}

TEST(CompareArms, PandaUrdfAgrees) {
  const Comparison result = compared(shipped(kPanda), shipped("franka_emika_panda/panda.urdf"));
  EXPECT_FALSE(result.by_name);
  EXPECT_LT(result.position, 1e-9);
  EXPECT_LT(result.rotation, 1e-9);
}

TEST(CompareArms, LinkLength) {
  const Cause cause =
      cause_of_edit("<joint name=\"elbow_joint\"", "0 -0.131 0.425", "0 -0.131 0.43");
  EXPECT_EQ(cause.code, CauseCode::link);
  EXPECT_EQ(cause.joint, 2);
  EXPECT_LT((cause.shift - Eigen::Vector3d(0, 0, 0.005)).norm(), 1e-12);
  EXPECT_LT(cause.turn.norm(), 1e-12);
}

TEST(CompareArms, LinkLengthAlongParallelAxes) {
  const Cause cause =
      cause_of_edit("<joint name=\"elbow_joint\"", "0 -0.131 0.425", "0 -0.129 0.425");
  EXPECT_EQ(cause.code, CauseCode::link);
  EXPECT_EQ(cause.joint, 2);
}

TEST(CompareArms, JointAxisTurned) {
  const Cause cause = cause_of_edit("<joint name=\"wrist_1_joint\"", "xyz=\"0 0 0.392\" rpy=\"0",
                                    "xyz=\"0 0 0.392\" rpy=\"0.01");
  EXPECT_EQ(cause.code, CauseCode::link);
  EXPECT_EQ(cause.joint, 3);
  EXPECT_NEAR(cause.turn.norm(), 0.01, 1e-12);
}

TEST(CompareArms, ZeroOffset) {
  const Cause cause =
      cause_of_edit("<joint name=\"elbow_joint\"", "rpy=\"0 0 0\"", "rpy=\"0 0.2 0\"");
  EXPECT_EQ(cause.code, CauseCode::zero_offset);
  EXPECT_EQ(cause.joint, 2);
  EXPECT_NEAR(cause.offset, 0.2, 1e-12);
}

TEST(CompareArms, JointSign) {
  const Cause cause = cause_of_edit("<joint name=\"elbow_joint\"", "<axis xyz=\"0 1 0\"/>",
                                    "<axis xyz=\"0 -1 0\"/>");
  EXPECT_EQ(cause.code, CauseCode::joint_sign);
  EXPECT_EQ(cause.joint, 2);
}

TEST(CompareArms, ToolTurnedAndMoved) {
  const Cause turned = cause_of_edit("<joint name=\"wrist_3_link-tool0_fixed_joint\"",
                                     "rpy=\"-1.5707963267948966 0 0\"", "rpy=\"0 0 0\"");
  EXPECT_EQ(turned.code, CauseCode::tool);
  EXPECT_NEAR(turned.turn.norm(), pi / 2, 1e-12);
  EXPECT_LT(turned.shift.norm(), 1e-12);
  EXPECT_EQ(turned.same_as_zero_of, -1);
  const Cause moved =
      cause_of_edit("<joint name=\"wrist_3_link-tool0_fixed_joint\"", "0 0.1 0", "0 0.25 0");
  EXPECT_EQ(moved.code, CauseCode::tool);
  EXPECT_NEAR(moved.shift.z(), 0.15, 1e-12);
}

TEST(CompareArms, LastZeroOffsetLooksLikeATurnedTool) {
  const Cause cause =
      cause_of_edit("<joint name=\"wrist_3_joint\"", "rpy=\"0 0 0\"", "rpy=\"0 0.3 0\"");
  const bool as_tool = cause.code == CauseCode::tool && cause.same_as_zero_of == 5;
  const bool as_zero = cause.code == CauseCode::zero_offset && cause.joint == 5;
  EXPECT_TRUE(as_tool || as_zero) << name(cause.code);
}

TEST(CompareArms, BaseMoved) {
  const Cause cause =
      cause_of_edit("<joint name=\"shoulder_pan_joint\"", "0 0 0.163", "0.5 0 0.163");
  EXPECT_EQ(cause.code, CauseCode::base);
  EXPECT_LT((cause.shift - Eigen::Vector3d(0.5, 0, 0)).norm(), 1e-12);
}

TEST(CompareArms, JointsInAnotherOrder) {
  Arm second = shipped(kUr5e);
  std::swap(second.joints[1].name, second.joints[2].name);
  const Cause cause = only_cause(shipped(kUr5e), second);
  EXPECT_EQ(cause.code, CauseCode::joint_order);
}

TEST(CompareArms, OtherJointsCannotBeCompared) {
  const auto result = compare_arms(shipped(kUr5e), shipped(kPanda));
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, Errc::impossible);
  Arm slide = shipped(kUr5e);
  slide.joints[2].type = JointType::slide;
  EXPECT_FALSE(compare_arms(shipped(kUr5e), slide));
}

Eigen::Vector3d random_vector(Rng& rng, double size) {
  return {rng.uniform(-size, size), rng.uniform(-size, size), rng.uniform(-size, size)};
}

/// The same arm with all joint frames placed and turned at random.
Arm reframed(Arm arm, Rng& rng) {
  for (std::size_t i = 0; i < arm.joints.size(); ++i) {
    ArmJoint& joint = arm.joints[i];
    joint.name += "_b";
    // Along the axis a frame may be moved freely; about it, it may be turned.
    const Pose G{rng.uniform(-0.2, 0.2) * joint.axis, rotation_exp(random_vector(rng, 1))};
    const Pose back = G.inverse();
    joint.X_PJ = joint.X_PJ * G;
    joint.axis = G.R.transpose() * joint.axis;
    Pose& next = i + 1 < arm.joints.size() ? arm.joints[i + 1].X_PJ : arm.X_JT;
    next = back * next;
  }
  return arm;
}

/// A random cause of one kind; never one that is no difference at all.
Cause random_cause(CauseCode code, int dof, Rng& rng) {
  Cause cause{.code = code};
  const bool of_joint =
      code == CauseCode::link || code == CauseCode::zero_offset || code == CauseCode::joint_sign;
  if (of_joint) cause.joint = 1 + static_cast<int>(rng.below(static_cast<std::uint64_t>(dof - 2)));
  if (code == CauseCode::zero_offset) cause.offset = rng.uniform(0.1, 2);
  if (code == CauseCode::base || code == CauseCode::tool) {
    cause.shift = random_vector(rng, 0.3);
    cause.turn = random_vector(rng, 1.5);
  }
  if (code == CauseCode::link) cause.shift = random_vector(rng, 0.1);
  return cause;
}

TEST(CompareArms, RandomCausesAreFoundInOtherFrames) {
  Rng rng(5);
  for (const char* file : {kUr5e, kPanda}) {
    const Arm first = shipped(file);
    for (int i = 0; i < 60; ++i) {
      const auto code = static_cast<CauseCode>(1 + i % 5);
      const Cause cause = random_cause(code, first.dof(), rng);
      SCOPED_TRACE(std::string(file) + " " + std::string(name(code)) + " " +
                   std::to_string(cause.joint));
      const Arm second = reframed(with_causes(first, {cause}), rng);
      const Comparison result = compared(first, second);
      EXPECT_FALSE(result.by_name);
      EXPECT_GT(result.position, 1e-6);
      EXPECT_LT(result.position_left, 1e-9);
      EXPECT_LT(result.rotation_left, 1e-9);
      // A shift has parts along axes that show at later joints only; all else is one cause.
      if (code == CauseCode::link) {
        EXPECT_LE(result.causes.size(), 3u);
        continue;
      }
      ASSERT_EQ(result.causes.size(), 1u);
      EXPECT_EQ(result.causes[0].code, code);
      EXPECT_EQ(result.causes[0].joint, cause.joint);
      EXPECT_NEAR(result.causes[0].offset, cause.offset, 1e-9);
      EXPECT_LT((result.causes[0].shift - cause.shift).norm(), 1e-8);
      EXPECT_LT((result.causes[0].turn - cause.turn).norm(), 1e-8);
    }
  }
}

TEST(CompareArms, SeveralCausesAtOnce) {
  Rng rng(9);
  const Arm first = shipped(kUr5e);
  const std::vector<Cause> causes = {
      {.code = CauseCode::base, .turn = Eigen::Vector3d(0, 0, pi / 2)},
      {.code = CauseCode::link, .joint = 2, .shift = Eigen::Vector3d(0, 0, 0.005)},
      {.code = CauseCode::tool, .shift = Eigen::Vector3d(0, 0, 0.1)}};
  for (const Arm& second :
       {with_causes(first, causes), reframed(with_causes(first, causes), rng)}) {
    const Comparison result = compared(first, second);
    ASSERT_EQ(result.causes.size(), 3u);
    EXPECT_EQ(result.causes[0].code, CauseCode::base);
    EXPECT_NEAR(result.causes[0].turn.z(), pi / 2, 1e-9);
    EXPECT_EQ(result.causes[1].code, CauseCode::link);
    EXPECT_EQ(result.causes[1].joint, 2);
    EXPECT_EQ(result.causes[2].code, CauseCode::tool);
    EXPECT_LT(result.position_left, 1e-9);
  }
}

TEST(CompareArms, OfficialAndLegacyUr5eDifferInTheirLengths) {
  MJARM_TEST_FILE(official, "ground_truth/ur5e_official_urdf.json.gz");
  MJARM_TEST_FILE(legacy, "ground_truth/ur5e_legacy_urdf.json.gz");
  const support::TempFolder folder;
  const auto arm = [&](const std::filesystem::path& truth) {
    const auto text = support::load_json(truth).at("urdf").get<std::string>();
    return testing::arm_of(testing::load(folder.write("robot.urdf", text)));
  };
  const Comparison result = compared(arm(legacy), arm(official));
  EXPECT_GT(result.position, 1e-4);
  EXPECT_FALSE(result.causes.empty());
  EXPECT_LT(result.position_left, 1e-9);
  for (const Cause& cause : result.causes) {
    EXPECT_NE(cause.code, CauseCode::joint_sign);
    EXPECT_LT(cause.code == CauseCode::link ? cause.shift.norm() : 0, 0.002);
  }
}

TEST(CompareFigures, MassesAndLimitsThatDiffer) {
  const Model first = testing::load(testing::models_folder() / kUrdf);
  const Arm first_arm = testing::arm_of(first);
  EXPECT_TRUE(compare_figures(first, first_arm, first, first_arm).empty());

  const Model heavy = edited("<link name=\"forearm_link\"", "value=\"2.275\"", "value=\"2.5\"");
  const auto mass = compare_figures(first, first_arm, heavy, testing::arm_of(heavy));
  ASSERT_EQ(mass.size(), 1u);
  EXPECT_EQ(mass[0].joint, "elbow_joint");
  EXPECT_EQ(mass[0].what, "mass");
  EXPECT_DOUBLE_EQ(mass[0].first, 2.275);
  EXPECT_DOUBLE_EQ(mass[0].second, 2.5);

  const Model narrow =
      edited("<joint name=\"elbow_joint\"", "lower=\"-3.141592653589793\"", "lower=\"-2\"");
  const auto limit = compare_figures(first, first_arm, narrow, testing::arm_of(narrow));
  ASSERT_EQ(limit.size(), 1u);
  EXPECT_EQ(limit[0].what, "lower");

  const Model weak = edited("<joint name=\"elbow_joint\"", "effort=\"150\"", "effort=\"100\"");
  const auto torque = compare_figures(first, first_arm, weak, testing::arm_of(weak));
  ASSERT_EQ(torque.size(), 1u);
  EXPECT_EQ(torque[0].what, "torque");
}

}  // namespace
}  // namespace mjarm
