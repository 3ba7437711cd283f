// Arms as users bring them: each by the name of its file alone draws a square of 10 cm in MuJoCo.
// Those that are not ours come from packages that tools/fetch_arms.sh fetches (`./dev arms`); the
// environment variable MJARM_ARMS_DATA names their folder.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/run_program.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/test_data.hpp"

namespace mjarm {
namespace {

namespace fs = std::filesystem;
using support::TempFolder;

/// Draws the square and checks what the program says of it.
void draw_square(const std::string& robot, const std::string& tip) {
  const TempFolder folder;
  std::vector<std::string> arguments = {
      "demo",    "square", "--headless", "--no-timing",
      "--robot", robot,    "--out",      (folder.path() / "out").string()};
  if (!tip.empty()) {
    // Only where the program asks for it.
    const auto asked = support::run_program(MJARM_PROGRAM, arguments);
    EXPECT_EQ(asked.exit_code, 2) << asked.err;
    EXPECT_NE(asked.err.find(tip), std::string::npos) << asked.err;
    arguments.insert(arguments.end(), {"--tip", tip});
  }
  const auto result = support::run_program(MJARM_PROGRAM, arguments);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("square of 0.1 m in the plane"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("start"), std::string::npos) << result.err;
  const auto report = nlohmann::json::parse(folder.read("out/report.json"));
  EXPECT_TRUE(report["ok"].get<bool>());
  EXPECT_EQ(report["coverage"].get<double>(), 1.0);
  EXPECT_LT(report["path_error_max"].get<double>(), 5e-4);
  EXPECT_LT(report["max_joint_step"].get<double>(), 0.1);
  // Fingers that are closed touch each other; nothing else may touch.
  const auto contact = report["first_contact"];
  EXPECT_TRUE(contact.is_null() || contact.get<std::string>().find("finger") != std::string::npos)
      << contact;
}

TEST(TwelveArms, Ours) {
  draw_square("ur5e", "");
  draw_square("panda", "");
}

/// Menagerie's own folders, packed.
void draw_from_archive(const fs::path& archive, const std::string& scene) {
  const TempFolder folder;
  const auto result = support::run_program("/bin/sh", {"-c", "exec tar -xJf \"$1\" -C \"$2\"", "sh",
                                                       archive.string(), folder.path().string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  draw_square((folder.path() / scene).string(), "");
}

TEST(TwelveArms, MenagerieUr5e) {
  MJARM_TEST_FILE(archive, "menagerie/universal_robots_ur5e.tar.xz");
  draw_from_archive(archive, "universal_robots_ur5e/scene.xml");
}

TEST(TwelveArms, MenageriePanda) {
  MJARM_TEST_FILE(archive, "menagerie/franka_emika_panda.tar.xz");
  draw_from_archive(archive, "franka_emika_panda/scene.xml");
}

/// A public description, and the tip where it has several.
struct PublicArm {
  const char* label;
  const char* file;
  const char* tip;
};

class TwelveArms : public ::testing::TestWithParam<PublicArm> {
 protected:
  void SetUp() override {
    const char* data = std::getenv("MJARM_ARMS_DATA");
    if (data == nullptr || *data == '\0') {
      GTEST_SKIP() << "MJARM_ARMS_DATA is not set; ./dev arms fetches the robots and sets it";
    }
    file_ = fs::path(data) / GetParam().file;
    ASSERT_TRUE(fs::exists(file_)) << file_;
  }
  std::string file() const { return file_.string(); }

 private:
  fs::path file_;
};

TEST_P(TwelveArms, DrawASquare) { draw_square(file(), GetParam().tip); }

TEST_P(TwelveArms, RefuseNoHardPose) {
  std::vector<std::string> arguments = {"bench",   "ik",          "--hard",  "--rounds", "1",
                                        "--quiet", "--no-timing", "--robot", file()};
  if (*GetParam().tip != '\0') arguments.insert(arguments.end(), {"--tip", GetParam().tip});
  const auto result = support::run_program(MJARM_PROGRAM, arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err << result.out;
}

INSTANTIATE_TEST_SUITE_P(
    Public, TwelveArms,
    ::testing::Values(
        PublicArm{"Ur5", "example-robot-data/robots/ur_description/urdf/ur5_robot.urdf", ""},
        PublicArm{"Panda", "example-robot-data/robots/panda_description/urdf/panda.urdf", ""},
        PublicArm{"Iiwa", "rtb-data/kuka_description/kuka_lbr_iiwa/urdf/lbr_iiwa_14_r820.urdf", ""},
        PublicArm{"XArm7", "example-robot-data/robots/xarm_description/urdf/xarm7.urdf", ""},
        PublicArm{"So100", "example-robot-data/robots/so_arm_description/urdf/so100.urdf", ""},
        PublicArm{"Z1", "example-robot-data/robots/z1_description/urdf/z1.urdf", ""},
        PublicArm{"Tiago", "example-robot-data/robots/tiago_description/robots/tiago_no_hand.urdf",
                  "wrist_ft_tool_link"},
        PublicArm{"TalosArm", "example-robot-data/robots/talos_data/robots/talos_left_arm.urdf",
                  "gripper_left_fingertip_1_link"},
        PublicArm{"Kinova", "example-robot-data/robots/kinova_description/robots/kinova.urdf",
                  "j2s6s200_link_finger_tip_1"},
        PublicArm{"Ur3", "example-robot-data/robots/ur_description/urdf/ur3_robot.urdf", ""},
        PublicArm{"Ur10", "example-robot-data/robots/ur_description/urdf/ur10_robot.urdf", ""},
        PublicArm{"So101", "example-robot-data/robots/so_arm_description/urdf/so101.urdf", ""},
        PublicArm{"Puma560", "rtb-data/unimation_puma560_description/urdf/puma560_robot.urdf", ""},
        PublicArm{"Irb140", "rtb-data/abb_irb140_description/urdf/irb140.urdf", ""},
        PublicArm{"Kr16", "rtb-data/kuka_description/kuka_kr16/urdf/kr16_2.urdf", ""}),
    [](const auto& arm) { return std::string(arm.param.label); });

}  // namespace
}  // namespace mjarm
