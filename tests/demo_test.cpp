#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/run_program.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/test_data.hpp"

// The demos end to end, as a user runs them: the real program, real MuJoCo, files read back.
namespace mjarm {
namespace {

using support::ProgramResult;
using support::TempFolder;

struct DemoRun {
  ProgramResult result;
  nlohmann::json report;
};

DemoRun run_demo(const TempFolder& folder, std::vector<std::string> arguments,
                 const support::RunOptions& options = {}) {
  arguments.insert(arguments.begin(), "demo");
  for (const char* more : {"--headless", "--no-timing", "--out"}) arguments.emplace_back(more);
  arguments.push_back((folder.path() / "out").string());
  DemoRun run{support::run_program(MJARM_PROGRAM, arguments, options), {}};
  if (folder.exists("out/report.json")) {
    run.report = nlohmann::json::parse(folder.read("out/report.json"));
  }
  return run;
}

void expect_report_fields(const nlohmann::json& report) {
  for (const char* key : {"ok", "coverage", "max_joint_step", "limits_used", "duration", "steps"}) {
    EXPECT_TRUE(report.contains(key)) << key;
  }
  EXPECT_TRUE(report.contains("path_error_max") || report.contains("static_error"));
  EXPECT_FALSE(report.contains("rtf"));
}

class EveryDemo : public ::testing::TestWithParam<const char*> {};

TEST_P(EveryDemo, EndsWellAndLeavesWholeFiles) {
  const TempFolder folder;
  const DemoRun run = run_demo(folder, {GetParam()});
  ASSERT_EQ(run.result.exit_code, 0) << run.result.err;
  expect_report_fields(run.report);
  EXPECT_TRUE(run.report["ok"].get<bool>());
  EXPECT_GT(run.report["coverage"].get<double>(), 0.98);
  for (const char* file : {"out/log.csv", "out/plot.svg", "out/plot.png"}) {
    EXPECT_TRUE(folder.exists(file)) << file;
  }
  if (folder.exists("out/picture.png")) {
    EXPECT_EQ(folder.read("out/picture.png").substr(1, 3), "PNG");
  } else {
    EXPECT_NE(run.result.err.find("no picture"), std::string::npos) << run.result.err;
  }
  EXPECT_NE(run.result.out.find((folder.path() / "out").string()), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Demos, EveryDemo,
                         ::testing::Values("car", "ur5e", "ur5e_vision", "point", "movej", "movel",
                                           "ellipse", "letters", "singularity", "flip", "avoid",
                                           "pick_place"),
                         [](const auto& demo) { return std::string(demo.param); });

TEST(DemoEllipse, WholeCurveWithinHalfAMillimetre) {
  const TempFolder folder;
  const DemoRun run = run_demo(folder, {"ellipse"});
  ASSERT_EQ(run.result.exit_code, 0) << run.result.err;
  EXPECT_LT(run.report["path_error_max"].get<double>(), 5e-4);
  EXPECT_EQ(run.report["coverage"].get<double>(), 1.0);
  EXPECT_NEAR(run.report["tool_speed_max"].get<double>(), 0.25, 0.005);
  EXPECT_LT(run.report["max_joint_step"].get<double>(), 0.1);
  EXPECT_TRUE(run.report["first_contact"].is_null());
}

TEST(DemoEllipse, ServoAloneIsReportedAsOffThePath) {
  const TempFolder folder;
  const DemoRun run = run_demo(folder, {"ellipse", "--control", "servo"});
  EXPECT_EQ(run.result.exit_code, 1);
  EXPECT_FALSE(run.report["ok"].get<bool>());
  EXPECT_EQ(run.report["reason"], "path_error");
  EXPECT_GT(run.report["path_error_max"].get<double>(), 5e-3);
}

TEST(DemoEllipse, TutorialsCentreIsRefusedWithTheReasonAndAShift) {
  const TempFolder folder;
  const DemoRun run = run_demo(folder, {"ellipse", "--guide"});
  EXPECT_EQ(run.result.exit_code, 1);
  EXPECT_EQ(run.report["reason"], "inner_void");
  std::vector<int> expected;
  for (int i = 37; i <= 62; ++i) expected.push_back(i);
  EXPECT_EQ(run.report["unreachable"].get<std::vector<int>>(), expected);
  EXPECT_EQ(run.report["steps"], 0);
  ASSERT_TRUE(run.report.contains("fix"));
  EXPECT_NE(run.result.err.find("37"), std::string::npos) << run.result.err;
  EXPECT_NE(run.result.err.find("62"), std::string::npos) << run.result.err;
  EXPECT_NE(run.result.err.find("0.134"), std::string::npos) << run.result.err;
}

TEST(DemoEllipse, EqualRunsGiveEqualBytes) {
  const TempFolder first, second;
  ASSERT_EQ(run_demo(first, {"ellipse"}).result.exit_code, 0);
  ASSERT_EQ(run_demo(second, {"ellipse"}).result.exit_code, 0);
  for (const char* file : {"out/report.json", "out/log.csv", "out/plot.svg", "out/plot.png"}) {
    EXPECT_EQ(first.read(file), second.read(file)) << file;
  }
}

TEST(DemoEllipse, DrawsOnMenageriesUr5e) {
  MJARM_TEST_ARCHIVE(archive, "menagerie/universal_robots_ur5e.tar.xz");
  const TempFolder models;
  support::unpack(archive, models.path());
  const TempFolder folder;
  const std::string scene = (models.path() / "universal_robots_ur5e/scene.xml").string();
  const DemoRun run = run_demo(folder, {"ellipse", "--robot", scene});
  ASSERT_EQ(run.result.exit_code, 0) << run.result.err;
  EXPECT_LT(run.report["path_error_max"].get<double>(), 5e-4);
  EXPECT_EQ(run.report["coverage"].get<double>(), 1.0);
}

TEST(DemoPoint, ComputedTorqueBeatsTheServoByFar) {
  const TempFolder folder;
  const DemoRun run = run_demo(folder, {"point"});
  ASSERT_EQ(run.result.exit_code, 0) << run.result.err;
  const auto& errors = run.report["static_errors"];
  EXPECT_GT(errors["servo"]["position"].get<double>(), 5e-3);
  EXPECT_LT(errors["servo_gravity"]["position"].get<double>(), 1e-3);
  EXPECT_LT(errors["computed_torque"]["position"].get<double>(), 1e-4);
}

TEST(DemoSingularity, NaiveWhipsAndOursKeepsTheLimits) {
  const TempFolder folder;
  const DemoRun run = run_demo(folder, {"singularity"});
  ASSERT_EQ(run.result.exit_code, 0) << run.result.err;
  constexpr double kLimit = 3.1416;  // [rad/s] of every joint of the UR5e
  EXPECT_GT(run.report["naive_peak_joint_speed"].get<double>(), 3 * kLimit);
  EXPECT_LT(run.report["peak_joint_speed"].get<double>(), 0.92 * kLimit);
  EXPECT_EQ(run.report["asked_reason"], "joint_speed");
  EXPECT_LT(run.report["slower"].get<double>(), 0.25);
  EXPECT_GT(run.report["tilt"].get<double>(), 0);
  EXPECT_LT(run.report["tilted_peak_joint_speed"].get<double>(), 0.92 * kLimit);
  const auto& dips = run.report["speed_dips"];
  ASSERT_EQ(dips.size(), 1U);
  EXPECT_EQ(dips[0]["singularity"], "wrist");
  EXPECT_LT(dips[0]["least"].get<double>(), 0.1);
  EXPECT_NE(run.report["naive_peak_joint"].get<std::string>().find("wrist"), std::string::npos);
  EXPECT_GT(run.report["naive_path_error_max"].get<double>(),
            10 * run.report["path_error_max"].get<double>());
  EXPECT_LT(run.report["path_error_max"].get<double>(), 5e-4);
  for (const char* file : {"out/comparison.svg", "out/comparison.png"}) {
    EXPECT_TRUE(folder.exists(file)) << file;
  }
}

TEST(DemoFlip, NearestAnswersChangeBranchAndTheWholePathBranchDoesNot) {
  const TempFolder folder;
  const DemoRun run = run_demo(folder, {"flip"});
  ASSERT_EQ(run.result.exit_code, 0) << run.result.err;
  EXPECT_EQ(run.report["naive_reason"], "branch_flip");
  EXPECT_GT(run.report["naive_fraction"].get<double>(), 0.5);
  EXPECT_LT(run.report["naive_fraction"].get<double>(), 0.95);
  EXPECT_GT(run.report["naive_joint_step"].get<double>(), 1);
  EXPECT_GT(run.report["naive_path_error_max"].get<double>(), 0.05);
  EXPECT_LT(run.report["max_joint_step"].get<double>(), 0.05);
  EXPECT_LT(run.report["path_error_max"].get<double>(), 5e-4);
  EXPECT_TRUE(folder.exists("out/comparison.png"));
  EXPECT_NE(run.result.err.find("branch_flip"), std::string::npos) << run.result.err;
}

TEST(DemoAvoid, TellsWhatTheStraightWayHitsAndGoesRound) {
  const TempFolder folder, again;
  const DemoRun run = run_demo(folder, {"avoid"});
  ASSERT_EQ(run.result.exit_code, 0) << run.result.err;
  EXPECT_EQ(run.report["straight_reason"], "collision");
  EXPECT_NE(run.report["straight_hits"].get<std::string>().find("wall"), std::string::npos);
  EXPECT_GT(run.report["straight_free"].get<double>(), 0.05);
  EXPECT_LT(run.report["straight_free"].get<double>(), 0.6);
  EXPECT_GE(run.report["edges"].get<double>(), 2);
  EXPECT_GT(run.report["clearance"].get<double>(), 0);
  EXPECT_TRUE(run.report["first_contact"].is_null());
  EXPECT_LT(run.report["static_error"]["position"].get<double>(), 1e-6);
  EXPECT_NE(run.result.err.find("would touch after"), std::string::npos) << run.result.err;
  EXPECT_NE(run.result.err.find("proved free"), std::string::npos) << run.result.err;
  EXPECT_EQ(run_demo(again, {"avoid"}).report, run.report);
}

TEST(DemoAvoid, HasItsOwnScene) {
  const TempFolder folder;
  const DemoRun run = run_demo(folder, {"avoid", "--robot", "panda"});
  EXPECT_EQ(run.result.exit_code, 2) << run.result.err;
  EXPECT_NE(run.result.err.find("scene of its own"), std::string::npos) << run.result.err;
}

TEST(DemoFlip, StopsBeforeTheLineWhereAsked) {
  const TempFolder folder;
  const DemoRun run = run_demo(folder, {"flip", "--seconds", "0.1"});
  EXPECT_EQ(run.result.exit_code, 1) << run.result.err;
  EXPECT_EQ(run.report["reason"], "stopped");
}

TEST(DemoMovel, TutorialsFollowerSaysWhatItWaitsForInsteadOfHanging) {
  const TempFolder folder;
  const DemoRun run = run_demo(folder, {"movel", "--guide"});
  EXPECT_EQ(run.result.exit_code, 1);
  EXPECT_EQ(run.report["reason"], "waypoint_not_reached");
  EXPECT_LT(run.report["coverage"].get<double>(), 1.0);
}

TEST(DemoLetters, WritesOtherTexts) {
  const TempFolder folder;
  const DemoRun run = run_demo(folder, {"letters", "--text", "HI 5"});
  ASSERT_EQ(run.result.exit_code, 0) << run.result.err;
  EXPECT_LT(run.report["path_error_max"].get<double>(), 5e-4);
  EXPECT_EQ(run.report["coverage"].get<double>(), 1.0);
}

TEST(DemoLetters, UnknownCharacterIsOneLine) {
  const TempFolder folder;
  const DemoRun run = run_demo(folder, {"letters", "--text", "A%"});
  EXPECT_EQ(run.result.exit_code, 2);
  EXPECT_EQ(support::lines_of(run.result.err).size(), 1U) << run.result.err;
  EXPECT_NE(run.result.err.find('%'), std::string::npos);
}

TEST(Demo, UnknownNameGetsTheNearestOne) {
  const ProgramResult result = support::run_program(MJARM_PROGRAM, {"demo", "elipse"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("ellipse"), std::string::npos) << result.err;
}

TEST(Demo, NoNameListsAll) {
  const ProgramResult result = support::run_program(MJARM_PROGRAM, {"demo"});
  EXPECT_EQ(result.exit_code, 0);
  for (const char* name : {"car", "ur5e_vision", "ellipse", "letters"}) {
    EXPECT_NE(result.out.find(name), std::string::npos) << result.out;
  }
}

TEST(Demo, BadOptionsAreUsageErrors) {
  for (const std::vector<std::string>& bad :
       {std::vector<std::string>{"ellipse", "--seconds", "-1"},
        {"ellipse", "--seconds", "soon"},
        {"ellipse", "--control", "serwo"},
        {"ellipse", "--robot", "ur5"},
        {"ellipse", "--tip", "attachment_sit"},
        {"movel", "--robot", "panda"}}) {
    const TempFolder folder;
    const DemoRun run = run_demo(folder, bad);
    EXPECT_EQ(run.result.exit_code, 2) << bad[1] << bad[2];
    EXPECT_EQ(support::lines_of(run.result.err).size(), 1U) << run.result.err;
  }
}

TEST(Demo, OutputFolderThatIsAFile) {
  const TempFolder folder;
  folder.write("out", "not a folder");
  const DemoRun run = run_demo(folder, {"car"});
  EXPECT_EQ(run.result.exit_code, 1);
  EXPECT_EQ(support::lines_of(run.result.err).size(), 1U) << run.result.err;
  EXPECT_EQ(folder.read("out"), "not a folder");
}

TEST(Demo, SecondsEndTheMotionEarlyAndSaySo) {
  const TempFolder folder;
  const DemoRun run = run_demo(folder, {"ellipse", "--seconds", "3"});
  EXPECT_EQ(run.result.exit_code, 1);
  EXPECT_EQ(run.report["reason"], "stopped");
  EXPECT_LT(run.report["coverage"].get<double>(), 0.9);
  EXPECT_TRUE(folder.exists("out/log.csv"));
}

TEST(Demo, SpeaksChinese) {
  const TempFolder folder;
  const ProgramResult result =
      support::run_program(MJARM_PROGRAM, {"--lang", "zh-CN", "demo", "ellipse", "--headless",
                                           "--out", (folder.path() / "out").string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("文件位于"), std::string::npos) << result.out;
}

TEST(Demo, RunsFromAnyFolderAndWritesOnlyItsOwn) {
  const TempFolder folder, elsewhere;
  const DemoRun run =
      run_demo(folder, {"car"}, {.folder = elsewhere.path(), .input = {}, .environment = {}});
  EXPECT_EQ(run.result.exit_code, 0) << run.result.err;
  EXPECT_TRUE(std::filesystem::is_empty(elsewhere.path()));
}

TEST(DemoPickPlace, PutsAllThreeIntoTheTray) {
  const TempFolder folder;
  const DemoRun run = run_demo(folder, {"pick_place", "--robot", "panda"});
  ASSERT_EQ(run.result.exit_code, 0) << run.result.err;
  ASSERT_EQ(run.report["objects"].size(), 3u);
  for (const nlohmann::json& object : run.report["objects"]) {
    EXPECT_TRUE(object["ok"].get<bool>() && object["carried"].get<bool>()) << object;
    EXPECT_GT(object["moved"].get<double>(), 0.25) << object;
    EXPECT_LT(object["off_plan"].get<double>(), 0.01) << object;
  }
  EXPECT_TRUE(run.report["first_contact"].is_null());
}

TEST(DemoSort, StopsInTheMiddleWithItsReasonAndWholeFiles) {
  const TempFolder folder;
  const DemoRun run = run_demo(folder, {"sort", "--seconds", "0.2", "--seed", "3"});
  if (run.result.err.find("nothing can be drawn") != std::string::npos)
    GTEST_SKIP() << run.result.err;
  ASSERT_EQ(run.result.exit_code, 1) << run.result.err;
  EXPECT_EQ(run.report["reason"], "stopped");
  EXPECT_NE(run.report["detail"].get<std::string>().find("0 of 10"), std::string::npos);
  EXPECT_EQ(run.report["coverage"], 0);
  EXPECT_EQ(run.report["seed"], 3);
  EXPECT_EQ(run.report["grasps"], 1);
  for (const char* file : {"out/log.csv", "out/plot.svg", "out/plot.png", "out/picture.png"}) {
    EXPECT_TRUE(folder.exists(file)) << file;
  }
}

TEST(DemoSort, RefusesWhatItCannotDo) {
  const TempFolder folder;
  const DemoRun other = run_demo(folder, {"sort", "--robot", "car"});
  EXPECT_EQ(other.result.exit_code, 2);
  EXPECT_NE(other.result.err.find("ur5e or panda"), std::string::npos) << other.result.err;
  const DemoRun seed = run_demo(folder, {"sort", "--seed", "-1"});
  EXPECT_EQ(seed.result.exit_code, 2);
  EXPECT_NE(seed.result.err.find("--seed"), std::string::npos) << seed.result.err;
  const DemoRun unused = run_demo(folder, {"pick_place", "--seed", "1"});
  EXPECT_EQ(unused.result.exit_code, 2);
  EXPECT_NE(unused.result.err.find("--seed"), std::string::npos) << unused.result.err;
}

}  // namespace
}  // namespace mjarm
