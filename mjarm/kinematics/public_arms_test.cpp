// Poses of public arms, each from a random seed. The descriptions come from the package
// example-robot-data of PyPI; the environment variable MJARM_ARMS_DATA names the folder that holds
// its `example-robot-data`.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "mjarm/core/rng.hpp"
#include "mjarm/kinematics/count_solved_test.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/model/find_arm.hpp"

namespace mjarm {
namespace {

struct PublicArm {
  const char* label;
  const char* file;
  const char* tip;  // the longest chain where empty
};

class PublicArms : public ::testing::TestWithParam<PublicArm> {};

TEST_P(PublicArms, PosesAreFoundAgain) {
  const char* data = std::getenv("MJARM_ARMS_DATA");
  if (data == nullptr || *data == '\0') {
    GTEST_SKIP() << "MJARM_ARMS_DATA is not set; it names the folder of the public arms";
  }
  const std::filesystem::path file =
      std::filesystem::path(data) / "example-robot-data/robots" / GetParam().file;
  ASSERT_TRUE(std::filesystem::exists(file)) << file;
  const auto model = Model::load(file);
  ASSERT_TRUE(model.has_value()) << model.error().what;
  const auto arm = find_arm(*model, {.tip = GetParam().tip});
  ASSERT_TRUE(arm.has_value()) << arm.error().what;
  for (const bool closed_form : {true, false}) {
    Rng rng(61);
    const IkSolver ik(*arm, {.closed_form = closed_form});
    EXPECT_GE(testing::count_solved(*arm, ik, 1000, rng), 999) << closed_form;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Public, PublicArms,
    ::testing::Values(
        PublicArm{"Ur5", "ur_description/urdf/ur5_robot.urdf", ""},
        PublicArm{"XArm7", "xarm_description/urdf/xarm7.urdf", ""},
        PublicArm{"So100", "so_arm_description/urdf/so100.urdf", ""},
        PublicArm{"Z1", "z1_description/urdf/z1.urdf", ""},
        PublicArm{"Tiago", "tiago_description/robots/tiago_no_hand.urdf", "wrist_ft_tool_link"},
        PublicArm{"TalosArm", "talos_data/robots/talos_left_arm.urdf", "gripper_left_base_link"}),
    [](const auto& arm) { return std::string(arm.param.label); });

}  // namespace
}  // namespace mjarm
