// What is changed of a demo on its command line is what the arm does.
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/mjarm/commands/log_columns_test.hpp"
#include "apps/mjarm/commands/program_test.hpp"
#include "mjarm/sim/others_test.hpp"

namespace mjarm::app {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using Words = std::vector<std::string>;

class DemoValuesTest : public ::testing::Test {
 protected:
  support::ProgramResult demo(Words words) {
    words.insert(words.begin(), "demo");
    words.insert(words.end(), {"--headless", "--no-timing", "--out", "out"});
    return mjarm(words, {.folder = folder_.path(), .input = {}, .environment = {}});
  }
  /// The log of a demo that must end well.
  Columns log_of(const Words& words) {
    const auto result = demo(words);
    EXPECT_EQ(result.exit_code, 0) << ::testing::PrintToString(words) << result.err;
    return columns_of(folder_.read("out/log.csv"));
  }
  static Eigen::Vector3d tool(const Columns& log, std::size_t row) {
    return {log.at("tool x [m]")[row], log.at("tool y [m]")[row], log.at("tool z [m]")[row]};
  }
  static std::size_t last(const Columns& log) { return log.at("tool x [m]").size() - 1; }
  static double joint(const Columns& log, const std::string& name, std::size_t row) {
    return log.at("q " + name + " [rad]")[row];
  }
  support::TempFolder folder_;
};

TEST_F(DemoValuesTest, ThePointIsWhereItIsWanted) {
  const Columns log = log_of({"point", "--pos", "300mm,-0.4,0.3", "--euler", "180deg,0,0",
                              "--seed-q", "-1,-90deg,90deg,-90deg,-90deg,0"});
  EXPECT_LT((tool(log, last(log)) - Eigen::Vector3d(0.3, -0.4, 0.3)).norm(), 1e-4);
  EXPECT_NEAR(std::abs(log.at("tool qx").back()), 1, 1e-4) << "half a turn about x";
  EXPECT_NEAR(joint(log, "shoulder_pan_joint", 0), -1, 1e-9) << "it starts at the seed";
}

TEST_F(DemoValuesTest, TheTutorialsWayHasAFolderOfItsOwn) {
  const support::RunOptions here{.folder = folder_.path(), .input = {}, .environment = {}};
  EXPECT_EQ(mjarm({"demo", "ellipse", "--headless", "--seconds", "0.1"}, here).exit_code, 1);
  const std::string before = folder_.read("mjarm-out/ellipse/report.json");
  EXPECT_EQ(mjarm({"demo", "ellipse", "--headless", "--guide"}, here).exit_code, 1);
  EXPECT_EQ(folder_.read("mjarm-out/ellipse/report.json"), before);
  EXPECT_THAT(folder_.read("mjarm-out/ellipse-guide/report.json"), HasSubstr("inner_void"));
}

TEST_F(DemoValuesTest, AnotherArmGoesToItsOwnPoint) {
  const Columns log = log_of({"movej", "--robot", "panda", "--seed-q", "0,-0.5,0,-2,0,1.57,0.785",
                              "--to", "0.4,0.2,0.4", "--quat", "0,1,0,0"});
  EXPECT_LT((tool(log, last(log)) - Eigen::Vector3d(0.4, 0.2, 0.4)).norm(), 1e-3);
  // Without a start of its own it begins at home.
  const Columns home =
      log_of({"point", "--robot", "panda", "--pos", "0.4,0.2,0.4", "--quat", "0,1,0,0"});
  EXPECT_LT((tool(home, last(home)) - Eigen::Vector3d(0.4, 0.2, 0.4)).norm(), 1e-3);
}

TEST_F(DemoValuesTest, JointsGoWhereTheyAreSent) {
  const Columns moved = log_of({"movej", "--joints", "0,-90deg,90deg,-90deg,-90deg,0.5"});
  EXPECT_NEAR(joint(moved, "elbow_joint", last(moved)), M_PI / 2, 1e-3);
  EXPECT_NEAR(joint(moved, "wrist_3_joint", last(moved)), 0.5, 1e-3);
  const Columns jumped =
      log_of({"ur5e", "--start", "0,-90deg,90deg,-90deg,-90deg,0", "--ctrl",
              "-0.5,-90deg,60deg,-90deg,-90deg,0", "--control", "servo_gravity"});
  EXPECT_NEAR(joint(jumped, "shoulder_pan_joint", 0), 0, 1e-9);
  EXPECT_NEAR(joint(jumped, "shoulder_pan_joint", last(jumped)), -0.5, 0.01);
  EXPECT_NEAR(joint(jumped, "elbow_joint", last(jumped)), M_PI / 3, 0.01);
}

TEST_F(DemoValuesTest, ASquareIsDrawnWhileTheOthersAreHeld) {
  folder_.write("others.xml", testing::robot_with_others());
  const auto done =
      demo({"square", "--robot", "others.xml", "--tip", "tool", "--allow", "lower,block"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.err,
              HasSubstr("5 joints are not the arm's and are held where they stand: 3 by their "
                        "actuators, 2 locked"));
  EXPECT_EQ(nlohmann::json::parse(folder_.read("out/report.json"))["held"].size(), 5U);
}

TEST_F(DemoValuesTest, PairsThatMayTouchAreNamesOfTheModel) {
  for (const char* pair : {"floor", "floor,wrist_3_lnk"}) {
    const auto refused = demo({"square", "--allow", pair});
    EXPECT_EQ(refused.exit_code, 2) << pair;
    EXPECT_THAT(refused.err, HasSubstr("--allow")) << pair;
  }
}

TEST_F(DemoValuesTest, ALineGoesFromItsBeginningToItsEnd) {
  const Eigen::Vector3d from(0.3, -0.4, 0.3), to(-0.3, -0.4, 0.4);
  const Columns log =
      log_of({"movel", "--from", "0.3,-0.4,0.3", "--to", "-0.3,-0.4,0.4", "--euler", "180deg,0,0"});
  EXPECT_LT((tool(log, last(log)) - to).norm(), 1e-3);
  // From where it first is at the beginning on, the tool is on the line.
  const Eigen::Vector3d along = (to - from).normalized();
  std::size_t row = 0;
  while (row < last(log) && (tool(log, row) - from).norm() > 1e-3) ++row;
  ASSERT_LT(row, last(log)) << "it never is at the beginning";
  for (; row <= last(log); ++row) {
    const Eigen::Vector3d off = tool(log, row) - from;
    EXPECT_LT((off - off.dot(along) * along).norm(), 2e-3) << row;
  }
}

TEST_F(DemoValuesTest, TheTutorialsOwnWayTakesThemToo) {
  const Columns points = log_of({"movej", "--guide", "--to", "-0.2,0.5,0.2"});
  EXPECT_LT((tool(points, last(points)) - Eigen::Vector3d(-0.2, 0.5, 0.2)).norm(), 0.03);
  // Its line is off by more than is allowed, which is what it is there to show.
  EXPECT_EQ(demo({"movel", "--guide", "--from", "-0.3,0.4,0.2", "--to", "0,0.5,0.2", "--seed-q",
                  "-1.57,-1.34,2.65,-1.3,1.55,0"})
                .exit_code,
            1);
  const Columns line = columns_of(folder_.read("out/log.csv"));
  EXPECT_LT((tool(line, 0) - Eigen::Vector3d(-0.3, 0.4, 0.2)).norm(), 1e-3);
  EXPECT_LT((tool(line, last(line)) - Eigen::Vector3d(0, 0.5, 0.2)).norm(), 0.03);
}

TEST_F(DemoValuesTest, AnEllipseLiesInItsPlane) {
  const Eigen::Vector3d center(0.45, 0, 0.4);
  const Columns log = log_of({"ellipse", "--center", "0.45,0,0.4", "--normal", "2,0,0", "--a",
                              "15cm", "--b", "0.1", "--euler", "180deg,0,0"});
  // Where the normal is the world's x axis, the first semi-axis lies along its y axis.
  int on = 0;
  double right = 0, top = 0;
  for (std::size_t row = 0; row <= last(log); ++row) {
    const Eigen::Vector3d off = tool(log, row) - center;
    const double level = std::hypot(off.y() / 0.15, off.z() / 0.1);
    if (std::abs(off.x()) > 1e-3 || std::abs(level - 1) > 0.01) continue;
    ++on;
    right = std::max(right, off.y());
    top = std::max(top, off.z());
  }
  EXPECT_GT(on, static_cast<int>(last(log)) / 2) << "of " << last(log);
  EXPECT_NEAR(right, 0.15, 2e-3);
  EXPECT_NEAR(top, 0.1, 2e-3);
}

TEST_F(DemoValuesTest, ACircleHasOneRadius) {
  const Columns log = log_of({"ellipse", "--radius", "80mm"});
  const double x = *std::ranges::max_element(log.at("tool x [m]"));
  EXPECT_NEAR(x, 0.08, 1e-3);
}

TEST_F(DemoValuesTest, LettersLieInTheirPlane) {
  const Columns log = log_of({"letters", "--text", "L", "--center", "0,-0.45,0.3", "--normal",
                              "0,0,1", "--height", "10cm"});
  const Eigen::Vector3d end = tool(log, last(log));
  EXPECT_NEAR(end.z(), 0.3, 1e-3) << "in the level plane";
  EXPECT_NEAR(end.y(), -0.5, 1e-3) << "at the foot of the letter";
  EXPECT_GT(end.x(), 0.01) << "at the right";
  double top = -1;
  for (std::size_t row = 0; row <= last(log); ++row) {
    if (std::abs(tool(log, row).z() - 0.3) < 1e-3) top = std::max(top, tool(log, row).y());
  }
  EXPECT_NEAR(top, -0.4, 1e-3) << "as high as it is asked for";
}

TEST_F(DemoValuesTest, WhatCannotBeIsOneLine) {
  const std::pair<Words, const char*> cases[] = {
      {{"point", "--pos", "0.3,-0.4"}, "--pos"},
      {{"point", "--pos", "300,0,0"}, "write 300mm"},
      {{"point", "--euler", "180,0,0"}, "write 180deg"},
      {{"point", "--euler", "0,0,0", "--quat", "1,0,0,0"}, "exclude each other"},
      {{"point", "--seed-q", "0,-90,0,0,0,0"}, "write -90deg"},
      {{"point", "--seed-q", "0,0,0"}, "--seed-q"},
      {{"point", "--seed-q", "500deg,0,0,0,0,0"}, "shoulder_pan_joint must be from"},
      {{"movej", "--joints", "0,0,0,0,0,0", "--to", "0,0,0"}, "exclude each other"},
      {{"movej", "--joints", "0,0,0,0,0,0", "--guide"}, "exclude each other"},
      {{"ur5e", "--ctrl", "0,-90,0,0,0,0"}, "write -90deg"},
      {{"ur5e", "--ctrl", "0,0,0"}, "--ctrl"},
      {{"ellipse", "--a", "0"}, "--a must be above 0"},
      {{"ellipse", "--b", "300"}, "write 300mm"},
      {{"ellipse", "--radius", "0.1", "--b", "0.1"}, "exclude each other"},
      {{"ellipse", "--normal", "0,0,0"}, "--normal: 0,0,0 has no direction"},
      {{"ellipse", "--guide", "--center", "0,0,0"}, "exclude each other"},
      {{"letters", "--height", "-1cm"}, "--height must be above 0"}};
  for (const auto& [words, says] : cases) {
    const auto result = demo(words);
    EXPECT_EQ(result.exit_code, 2) << says << result.err;
    EXPECT_THAT(only_line(result), HasSubstr(says));
  }
  EXPECT_FALSE(folder_.exists("out"));
  const auto far = demo({"movel", "--to", "3,0,0.3"});
  EXPECT_EQ(far.exit_code, 1);
  EXPECT_THAT(far.err, AllOf(HasSubstr("demo movel: movel: "), HasSubstr("out of reach")));
}

TEST_F(DemoValuesTest, EachIsRefusedWhereItWouldDoNothing) {
  const Words unused[] = {
      {"movel", "--pos", "0,0,0"},  {"ellipse", "--to", "0,0,0"},    {"point", "--center", "0,0,0"},
      {"letters", "--a", "0.1"},    {"movej", "--ctrl", "0"},        {"ur5e", "--seed-q", "0"},
      {"flip", "--euler", "0,0,0"}, {"movej", "--from", "0,0,0"},    {"ellipse", "--height", "0.1"},
      {"car", "--ctrl", "1"},       {"square", "--normal", "0,0,1"}, {"reach", "--pos", "0,0,0"}};
  for (const Words& words : unused) {
    const auto result = demo(words);
    EXPECT_EQ(result.exit_code, 2) << words[0];
    EXPECT_THAT(only_line(result), HasSubstr("does not use " + words[1]));
  }
  const auto help = mjarm({"demo", "ellipse", "--help"});
  EXPECT_THAT(help.out, AllOf(HasSubstr("--center"), HasSubstr("--radius"), HasSubstr("--normal")));
  EXPECT_THAT(help.out, Not(HasSubstr("--seed-q")));
  EXPECT_THAT(mjarm({"demo", "point", "--help", "--lang", "zh-CN"}).out,
              AllOf(HasSubstr("工具的目标位置"), HasSubstr("--seed-q")));
}

}  // namespace
}  // namespace mjarm::app
