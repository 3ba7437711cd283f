// mjarm check and mjarm run, as a user calls them.
#include <gmock/gmock.h>

#include <filesystem>

#include "apps/mjarm/commands/program_test.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/program/held_part_test.hpp"
#include "tests/support/rounds.hpp"

namespace mjarm::app {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kProgram = R"(robot: ur5e
program:
  - movej: {pos: [0.1, -0.45, 0.4], euler: [180deg, 0, 0]}
  - movel: {pos: [-0.1, -0.45, 0.4], euler: [180deg, 0, 0], speed: 0.2, blend: 10mm}
  - movel: {pos: [-0.1, -0.45, 0.3], euler: [180deg, 0, 0]}
  - wait: 100ms
)";

TEST(Check, ListsTheMotions) {
  const support::TempFolder folder;
  const auto file = folder.write("cell.yaml", kProgram).string();
  const auto result = mjarm({"check", file});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("movel x2"));
  EXPECT_THAT(result.out, HasSubstr("cycle time"));
  const auto plan = nlohmann::json::parse(mjarm({"check", file, "--json"}).out);
  EXPECT_EQ(plan.at("ok"), true);
  ASSERT_EQ(plan.at("moves").size(), 3U);
  EXPECT_EQ(plan.at("moves")[1].at("line"), 4);
  EXPECT_GT(plan.at("moves")[1].at("min_singular_value"), 0.1);
}

/// Whoever is told that --allow-outside is needed can write it.
TEST(Check, EveryCommandOnProgramsTakesWhatItsMessageAsksFor) {
  const support::TempFolder folder;
  folder.write("table.xml",
               "<mujocoinclude><worldbody><geom name='table' type='box' size='0.2 0.2 0.01' "
               "pos='0.6 0 0.2'/></worldbody></mujocoinclude>");
  folder.write("in/cell.xml",
               "<mujoco><include file='../universal_robots_ur5e/ur5e.xml'/>"
               "<include file='../table.xml'/></mujoco>");
  const auto file =
      folder.write("in/one.yaml", "scene: cell.xml\nprogram: [wait: 10ms]\n").string();
  const std::string out = (folder.path() / "out").string();
  const std::string picture = (folder.path() / "a.png").string();
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"check", file},
        {"run", file, "--headless", "--out", out},
        {"export", file, "--to", "urscript"},
        {"render", file, "--out", picture, "--size", "64x64"}}) {
    const auto refused = mjarm(words);
    EXPECT_EQ(refused.exit_code, 2) << words[0];
    EXPECT_THAT(only_line(refused), HasSubstr("--allow-outside")) << words[0];
    std::vector<std::string> more = words;
    more.push_back("--allow-outside");
    const auto done = mjarm(more);
    EXPECT_EQ(done.exit_code, 0) << words[0] << ": " << done.err;
  }
  // Where nobody can look, the window says so and nothing of the files.
  const auto view = mjarm({"view", file, "--allow-outside"},
                          {.environment = {{"DISPLAY", ""}, {"WAYLAND_DISPLAY", ""}}});
  EXPECT_EQ(view.exit_code, 1);
  EXPECT_THAT(only_line(view), HasSubstr("mjarm render"));
}

TEST(Run, WithoutADisplayItSaysThatNoWindowOpens) {
  const support::TempFolder folder;
  const auto file = folder.write("cell.yaml", "robot: ur5e\nprogram:\n  - wait: 100ms\n").string();
  const auto say = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"run", file, "--out", (folder.path() / "out").string()});
    const auto done = mjarm(more, {.environment = {{"DISPLAY", ""}, {"WAYLAND_DISPLAY", ""}}});
    EXPECT_EQ(done.exit_code, 0) << done.err;
    return done.err;
  };
  EXPECT_THAT(say({}), HasSubstr("no display, so no window opens (--serve shows it in a browser"));
  EXPECT_THAT(say({"--lang", "zh-CN"}), HasSubstr("没有显示器，因此不打开窗口"));
  EXPECT_THAT(say({"--headless"}), ::testing::Not(HasSubstr("no display")));
}

TEST(Check, FaultsGoToOutputAndTheFirstIntoOneLine) {
  const support::TempFolder folder;
  const auto file = folder
                        .write("cell.yaml", R"(robot: ur5e
program:
  - movej: {pos: [0.1, -1.45, 0.4], euler: [180deg, 0, 0]}
  - movej: {joints: [0, 0, 9, 0, 0, 0]}
)")
                        .string();
  const auto result = mjarm({"check", file});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, HasSubstr("cell.yaml:3:5: movej: "));
  EXPECT_THAT(result.out, HasSubstr("cell.yaml:4:5: movej: "));
  EXPECT_THAT(only_line(result), ::testing::AllOf(HasSubstr("cell.yaml:3:5"), HasSubstr("1 more")));
  const auto wrong = mjarm({"check", folder.write("wrong.yaml", "robot: ur5e\n").string()});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(only_line(wrong), HasSubstr("wrong.yaml:1:1"));
  EXPECT_EQ(mjarm({"check", "none.yaml"}).exit_code, 2);
  EXPECT_EQ(mjarm({"check"}).exit_code, 2);
}

TEST(Run, DoesWhatItPlannedAndWritesItDown) {
  const support::TempFolder folder;
  const auto file = folder.write("cell.yaml", kProgram).string();
  const auto out = folder.path() / "out";
  const auto result = mjarm({"run", file, "--headless", "--out", out.string(), "--no-timing"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto report = support::load_json(out / "report.json");
  EXPECT_EQ(report.at("ok"), true);
  EXPECT_LT(report.at("path_error_max"), 1e-6);
  EXPECT_EQ(report.at("coverage"), 1.0);
  EXPECT_LT(report.at("static_error").at("position"), 1e-6);
  EXPECT_GT(report.at("cycle_time"), 1.0);
  EXPECT_EQ(report.at("moves").size(), 3U);
  EXPECT_FALSE(report.contains("rtf"));
  for (const char* name : {"log.csv", "plot.png", "plot.svg"}) {
    EXPECT_TRUE(std::filesystem::exists(out / name)) << name;
  }
  EXPECT_NE(read_file(out / "plot.svg").value().find(">limits<"), std::string::npos);
}

/// A part that is too smooth for the fingers: the plan holds it, the run does not.
TEST(Run, AHeldPartIsToldAndItsLossSaid) {
  const support::TempFolder folder;
  const std::string lift = "  - movel: " + testing::pose_at(0.5, -0.2, 0.15) + "\n";
  const auto file = folder
                        .write("job.yaml", "robot: panda\nscene: cell.xml\nprogram:\n" +
                                               testing::pick_up() + lift)
                        .string();
  folder.write("cell.xml", testing::PartAndFence{.friction = 0.001}.scene());
  const auto check = mjarm({"check", file});
  EXPECT_EQ(check.exit_code, 0) << check.err;
  EXPECT_THAT(check.out, HasSubstr("line 7: the gripper then holds part"));
  const auto moves = nlohmann::json::parse(mjarm({"check", file, "--json"}).out).at("moves");
  EXPECT_EQ(moves.back().at("holds"), nlohmann::json::array({"part"}));
  const auto out = folder.path() / "out";
  const auto run = mjarm({"run", file, "--headless", "--out", out.string()});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("object_lost: object \"part\""));
  const auto report = support::load_json(out / "report.json");
  EXPECT_EQ(report.at("ok"), false);
  EXPECT_EQ(report.at("reason"), "object_lost");
  ASSERT_EQ(report.at("objects").size(), 1U);
  EXPECT_EQ(report.at("objects")[0].at("name"), "part");
  EXPECT_EQ(report.at("objects")[0].at("carried"), true);
}

TEST(Check, BlockedMovesTellTheDetour) {
  const support::TempFolder folder;
  const auto file = folder
                        .write("cell.yaml",
                               "robot: ur5e\nscene: universal_robots_ur5e/wall.xml\nprogram:\n"
                               "  - plan: {pos: [0.3, -0.45, 0.2], euler: [180deg, 0, 0]}\n"
                               "  - movel: {pos: [-0.3, -0.45, 0.2], euler: [180deg, 0, 0]}\n")
                        .string();
  const auto told = mjarm({"check", file});
  EXPECT_EQ(told.exit_code, 1);
  EXPECT_THAT(told.out, HasSubstr("line 5 with \"plan\" in place of \"movel\""));
  EXPECT_THAT(only_line(told), HasSubstr("wall"));
  const auto fault = nlohmann::json::parse(mjarm({"check", file, "--json"}).out).at("faults").at(0);
  EXPECT_EQ(fault.at("reason"), "collision");
  EXPECT_EQ(fault.at("fix").at("kind"), "detour");
  EXPECT_GE(fault.at("fix").at("edges"), 1);
  EXPECT_GT(fault.at("fix").at("clearance"), 0);
}

class ShippedProgram : public ::testing::TestWithParam<std::string> {};

TEST_P(ShippedProgram, IsFollowedToAThousandthOfAMillimetre) {
  if (GetParam() == "pick_place" && !testing::is_long()) GTEST_SKIP() << testing::kLongOnly;
  const support::TempFolder folder;
  const auto out = folder.path() / "out";
  const auto result = mjarm({"run", GetParam(), "--headless", "--out", out.string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto report = support::load_json(out / "report.json");
  EXPECT_EQ(report.at("ok"), true);
  EXPECT_LT(report.at("static_error").at("position"), 1e-6);
  if (report.contains("path_error_max")) {
    // Of what is carried the controller knows the mass, not where it is.
    const bool carries = report.contains("objects") && !report.at("objects").empty();
    EXPECT_LT(report.at("path_error_max"), carries ? 4e-4 : 1e-6);
    EXPECT_GT(report.at("coverage"), 0.999);
  }
}

std::vector<std::string> shipped_programs() {
  std::vector<std::string> names;
  const std::filesystem::path folder = std::string(MJARM_MODELS) + "/../examples/programs";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.push_back(entry.path().stem().string());
  }
  std::ranges::sort(names);
  return names;
}

INSTANTIATE_TEST_SUITE_P(All, ShippedProgram, ::testing::ValuesIn(shipped_programs()),
                         [](const auto& program) { return program.param; });

/// A demo is its program: both write the same, but for the name.
TEST(Run, ADemoIsItsProgram) {
  const support::TempFolder folder;
  std::vector<nlohmann::json> reports;
  for (const char* command : {"demo", "run"}) {
    const auto out = folder.path() / command;
    const auto result =
        mjarm({command, "movel", "--headless", "--no-timing", "--out", out.string()});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    reports.push_back(support::load_json(out / "report.json"));
  }
  EXPECT_EQ(reports[0], reports[1]);
  EXPECT_EQ(folder.read("demo/log.csv"), folder.read("run/log.csv"));
}

TEST(Run, UnknownNamesGetTheNearestProgram) {
  const auto result = mjarm({"run", "elipse"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(only_line(result), HasSubstr("\"ellipse\""));
}

TEST(Run, RefusesAProgramWithFaultsBeforeItMakesAFolder) {
  const support::TempFolder folder;
  const auto file = folder.write(
      "cell.yaml", "robot: ur5e\nprogram:\n  - movej: {joints: [9rad, 0, 0, 0, 0, 0]}\n");
  const auto result =
      mjarm({"run", file.string(), "--out", (folder.path() / "out").string(), "--headless"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(only_line(result), HasSubstr("cell.yaml:3:5"));
  EXPECT_FALSE(folder.exists("out"));
}

TEST(Run, SaysWhenTheControlCannotFollow) {
  const support::TempFolder folder;
  const auto file = folder.write("cell.yaml", kProgram).string();
  const auto out = (folder.path() / "out").string();
  const auto result = mjarm({"run", file, "--headless", "--out", out, "--control", "servo"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(support::load_json(folder.path() / "out" / "report.json").at("reason"), "path_error");
  EXPECT_EQ(mjarm({"run", file, "--control", "servos"}).exit_code, 2);
  EXPECT_EQ(mjarm({"run", file, "--tolerance", "-1"}).exit_code, 2);
}

}  // namespace
}  // namespace mjarm::app
