#include "apps/mjarm/commands/program_test.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;

json info(const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {"model", "info", "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const auto result = mjarm(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return json::parse(result.out, nullptr, false);
}

TEST(ModelInfo, Ur5eAsJson) {
  const json ur5e = info({"ur5e"});
  EXPECT_EQ(ur5e.at("format"), "MJCF");
  EXPECT_GT(ur5e.at("timestep").get<double>(), 0);
  EXPECT_EQ(ur5e.at("counts").at("joints"), 6);
  EXPECT_EQ(ur5e.at("counts").at("actuators"), 6);
  EXPECT_EQ(ur5e.at("keyframes"), json::array({"home"}));
  const json& arm = ur5e.at("arm");
  EXPECT_EQ(arm.at("tip"), "attachment_site");
  EXPECT_EQ(arm.at("home").size(), 6u);
  EXPECT_TRUE(arm.at("gripper").is_null());
  EXPECT_TRUE(std::find(arm.at("tips").begin(), arm.at("tips").end(), "ee_link") !=
              arm.at("tips").end());
  ASSERT_EQ(arm.at("joints").size(), 6u);
  const json& elbow = arm.at("joints")[2];
  EXPECT_EQ(elbow.at("name"), "elbow_joint");
  EXPECT_EQ(elbow.at("type"), "hinge");
  EXPECT_NEAR(elbow.at("position")[1].get<double>(), 3.1415, 1e-3);
  EXPECT_EQ(elbow.at("torque"), 150);
  // MJCF has fields for positions and torques only; the rest must be marked as not the file's.
  EXPECT_EQ(elbow.at("sources").at("torque"), "file");
  for (const char* limit : {"velocity", "acceleration", "jerk"}) {
    EXPECT_GT(elbow.at(limit).get<double>(), 0) << limit;
    EXPECT_EQ(elbow.at("sources").at(limit), "table") << limit;
  }
  EXPECT_EQ(elbow.at("actuator"), "elbow");
}

TEST(ModelInfo, PandaHasAGripperAndAChoiceOfTools) {
  const json arm = info({"panda"}).at("arm");
  EXPECT_EQ(arm.at("tip"), "hand_tcp");
  EXPECT_EQ(arm.at("joints").size(), 7u);
  EXPECT_TRUE(arm.at("gripper").is_object());
  EXPECT_EQ(info({"panda", "--tip", "hand"}).at("arm").at("tip"), "hand");
}

TEST(ModelInfo, UrdfGivesVelocities) {
  const json urdf = info({model_file("universal_robots_ur5e/ur5e.urdf")});
  EXPECT_EQ(urdf.at("format"), "URDF");
  EXPECT_EQ(urdf.at("arm").at("joints").at(0).at("sources").at("velocity"), "file");
}

TEST(ModelInfo, AModelWithoutAnArmSaysWhy) {
  const json car = info({model_file("car.xml")});
  EXPECT_TRUE(car.at("arm").is_null());
  EXPECT_FALSE(car.at("no_arm").get<std::string>().empty());
  EXPECT_EQ(car.at("counts").at("actuators"), 2);
  EXPECT_EQ(car.at("counts").at("sensors"), 2);
  EXPECT_EQ(mjarm({"model", "info", model_file("car.xml")}).exit_code, 0);
}

TEST(ModelInfo, TextInBothLanguages) {
  const auto english = mjarm({"model", "info", "ur5e"});
  EXPECT_EQ(english.exit_code, 0);
  for (const char* word : {"elbow_joint", "tool frame", "attachment_site", "150", "home"}) {
    EXPECT_NE(english.out.find(word), std::string::npos) << word;
  }
  const auto chinese = mjarm({"model", "info", "ur5e", "--lang", "zh-CN"});
  EXPECT_EQ(chinese.exit_code, 0);
  EXPECT_NE(chinese.out.find("工具坐标系"), std::string::npos);
  EXPECT_NE(chinese.out.find("attachment_site、"), std::string::npos) << chinese.out;
  EXPECT_EQ(support::lines_of(english.out).size(), support::lines_of(chinese.out).size());
}

TEST(ModelInfo, Failures) {
  const support::TempFolder folder;
  folder.write("broken.xml", "<mujoco><worldbody><body></worldbody></mujoco>");
  folder.write("notes.txt", "no model");
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"info", "ur5f"}, "ur5e"},
      {{"info", "nowhere/robot.xml"}, "nowhere/robot.xml"},
      {{"info", "broken.xml"}, "broken.xml"},
      {{"tree", "notes.txt"}, "notes.txt"},
      {{"tree", "."}, "."},
      {{"info", "ur5e", "--tip", "attachment_sit"}, "attachment_site"},
  };
  for (const auto& [arguments, says] : cases) {
    std::vector<std::string> all = {"model"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const auto result = mjarm(all, {.folder = folder.path(), .input = {}, .environment = {}});
    SCOPED_TRACE(::testing::PrintToString(arguments));
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(only_line(result).find(says), std::string::npos) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_FALSE(folder.exists("MUJOCO_LOG.TXT"));
  }
}

TEST(ModelTree, TextIsIndentedByDepth) {
  const auto tree = mjarm({"model", "tree", "panda"});
  EXPECT_EQ(tree.exit_code, 0) << tree.err;
  const auto lines = support::lines_of(tree.out);
  ASSERT_GE(lines.size(), 11u);
  EXPECT_EQ(lines[0].rfind("world", 0), 0u);
  bool found = false;
  for (const std::string& line : lines) {
    if (line.find("hand_tcp") == std::string::npos) continue;
    found = true;
    EXPECT_EQ(line.find_first_not_of(' ') % 2, 0u);
  }
  EXPECT_TRUE(found);
}

TEST(ModelTree, JsonNests) {
  const auto tree = mjarm({"model", "tree", "ur5e", "--json"});
  ASSERT_EQ(tree.exit_code, 0) << tree.err;
  const json world = json::parse(tree.out);
  EXPECT_EQ(world.at("name"), "world");
  int bodies = 0;
  double mass = 0;
  std::vector<json> open = {world};
  while (!open.empty()) {
    const json body = open.back();
    open.pop_back();
    ++bodies;
    mass += body.at("mass").get<double>();
    for (const json& child : body.at("children")) open.push_back(child);
  }
  const json facts = info({"ur5e"});
  EXPECT_EQ(bodies - 1, facts.at("counts").at("bodies").get<int>());
  EXPECT_NEAR(mass, facts.at("mass").get<double>(), 1e-9);
}

TEST(Doctor, TellsVersionsGraphicsAndModels) {
  const auto result = mjarm({"doctor", "--json"});
  const json facts = json::parse(result.out);
  bool draws = false;
  ASSERT_EQ(facts.at("gl").size(), 2u);
  for (const json& way : facts.at("gl")) {
    draws |= way.at("works").get<bool>();
    EXPECT_EQ(way.at("works"), way.at("reason").get<std::string>().empty());
  }
  // Everything is there but perhaps a renderer.
  EXPECT_EQ(facts.at("problems").size(), draws ? 0u : 1u) << result.err;
  EXPECT_EQ(facts.at("ok"), draws);
  EXPECT_EQ(result.exit_code, draws ? 0 : 1);
  EXPECT_EQ(facts.at("mujoco").get<std::string>().rfind("4.", 0), 0u);
  EXPECT_TRUE(std::filesystem::exists(facts.at("mujoco_library").get<std::string>()));
  EXPECT_GE(facts.at("cores").get<int>(), 1);
  std::vector<std::string> names;
  for (const json& model : facts.at("models")) {
    names.push_back(model.at("name"));
    EXPECT_TRUE(std::filesystem::exists(model.at("file").get<std::string>()));
  }
  for (const char* name : {"ur5e", "panda"}) {
    EXPECT_TRUE(std::find(names.begin(), names.end(), name) != names.end()) << name;
  }
  EXPECT_TRUE(facts.at("system").get<std::string>().starts_with("Linux "));
  const auto people = mjarm({"doctor"});
  EXPECT_NE(people.out.find(facts.at("system").get<std::string>()), std::string::npos);
  EXPECT_EQ(people.exit_code, result.exit_code);
  EXPECT_NE(people.out.find("MuJoCo"), std::string::npos);
  EXPECT_NE(mjarm({"doctor", "--lang", "zh-CN"}).out.find("模型"), std::string::npos);
}

TEST(Doctor, WithoutModelsSomethingIsMissing) {
  const support::TempFolder folder;
  std::filesystem::create_directories(folder.path() / "bin");
  std::filesystem::copy_file(MJARM_PROGRAM, folder.path() / "bin" / "mjarm");
  const auto result = support::run_program(folder.path() / "bin" / "mjarm", {"doctor"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("share/mjarm/models"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace mjarm::app
