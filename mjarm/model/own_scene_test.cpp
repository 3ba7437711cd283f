// Scenes of one's own that include shipped models.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "mjarm/core/file.hpp"
#include "mjarm/model/check.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/model/shipped_test.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

fs::path models() { return find_model_file("ur5e")->parent_path().parent_path(); }

/// What stands in the first block of MJCF of models/README.md.
std::string scene_of_the_readme() {
  const std::string text = read_file(models() / "README.md").value();
  const std::string fence = "```xml\n";
  const std::size_t from = text.find(fence) + fence.size();
  return text.substr(from, text.find("```", from) - from);
}

TEST(OwnScene, OfTheReadmeLoadsWordForWordFromAnyFolder) {
  const support::TempFolder folder;
  const std::string words = scene_of_the_readme();
  ASSERT_THAT(words, HasSubstr("<include"));
  const testing::TestArm ur5e = testing::shipped_arm("ur5e");
  for (const char* name : {"cell.xml", "work/cells/one.xml"}) {
    const fs::path file = folder.write(name, words);
    const Result<Model> model = Model::load(file);
    ASSERT_TRUE(model) << model.error().what;
    EXPECT_EQ(model->name(), "my scene");
    const Result<Arm> arm = find_arm(*model);
    ASSERT_TRUE(arm) << arm.error().what;
    EXPECT_EQ(arm->home, ur5e.arm.home);
    EXPECT_EQ(arm->tip, ur5e.arm.tip);
  }
}

/// The Panda is made of parts, which are included from where it lies; its faults stand in its file.
TEST(OwnScene, MayIncludeAnyShippedModelInSeveralWays) {
  const support::TempFolder folder;
  const std::string relative = fs::relative(models(), fs::canonical(folder.path()) / "in").string();
  for (const std::string& way :
       {std::string("franka_emika_panda/panda.xml"), std::string("../franka_emika_panda/panda.xml"),
        std::string("../../x/../franka_emika_panda/panda.xml"),
        (models() / "franka_emika_panda/panda.xml").string(),
        relative + "/franka_emika_panda/panda.xml"}) {
    if (relative.empty() && way.starts_with('/')) continue;  // on another drive
    const fs::path file = folder.write(
        "in/cell.xml", "<mujoco model='cell'><include file='" + way +
                           "'/><worldbody><body name='part' pos='0.5 0 0.1'><freejoint/><geom "
                           "name='part' size='0.02' mass='0.1'/></body></worldbody></mujoco>");
    const Result<Model> model = Model::load(file);
    ASSERT_TRUE(model) << way << ": " << model.error().what;
    EXPECT_EQ(model->nq(), 9 + 7) << way;
    const Result<Arm> arm = find_arm(*model);
    ASSERT_TRUE(arm) << way;
    EXPECT_TRUE(arm->gripper) << way;
    EXPECT_TRUE(check_model(file)) << way;
  }
}

TEST(OwnScene, WhatLiesBesideItComesFirst) {
  const support::TempFolder folder;
  folder.write("scenes/studio.xml",
               "<mujocoinclude><worldbody><body name='mine'/></worldbody></mujocoinclude>");
  folder.write("parts/one.xml", "<mujocoinclude><include file='two.xml'/></mujocoinclude>");
  folder.write("parts/two.xml",
               "<mujocoinclude><worldbody><body name='two'/></worldbody></mujocoinclude>");
  const Result<Model> model = Model::load(folder.write("cell.xml",
                                                       "<mujoco><include file='scenes/studio.xml'/>"
                                                       "<include file='parts/one.xml'/></mujoco>"));
  ASSERT_TRUE(model) << model.error().what;
  const std::vector<double> qpos;
  EXPECT_TRUE(frame_pose(*model, "mine", qpos));
  EXPECT_TRUE(frame_pose(*model, "two", qpos));
}

TEST(OwnScene, WhatLiesElsewhereIsStillRefusedAndTheWordSaid) {
  const support::TempFolder folder;
  folder.write("secret.xml", "<mujoco><worldbody><geom size='1'/></worldbody></mujoco>");
  folder.write("universal_robots_ur5e/ur5e.xml", "<mujoco/>");
  for (const char* name :
       {"../secret.xml", "../universal_robots_ur5e/ur5e.xml", "../no_such/robot.xml",
        "../universal_robots_ur5e/../secret.xml", "../universal_robots_ur5e/../../secret.xml"}) {
    const fs::path file = folder.write(
        "in/cell.xml", "<mujoco>\n<include file='" + std::string(name) + "'/></mujoco>");
    const Result<Model> model = Model::load(file);
    ASSERT_FALSE(model) << name;
    EXPECT_THAT(model.error().what, HasSubstr("cell.xml:2: <include>")) << name;
    EXPECT_THAT(model.error().what, HasSubstr("--allow-outside")) << name;
  }
}

/// What an included file includes is looked through as well, wherever MuJoCo takes it from.
TEST(OwnScene, IncludesOfIncludesAreLookedThrough) {
  const support::TempFolder folder;
  folder.write("parts/one.xml", "<mujocoinclude><include file='two.xml'/></mujocoinclude>");
  folder.write("parts/two.xml",
               "<mujocoinclude>\n<worldbody><replicate count='1000000'><geom size='1'/></replicate>"
               "</worldbody></mujocoinclude>");
  const Result<Model> model =
      Model::load(folder.write("cell.xml", "<mujoco><include file='parts/one.xml'/></mujoco>"));
  ASSERT_FALSE(model);
  EXPECT_THAT(model.error().what, HasSubstr("two.xml:2"));
}

}  // namespace
}  // namespace mjarm
