// What demos refuse, and that report.json says what stands in log.csv, read by other code.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "apps/mjarm/commands/crane_test.hpp"
#include "apps/mjarm/commands/log_columns_test.hpp"
#include "apps/mjarm/commands/oracle_test.hpp"
#include "apps/mjarm/commands/program_test.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

double largest(const std::vector<double>& values) {
  double out = 0;
  for (const double value : values) out = std::max(out, std::abs(value));
  return out;
}

class DemoReport : public ::testing::Test {
 protected:
  support::ProgramResult demo(std::vector<std::string> words) {
    words.insert(words.begin(), "demo");
    words.insert(words.end(), {"--headless", "--no-timing", "--out", "out"});
    return mjarm(words, {.folder = folder_.path(), .input = {}, .environment = {}});
  }
  json report() const { return json::parse(folder_.read("out/report.json")); }
  Columns log() const { return columns_of(folder_.read("out/log.csv")); }

  support::TempFolder folder_;
  std::string robot_ = write_crane(folder_);
};

TEST_F(DemoReport, ArmsOfOtherSizesAreRefusedBeforeAFolderIsMade) {
  for (const char* name :
       {"ur5e", "ur5e_vision", "point", "movej", "movel", "singularity", "flip"}) {
    const auto result = demo({name, "--robot", robot_});
    EXPECT_EQ(result.exit_code, 2) << name;
    EXPECT_EQ(only_line(result),
              "demo " + std::string(name) + ": expected an arm with 6 joints, this one has 3");
  }
  const auto guided = demo({"movej", "--guide", "--robot", "panda", "--lang", "zh"});
  EXPECT_EQ(guided.exit_code, 2);
  EXPECT_THAT(only_line(guided), HasSubstr("演示 movej：需要 6 个关节的机械臂，这台有 7 个"));
  EXPECT_THAT(only_line(demo({"avoid", "--robot", robot_})), HasSubstr("a scene of its own"));
  EXPECT_FALSE(folder_.exists("out"));
}

/// A video and a plot of another run would be taken for those of this one.
TEST_F(DemoReport, NothingOfAnEarlierRunStaysBesideTheReport) {
  ASSERT_EQ(demo({"movel"}).exit_code, 0);
  EXPECT_TRUE(folder_.exists("out/plot.png"));
  folder_.write("out/video.mp4", "of another run");
  folder_.write("out/notes.txt", "of the user");
  EXPECT_EQ(demo({"movel", "--to", "2,2,2"}).exit_code, 1);
  EXPECT_FALSE(report().at("ok").get<bool>());
  for (const char* const stale : {"out/plot.png", "out/plot.svg", "out/video.mp4"}) {
    EXPECT_FALSE(folder_.exists(stale)) << stale;
  }
  EXPECT_EQ(folder_.read("out/notes.txt"), "of the user");
}

TEST_F(DemoReport, WordsThatMakeNoSenseAreOneLineForEveryDemo) {
  const std::pair<std::vector<std::string>, const char*> wrong[] = {
      {{"squares"}, "did you mean \"square\"?"},
      {{"square", "ellipse"}, "\"ellipse\" is not expected"},
      {{"square", "--seconds", "0"}, "--seconds"},
      {{"square", "--seconds", "2m"}, "\"2m\""},
      {{"square", "--seconds", "nan"}, "\"nan\""},
      {{"square", "--control", "torque"}, "computed_torque"},
      {{"square", "--robot", "none.xml"}, "none.xml"},
      {{"square", "--robot", robot_, "--tip", "hook"}, "\"hook\""},
      {{"letters", "--text", "A%"}, "%"},
      {{"square", "--robot", robot_, "--meshes"}, "known: ur5e, panda"}};
  for (const auto& [words, says] : wrong) {
    const auto result = demo(words);
    EXPECT_EQ(result.exit_code, 2) << says;
    EXPECT_THAT(only_line(result), HasSubstr(says));
    EXPECT_EQ(result.out, "");
  }
  EXPECT_FALSE(folder_.exists("out"));
}

/// The commanded tool goes 10 cm in two directions of the world, and in the third not at all.
void expect_square(const Columns& columns) {
  // The way to the first corner is another motion, which ends at the time the next one begins.
  const auto& time = columns.at("time [s]");
  const auto begin = std::ranges::adjacent_find(time);
  ASSERT_NE(begin, time.end());
  const auto first = begin - time.begin() + 1;
  std::vector<double> sides;
  for (const char* axis : {"x", "y", "z"}) {
    const auto& values = columns.at("tool_ref " + std::string(axis) + " [m]");
    const auto [low, high] = std::minmax_element(values.begin() + first, values.end());
    sides.push_back(*high - *low);
  }
  std::ranges::sort(sides);
  EXPECT_NEAR(sides[0], 0, 1e-4);
  EXPECT_NEAR(sides[1], 0.1, 1e-4);
  EXPECT_NEAR(sides[2], 0.1, 1e-4);
}

/// The tool stands where MuJoCo has it for the joints beside it, measured as well as commanded.
void expect_poses_of_mujoco(const Columns& columns, Oracle oracle) {
  for (std::size_t i = 0; i < columns.at("time [s]").size(); i += 7) {
    const auto pose = [&](const std::string& q, const std::string& tool) {
      const Pose X = oracle.fk({columns.at(q + "turn [rad]")[i], columns.at(q + "fold [rad]")[i],
                                columns.at(q + "lift [m]")[i]});
      const Eigen::Vector3d p(columns.at(tool + "x [m]")[i], columns.at(tool + "y [m]")[i],
                              columns.at(tool + "z [m]")[i]);
      EXPECT_LT((X.p - p).norm(), 1e-9) << tool << i;
      return p;
    };
    EXPECT_LT((pose("q ", "tool ") - pose("q_ref ", "tool_ref ")).norm(), 1e-6) << i;
  }
}

TEST_F(DemoReport, ASquareOfAnyArmIsASquareInTheLog) {
  const auto drawn = demo({"square", "--robot", robot_});
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_THAT(drawn.err, HasSubstr("an arm of 3 joints"));
  const json told = report();
  const Columns columns = log();
  const auto& time = columns.at("time [s]");
  EXPECT_NEAR(time.back(), told.at("duration"), 1e-9);
  EXPECT_EQ(std::set<double>(time.begin(), time.end()).size(),
            told.at("steps").get<std::size_t>() + 1);
  EXPECT_EQ(told.at("coverage"), 1.0);
  EXPECT_LT(told.at("path_error_max").get<double>(), 1e-6);
  expect_square(columns);
  expect_poses_of_mujoco(columns, Oracle(robot_, "tip"));
  // Shares of limits: the standard ones of an arm that mjarm does not know, its own forces.
  const json& used = told.at("limits_used");
  const double speed = std::max({largest(columns.at("v turn [rad/s]")) / 2,
                                 largest(columns.at("v fold [rad/s]")) / 2,
                                 largest(columns.at("v lift [m/s]")) / 0.5});
  EXPECT_NEAR(used.at("velocity").get<double>(), speed, 1e-9);
  const double force = std::max({largest(columns.at("torque turn [N m]")) / 80,
                                 largest(columns.at("torque fold [N m]")) / 80,
                                 largest(columns.at("torque lift [N]")) / 100});
  EXPECT_NEAR(used.at("torque").get<double>(), force, 1e-9);
}

TEST_F(DemoReport, AShorterRunIsTheBeginningOfTheLonger) {
  ASSERT_EQ(demo({"square", "--robot", robot_}).exit_code, 0);
  const auto whole = support::lines_of(folder_.read("out/log.csv"));
  const auto cut = demo({"square", "--robot", robot_, "--seconds", "500ms"});
  EXPECT_EQ(cut.exit_code, 1);
  EXPECT_EQ(report().at("reason"), "stopped");
  // The second run has taken the place of the first, file by file.
  const auto lines = support::lines_of(folder_.read("out/log.csv"));
  ASSERT_LT(lines.size(), whole.size());
  EXPECT_NEAR(std::stod(lines.back()), 0.5, 1e-9);
  EXPECT_TRUE(std::equal(lines.begin(), lines.end(), whole.begin()));
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path() / "out")) {
    EXPECT_THAT(
        (std::vector<std::string>{"log.csv", "report.json", "plot.png", "plot.svg", "picture.png"}),
        ::testing::Contains(entry.path().filename().string()));
  }
}

TEST_F(DemoReport, WhatCannotBeDrawnIsWrittenDownWithoutAStep) {
  const auto refused = demo({"ellipse", "--robot", robot_});
  EXPECT_EQ(refused.exit_code, 1);
  const json told = report();
  EXPECT_EQ(told.at("ok"), false);
  EXPECT_EQ(told.at("reason"), "joint_limit");
  EXPECT_EQ(told.at("unreachable").size(), 200U);
  EXPECT_EQ(told.at("steps"), 0);
  EXPECT_FALSE(told.contains("fix"));
  EXPECT_THAT(told.at("detail").get<std::string>(), HasSubstr("no shift of the path was found"));
  EXPECT_THAT(refused.err, HasSubstr("ellipse: joint_limit: points 0 to 199 of 200"));
}

TEST_F(DemoReport, TheCarsErrorIsItsLargestDistanceFromTheStraightWay) {
  const auto driven = demo({"car"});
  ASSERT_EQ(driven.exit_code, 0) << driven.err;
  const Columns columns = log();
  const auto &time = columns.at("time [s]"), &y = columns.at("y [m]"), &z = columns.at("z [m]");
  double worst = 0, squares = 0;
  std::size_t straight = 0;
  for (; straight < time.size() && time[straight] < 3 + 1e-9; ++straight) {
    const double off = std::hypot(y[straight] - y[0], z[straight] - z[0]);
    worst = std::max(worst, off);
    squares += off * off;
  }
  const json told = report();
  EXPECT_NEAR(told.at("path_error_max").get<double>(), worst, 1e-9);
  EXPECT_NEAR(told.at("path_error_rms").get<double>(),
              std::sqrt(squares / static_cast<double>(straight)), 1e-9);
  EXPECT_EQ(told.at("steps"), time.size());
  EXPECT_NEAR(time.back(), 5, 1e-9);
  EXPECT_THAT(driven.err, HasSubstr("heading"));
}

TEST_F(DemoReport, ACarThatIsStoppedEarlyHasNotDriven) {
  const auto stopped = demo({"car", "--seconds", "0.2"});
  EXPECT_EQ(stopped.exit_code, 1);
  EXPECT_EQ(report().at("reason"), "not_driven");
  EXPECT_NEAR(log().at("time [s]").back(), 0.2, 1e-9);
  EXPECT_THAT(stopped.err, HasSubstr("expected more than 0.5 m and 30 deg"));
}

/// The tool starts above the floor and stays there.
TEST_F(DemoReport, TheFirstMoveIsAboveTheFloor) {
  const auto result = demo({"ur5e"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const std::vector<double> z = log().at("tool z [m]");
  EXPECT_GT(*std::ranges::min_element(z), 0.03);
  EXPECT_GT(*std::ranges::max_element(z) - *std::ranges::min_element(z), 0.02) << "it moved";
}

/// Three runs of one motion are three curves; before, two spikes of 150 m/s hid them.
TEST_F(DemoReport, RunsAreNotJoinedInThePlot) {
  EXPECT_EQ(demo({"point"}).exit_code, 0);
  const std::string svg = folder_.read("out/plot.svg");
  const std::size_t speed = svg.find(">tool speed<");
  ASSERT_NE(speed, std::string::npos);
  EXPECT_EQ(svg.find(">150<"), std::string::npos);
}

TEST_F(DemoReport, TheCarHasNoTool) {
  EXPECT_EQ(demo({"car", "--seconds", "1"}).exit_code, 1) << "not driven far enough";
  const std::string svg = folder_.read("out/plot.svg");
  EXPECT_THAT(svg, HasSubstr("way of the car from above"));
  EXPECT_THAT(svg, ::testing::Not(HasSubstr("tool")));
}

}  // namespace
}  // namespace mjarm::app
