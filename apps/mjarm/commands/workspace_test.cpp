#include <cmath>

#include "apps/mjarm/commands/program_test.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;

json map_of(const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {"workspace", "--robot", "ur5e", "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const auto result = mjarm(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return json::parse(result.out, nullptr, false);
}

/// Distance of the middle of cell `i` from the z axis, which is that of the UR5e's base.
double distance(const json& map, std::size_t i) {
  const auto columns = map.at("columns").get<std::size_t>();
  const double step = map.at("step");
  const double x = map.at("first")[0].get<double>() + step * static_cast<double>(i % columns);
  const double y = map.at("first")[1].get<double>() + step * static_cast<double>(i / columns);
  return std::hypot(x, y);
}

TEST(Workspace, HasTheHoleRoundTheBase) {
  // With the tool down it stands right below the wrist, which never gets nearer to the base axis
  // than the arm's side offset 0.138 - 0.131 + 0.127 m.
  const json map = map_of({"--slice", "z=0.4", "--step", "100mm", "--tool-down"});
  const json& branches = map.at("branches");
  ASSERT_EQ(branches.size(), map.at("columns").get<std::size_t>() * map.at("rows").get<int>());
  int inside = 0, reached = 0;
  for (std::size_t i = 0; i < branches.size(); ++i) {
    const double r = distance(map, i);
    if (r < 0.134) {
      EXPECT_EQ(branches[i], 0) << r;
      EXPECT_TRUE(map.at("manipulability")[i].is_null());
      ++inside;
    }
    if (r > 0.2 && r < 0.6) {
      EXPECT_GT(branches[i], 0) << r;
    }
    if (branches[i] > 0) {
      EXPECT_GE(map.at("manipulability")[i].get<double>(), 0);
      ++reached;
    }
  }
  EXPECT_GE(inside, 5);
  EXPECT_EQ(map.at("reached"), reached);
  EXPECT_GE(map.at("nearest").get<double>(), 0.134);
  EXPECT_LT(map.at("farthest").get<double>(), 0.97);
}

/// Its first axis is no line to stand off from.
TEST(Workspace, OfAnArmOnARailHasNoRing) {
  const support::TempFolder folder;
  const std::string arm = folder
                              .write("rail.xml", R"(<mujoco><compiler angle="radian"/><worldbody>
      <body name="sled" pos="0 0 0.2"><joint name="rail" type="slide" axis="1 0 0" range="-1 1"/>
        <geom type="box" size="0.1 0.1 0.05"/>
        <body name="upper"><joint name="turn" axis="0 0 1" range="-3 3"/>
          <geom type="capsule" fromto="0 0 0 0.3 0 0" size="0.03"/>
          <body name="lower" pos="0.3 0 0"><joint name="elbow" axis="0 0 1" range="-3 3"/>
            <geom type="capsule" fromto="0 0 0 0.3 0 0" size="0.03"/>
            <site name="tcp" pos="0.3 0 0"/></body></body></body>
      </worldbody></mujoco>)")
                              .string();
  const auto result = mjarm({"workspace", "--robot", arm, "--slice", "z=0.2", "--out",
                             (folder.path() / "map.json").string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ((result.out + result.err).find("base axis"), std::string::npos) << result.out;
  const auto map = support::load_json(folder.path() / "map.json");
  EXPECT_GT(map.at("reached"), 100);
  EXPECT_FALSE(map.contains("nearest"));
}

/// Where no slice is asked for it is one that the arm reaches: this one ends 0.27 m above the
/// floor.
TEST(Workspace, OfASmallArmIsLower) {
  const support::TempFolder folder;
  const std::string arm = folder
                              .write("small.xml", R"(<mujoco><compiler angle="radian"/><worldbody>
    <body name="turn"><joint name="a" axis="0 0 1" range="-3 3"/><geom size=".02"/>
    <body name="upper" pos="0 0 .05"><joint name="b" axis="0 1 0" range="-2 2"/><geom size=".02"/>
    <body name="lower" pos="0 0 .12"><joint name="c" axis="0 1 0" range="-2 2"/><geom size=".02"/>
    <site name="tool0" pos="0 0 .1"/></body></body></body></worldbody></mujoco>)")
                              .string();
  const auto result = mjarm({"workspace", "--robot", arm, "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(json::parse(result.out).at("slice").at("at"), 0.2);
  const auto asked = mjarm({"workspace", "--robot", arm, "--json", "--slice", "z=0.4"});
  EXPECT_EQ(asked.exit_code, 1);
}

TEST(Workspace, SameBytesForAnyNumberOfThreads) {
  const support::TempFolder folder;
  const auto run = [&](const std::string& threads, const std::string& name) {
    const auto result =
        mjarm({"workspace", "--robot", "panda", "--slice", "x=30cm", "--step", "150mm", "--threads",
               threads, "--position-only", "--out", (folder.path() / name).string()});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.out + folder.read(name);
  };
  for (const std::string ending : {"csv", "json", "svg", "png"}) {
    EXPECT_EQ(run("1", "a." + ending), run("3", "b." + ending)) << ending;
  }
}

TEST(Workspace, WritesWhatTheEndingSays) {
  const support::TempFolder folder;
  for (const std::string name : {"map.csv", "map.json", "map.svg", "map.png"}) {
    const auto result = mjarm({"workspace", "--robot", "ur5e", "--slice", "y=-0.2", "--step", "0.2",
                               "--euler", "90deg,0,0", "--out", (folder.path() / name).string()});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(support::lines_of(result.out).size(), 1u);
  }
  EXPECT_EQ(folder.read("map.csv").rfind("x,y,z,branches,manipulability\n", 0), 0u);
  EXPECT_EQ(json::parse(folder.read("map.json")).at("slice").at("axis"), "y");
  EXPECT_NE(folder.read("map.svg").find("</svg>"), std::string::npos);
  EXPECT_EQ(folder.read("map.png").substr(1, 3), "PNG");
}

TEST(Workspace, SaysWhatIsWrong) {
  const auto error_of = [](std::vector<std::string> more, int code) {
    std::vector<std::string> arguments = {"workspace", "--robot", "ur5e"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = mjarm(arguments);
    EXPECT_EQ(result.exit_code, code) << result.out;
    return only_line(result);
  };
  const auto holds = [](const std::string& line, const char* word) {
    EXPECT_NE(line.find(word), std::string::npos) << line;
  };
  holds(error_of({"--slice", "w=1"}, 2), "--slice");
  holds(error_of({"--slice", "z=near"}, 2), "--slice");
  holds(error_of({"--slice", "z=0.1deg"}, 2), "--slice");
  holds(error_of({"--step", "0"}, 2), "0");
  holds(error_of({"--step", "-1mm"}, 2), "-0.001");
  holds(error_of({"--step", "1um"}, 2), "1e-06");
  holds(error_of({"--threads", "many"}, 2), "--threads");
  holds(error_of({"--threads", "99999"}, 2), "--threads");
  holds(error_of({"--tool-down", "--euler", "0,0,0"}, 2), "--tool-down");
  holds(error_of({"--quat", "1,0,0"}, 2), "--quat");
  holds(error_of({"--out", "map.jpg"}, 2), "map.jpg");
  holds(error_of({"--slice", "z=5", "--step", "0.1"}, 1), "z = 5");
  holds(error_of({"--step", "0.3", "--out", "/no/such/folder/map.csv"}, 1), "/no/such/folder");
  holds(only_line(mjarm({"workspace"})), "--robot");
}

}  // namespace
}  // namespace mjarm::app
