// Every command takes an arm of the user's own, and what one command writes the next one reads.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <sstream>

#include "apps/mjarm/commands/crane_test.hpp"
#include "apps/mjarm/commands/oracle_test.hpp"
#include "apps/mjarm/commands/program_test.hpp"
#include "mjarm/core/rng.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class OwnArm : public ::testing::Test {
 protected:
  /// Runs a command on the crane in the folder of the test.
  support::ProgramResult crane(const std::string& command, const std::vector<std::string>& more,
                               const std::string& input = {}) {
    std::vector<std::string> words{command, "--robot", robot_};
    words.insert(words.end(), more.begin(), more.end());
    return mjarm(words, {.folder = folder_.path(), .input = input, .environment = {}});
  }
  /// Joint values within the limits, one line each.
  static std::string random_joints(int count) {
    Rng rng(5);
    std::string lines;
    for (int i = 0; i < count; ++i) {
      const double q[] = {rng.uniform(-2.4, 2.4), rng.uniform(-2.1, 2.1), rng.uniform(-0.19, 0.14)};
      lines += json({{"q", q}}).dump() + "\n";
    }
    return lines;
  }

  support::TempFolder folder_;
  std::string robot_ = write_crane(folder_);
  Oracle oracle_{robot_, "tip"};
};

TEST_F(OwnArm, ToolPosesAreThoseOfMujoco) {
  const std::string requests = random_joints(200);
  const auto result = crane("fk", {"--in", "-"}, requests);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto asked = json_lines(requests), answers = json_lines(result.out);
  ASSERT_EQ(answers.size(), asked.size());
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const Pose X = pose_of(answers[i]), expected = oracle_.fk(numbers(asked[i].at("q")));
    EXPECT_LT((X.p - expected.p).norm(), 1e-14);
    EXPECT_LT(angle_between(X.R, expected.R), 1e-7);
  }
}

TEST_F(OwnArm, EachJointHasItsOwnUnits) {
  const auto plain = crane("fk", {"--q", "0.5,-1,0.025"});
  ASSERT_EQ(plain.exit_code, 0) << plain.err;
  EXPECT_EQ(crane("fk", {"--q", "500mrad,-1 rad,2.5cm"}).out, plain.out);
  EXPECT_EQ(crane("fk", {"--q=.5,-1.,25mm"}).out, plain.out);
  const auto wrong = crane("fk", {"--q", "0.5,-1,25deg"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(only_line(wrong), HasSubstr("known here: m, cm, mm, um"));
}

TEST_F(OwnArm, PosesOfFkAreAnsweredByIk) {
  const std::string requests = random_joints(60);
  const auto poses = crane("fk", {"--in", "-"}, requests);
  const auto back = crane("ik", {"--task", "position", "--in", "-", "--no-timing"}, poses.out);
  ASSERT_EQ(back.exit_code, 0) << back.err;
  const auto goals = json_lines(poses.out), answers = json_lines(back.out);
  ASSERT_EQ(answers.size(), goals.size());
  for (std::size_t i = 0; i < goals.size(); ++i) {
    const auto q = numbers(answers[i].at("q"));
    EXPECT_TRUE(oracle_.within_limits(q));
    EXPECT_LT((oracle_.fk(q).p - pose_of(goals[i]).p).norm(), 1e-4);
  }
  // The answers are requests of fk again: it reads "q" and leaves the rest alone.
  const auto again = crane("fk", {"--in", "-"}, back.out);
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(json_lines(again.out).size(), goals.size());
  EXPECT_EQ(crane("ik", {"--task", "position", "--in", "-", "--no-timing"}, poses.out).out,
            back.out);
}

TEST_F(OwnArm, APlannedPathIsVerifiedAndATimedOneStaysOnIt) {
  const auto planned =
      crane("plan", {"--goal", "-1.5,-1.2,-100mm", "--out", "path.json", "--no-timing"});
  ASSERT_EQ(planned.exit_code, 0) << planned.err;
  const json path = json::parse(folder_.read("path.json")).front().at("path");
  EXPECT_EQ(path.front(), json({0.4, 0.8, 0.0}));
  EXPECT_EQ(path.back(), json({-1.5, -1.2, -0.1}));
  const auto verified = crane("verify", {"path.json", "--json"});
  EXPECT_EQ(verified.exit_code, 0) << verified.err;
  EXPECT_EQ(json::parse(verified.out).at("valid"), 1);

  const json cases{{"limits", {{"v", {2, 2, 0.5}}, {"a", {5, 5, 5}}, {"j", {100, 100, 100}}}},
                   {"cases", {{{"id", "way"}, {"waypoints", path}}}}};
  folder_.write("cases.json", cases.dump());
  const auto timed = mjarm({"time", "--problem", "via_vaj", "--in", "cases.json", "--dt", "10ms",
                            "--check", "--out", "traj.json"},
                           {.folder = folder_.path(), .input = {}, .environment = {}});
  ASSERT_EQ(timed.exit_code, 0) << timed.err;
  const json motion = json::parse(folder_.read("traj.json")).at("way");
  const json& samples = motion.at("samples");
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(samples.front().at(1).at(k), path.front().at(k), 1e-12);
    EXPECT_NEAR(samples.back().at(1).at(k), path.back().at(k), 1e-9);
    EXPECT_NEAR(samples.back().at(2).at(k), 0, 1e-9);
  }
}

TEST_F(OwnArm, TheSlideKeepsToItsOwnLimits) {
  const auto beyond = crane("plan", {"--goal", "0,0,0.5", "--out", "path.json"});
  EXPECT_EQ(beyond.exit_code, 1);
  EXPECT_THAT(only_line(beyond), HasSubstr("joint \"lift\" at 0.5, expected -0.2 to 0.15"));
  EXPECT_EQ(json::parse(folder_.read("path.json")).front().at("ok"), false);
  const auto high = crane("ik", {"--task", "position", "--pos", "0.3,0.2,0.6"});
  EXPECT_EQ(high.exit_code, 1);
  const json answer = json_lines(high.out).at(0);
  EXPECT_TRUE(oracle_.within_limits(numbers(answer.at("best"))));
  // Three joints cannot turn the tool as well.
  const auto whole = crane("ik", {"--pos", "0.3,0.2,0.3", "--quat", "0,1,0,0"});
  EXPECT_EQ(whole.exit_code, 1);
  EXPECT_EQ(json_lines(whole.out).at(0).at("ok"), false);
}

TEST_F(OwnArm, AModelThatIsExportedIsTheSameArm) {
  for (const char* file : {"出口.urdf", "出口.xml", "出口.mjb"}) {
    const support::RunOptions there{.folder = folder_.path(), .input = {}, .environment = {}};
    const auto written = mjarm({"model", "export", robot_, "--out", file}, there);
    ASSERT_EQ(written.exit_code, 0) << written.err;
    EXPECT_EQ(written.out, std::string(file) + "\n");
    if (std::string(file).ends_with(".mjb")) continue;  // for MuJoCo alone
    const auto compared = mjarm({"model", "check", robot_, "--against", file, "--json"}, there);
    EXPECT_EQ(compared.exit_code, 0) << file << ": " << compared.err;
  }
}

TEST_F(OwnArm, WhatIsAskedOfTheWrongFileIsNamed) {
  const support::RunOptions there{.folder = folder_.path(), .input = {}, .environment = {}};
  const std::string before = folder_.read("我的 模型/起重机.xml");
  const std::pair<std::vector<std::string>, const char*> wrong[] = {
      {{"model", "export", robot_}, "--out is missing"},
      {{"model", "export", robot_, "--out", "a.stl"}, "--to is missing"},
      {{"model", "export", robot_, "--to", "stl", "--out", "a.xml"}, "mjcf, urdf or mjb"},
      {{"model", "export", robot_, "--out", robot_}, "name another one for --out"},
      {{"model", "export", robot_, "--to", "urdf", "--out", "我的 模型/../我的 模型/起重机.xml"},
       "name another one for --out"},
      {{"model", "check", robot_, "--tip", "hook"}, "there is no site or body \"hook\""},
      {{"fk", "--robot", robot_, "--tip", "hook", "--q", "0,0,0"}, "\"hook\""}};
  for (const auto& [words, says] : wrong) {
    const auto result = mjarm(words, there);
    EXPECT_EQ(result.exit_code, 2) << says;
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(only_line(result), HasSubstr(says));
  }
  EXPECT_EQ(folder_.read("我的 模型/起重机.xml"), before);
  EXPECT_FALSE(folder_.exists("a.xml"));
}

TEST_F(OwnArm, AProgramForItIsCheckedRunAndWrittenDown) {
  folder_.write("cell.yaml",
                "robot: 我的 模型/起重机.xml\nprogram:\n"
                "  - movej: {joints: [0.9, 0.3, 0.05]}\n  - wait: 100ms\n");
  const support::RunOptions there{.folder = folder_.path(), .input = {}, .environment = {}};
  const auto checked = mjarm({"check", "cell.yaml", "--json"}, there);
  ASSERT_EQ(checked.exit_code, 0) << checked.err;
  const double cycle = json::parse(checked.out).at("cycle_time");
  const auto ran = mjarm({"run", "cell.yaml", "--headless", "--no-timing", "--out", "结果"}, there);
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const json report = json::parse(folder_.read("结果/report.json"));
  EXPECT_EQ(report.at("cycle_time"), cycle);
  EXPECT_EQ(report.at("model"), "crane");
  // The last row stands at the goal, and the tool where MuJoCo has it for those joints.
  const auto lines = support::lines_of(folder_.read("结果/log.csv"));
  std::stringstream row(lines.back());
  std::vector<double> values;
  for (std::string cell; values.size() < 17 && std::getline(row, cell, ',');) {
    values.push_back(std::stod(cell));
  }
  EXPECT_NEAR(values.at(0), report.at("duration"), 1e-9);
  const double goal[] = {0.9, 0.3, 0.05};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(values.at(1 + k), goal[k], 1e-12);
    EXPECT_NEAR(values.at(4 + k), goal[k], 1e-6);
  }
  EXPECT_LT((oracle_.fk({0.9, 0.3, 0.05}).p -
             Eigen::Vector3d(values.at(10), values.at(11), values.at(12)))
                .norm(),
            1e-12);
  const auto exported = mjarm({"export", "cell.yaml", "--to", "urscript"}, there);
  EXPECT_EQ(exported.exit_code, 1);
  EXPECT_THAT(only_line(exported), HasSubstr("\"crane\" is no arm of Universal Robots"));
}

TEST_F(OwnArm, ItsWorkspaceIsTheRingOfItsTwoLinks) {
  const auto result = crane("workspace", {"--slice", "z=0.3", "--step", "100mm", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json map = json::parse(result.out);
  EXPECT_TRUE(map.at("quat").is_null());  // three joints: any way of turning will do
  // 0.3 m and 0.25 m, folded to 2.2 rad at the most, by the law of cosines.
  const double nearest = std::sqrt(0.09 + 0.0625 + 2 * 0.3 * 0.25 * std::cos(2.2));
  EXPECT_GE(map.at("nearest").get<double>(), nearest - 1e-6);
  EXPECT_LT(map.at("nearest").get<double>(), nearest + 0.1);
  EXPECT_LE(map.at("farthest").get<double>(), 0.55 + 1e-6);
  EXPECT_GT(map.at("farthest").get<double>(), 0.45);
  const auto above = crane("workspace", {"--slice", "z=0.44", "--step", "100mm"});
  EXPECT_EQ(above.exit_code, 1);  // the slide ends at 0.43 m
  EXPECT_THAT(only_line(above), HasSubstr("z = 0.44"));
}

}  // namespace
}  // namespace mjarm::app
