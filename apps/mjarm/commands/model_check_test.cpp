#include "apps/mjarm/commands/program_test.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;

/// The UR5e with one text replaced, in a folder of its own.
std::string edited(const support::TempFolder& folder, const std::string& from,
                   const std::string& to) {
  std::string text = support::read_mjcf(model_file("universal_robots_ur5e/ur5e.xml"));
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  return folder.write("edited.xml", text).string();
}

TEST(ModelCheck, AGoodModelIsFine) {
  for (const char* model : {"ur5e", "panda", "car", "hello"}) {
    const auto result = mjarm({"model", "check", model});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_TRUE(result.err.empty()) << result.err;
    EXPECT_NE(result.out.find("nothing wrong"), std::string::npos) << result.out;
  }
}

TEST(ModelCheck, AWarningLeavesTheExitCode) {
  const support::TempFolder folder;
  const auto result = mjarm({"model", "check", edited(folder, "kp=\"2000\"", "kp=\"200\"")});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(result.err.empty()) << result.err;
  EXPECT_NE(result.out.find("[servo_sag]"), std::string::npos);
}

TEST(ModelCheck, AnErrorIsToldOnOneLine) {
  const support::TempFolder folder;
  const std::string file = edited(folder, "range=\"-3.1415 3.1415\"", "range=\"-180 180\"");
  const auto result = mjarm({"model", "check", file});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(only_line(result).rfind(file + ":", 0), 0u) << result.err;
  EXPECT_NE(result.out.find("[degrees_for_radians]"), std::string::npos);
  const auto chinese = mjarm({"model", "check", file, "--lang", "zh-CN"});
  EXPECT_NE(chinese.out.find("错误"), std::string::npos);
}

TEST(ModelCheck, AFileThatDoesNotLoadHasItsOwnExitCode) {
  const support::TempFolder folder;
  const std::string file = edited(folder, "0.0311796 0.0311796", "0.9 0.0311796");
  const auto result = mjarm({"model", "check", file, "--json"});
  EXPECT_EQ(result.exit_code, 2);
  only_line(result);
  const json document = json::parse(result.out);
  EXPECT_EQ(document.at("loads"), false);
  EXPECT_EQ(document.at("ok"), false);
  EXPECT_EQ(document.at("findings").at(0).at("code"), "inertia_triangle");
  EXPECT_EQ(mjarm({"model", "check", (folder.path() / "none.xml").string()}).exit_code, 2);
  EXPECT_EQ(mjarm({"model", "check"}).exit_code, 2);
}

TEST(ModelCheck, FilesOutsideAreReadOnRequest) {
  const support::TempFolder folder;
  const std::string file = folder.write("link.xml", "<body><geom size=\"0.1\"/></body>").string();
  const std::string model = folder
                                .write("inner/model.xml", "<mujoco><worldbody><include file=\"" +
                                                              file + "\"/></worldbody></mujoco>")
                                .string();
  const auto refused = mjarm({"model", "check", model});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(only_line(refused).find("--allow-outside"), std::string::npos) << refused.err;
  const auto read = mjarm({"model", "check", model, "--allow-outside"});
  EXPECT_NE(read.out.find("[arm_missing]"), std::string::npos) << read.out << read.err;
  const auto compared = mjarm({"model", "check", "ur5e", "--against", model, "--allow-outside"});
  EXPECT_EQ(compared.err.find("--allow-outside"), std::string::npos) << compared.err;
}

TEST(ModelCheck, AgainstFindsTheTurnedBase) {
  const std::string urdf = model_file("universal_robots_ur5e/ur5e.urdf");
  const auto result = mjarm({"model", "check", "ur5e", "--against", urdf, "--json"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(only_line(result).find("180 deg about z"), std::string::npos) << result.err;
  const json document = json::parse(result.out);
  ASSERT_EQ(document.at("causes").size(), 1u);
  EXPECT_EQ(document.at("causes").at(0).at("cause"), "base");
  EXPECT_LT(document.at("position_left").get<double>(), 1e-12);
  EXPECT_EQ(document.at("configurations"), 1000);
  const auto same = mjarm({"model", "check", urdf, "--against", urdf});
  EXPECT_EQ(same.exit_code, 0);
  EXPECT_NE(same.out.find("agree"), std::string::npos);
  EXPECT_EQ(mjarm({"model", "check", "ur5e", "--against", "panda"}).exit_code, 1);
  EXPECT_EQ(mjarm({"model", "check", "ur5e", "--against", "none.xml"}).exit_code, 2);
}

/// A UR5e whose gripper lets things creep, with a mesh of its own beside it.
std::string creeping_scene(const support::TempFolder& folder) {
  folder.write("in/meshes/stone.obj",
               "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  return folder
      .write("in/scene.xml", R"(<mujoco><include file="universal_robots_ur5e/ur5e_gripper.xml"/>
        <compiler meshdir="meshes"/><option cone="pyramidal" impratio="1"/>
        <asset><mesh name="stone" file="stone.obj"/></asset>
        <worldbody><geom type="mesh" mesh="stone" pos="2 0 0"/></worldbody></mujoco>)")
      .string();
}

TEST(ModelCheck, FixWritesASceneWhoseGripperHolds) {
  const support::TempFolder folder;
  const std::string scene = creeping_scene(folder);
  const std::string out = (folder.path() / "out/fixed.xml").string();
  std::filesystem::create_directory(folder.path() / "out");
  const auto result = mjarm({"model", "check", scene, "--fix", out});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("[grip_creep]"), std::string::npos) << result.out;
  EXPECT_NE(result.err.find(out + ": written"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("--allow-outside"), std::string::npos) << result.err;
  const auto again = mjarm({"model", "check", out, "--allow-outside"});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(again.out.find("[grip_"), std::string::npos) << again.out;
  EXPECT_NE(again.out.find("nothing wrong"), std::string::npos) << again.out;
  const auto nothing = mjarm({"model", "check", out, "--allow-outside", "--fix", scene + ".xml"});
  EXPECT_EQ(nothing.exit_code, 0) << nothing.err;
  EXPECT_NE(nothing.err.find("is not written"), std::string::npos) << nothing.err;
  EXPECT_FALSE(std::filesystem::exists(scene + ".xml"));
  const auto chinese = mjarm({"model", "check", scene, "--lang", "zh-CN"});
  EXPECT_NE(chinese.out.find("蠕滑"), std::string::npos) << chinese.out;
}

TEST(ModelCheck, FixRefusesWhatItCannotWrite) {
  const support::TempFolder folder;
  const std::string scene = creeping_scene(folder);
  const std::string before = folder.read("in/scene.xml");
  const auto over = mjarm({"model", "check", scene, "--fix", scene});
  EXPECT_EQ(over.exit_code, 2);
  EXPECT_NE(only_line(over).find("name another one for --fix"), std::string::npos) << over.err;
  EXPECT_EQ(folder.read("in/scene.xml"), before);
  const auto urdf = mjarm({"model", "check", scene, "--fix", "out.urdf"});
  EXPECT_EQ(urdf.exit_code, 2);
  EXPECT_NE(only_line(urdf).find(".xml"), std::string::npos) << urdf.err;
  EXPECT_EQ(mjarm({"model", "check", scene, "--fix", "o.xml", "--against", "ur5e"}).exit_code, 2);
  const auto nowhere = mjarm({"model", "check", scene, "--fix", "/none/o.xml"});
  EXPECT_EQ(nowhere.exit_code, 1);
  EXPECT_NE(nowhere.err.find("/none"), std::string::npos) << nowhere.err;
}

}  // namespace
}  // namespace mjarm::app
