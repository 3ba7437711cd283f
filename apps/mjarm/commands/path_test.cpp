#include <cmath>
#include <numbers>

#include "apps/mjarm/commands/oracle_test.hpp"
#include "apps/mjarm/commands/program_test.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/path/ellipse.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;

constexpr double kDegree = std::numbers::pi / 180;
const char* const kLine =
    R"({"type":"line","from":{"pos":[0.3,-0.4,0.4],"quat":[0,1,0,0]},"to":{"pos":[-0.3,-0.4,0.4],"quat":[0,1,0,0]}})";
const char* const kEllipse =
    R"({"type":"ellipse","center":[0,-0.3,0.5],"a":0.3,"b":0.15,"normal":[0,0,1],"quat":[0,1,0,0],"points":200})";
const char* const kTooNear =
    R"({"type":"ellipse","center":[0,-0.2,0.5],"a":0.3,"b":0.15,"normal":[0,0,1],"quat":[0,1,0,0],"points":200})";

using Row = std::vector<double>;
std::vector<Row> rows(const json& list) { return list.get<std::vector<Row>>(); }

support::ProgramResult path(std::vector<std::string> arguments, const std::string& input = {}) {
  arguments.insert(arguments.begin(), "path");
  return mjarm(arguments, {.folder = {}, .input = input, .environment = {}});
}

support::ProgramResult solve(const std::string& request, std::vector<std::string> more = {}) {
  more.insert(more.begin(), {"--robot", "ur5e", "--request", request});
  return path(more);
}

double largest_step(const std::vector<Row>& q) {
  double worst = 0;
  for (std::size_t i = 1; i < q.size(); ++i) {
    for (std::size_t j = 0; j < q[i].size(); ++j) {
      worst = std::max(worst, std::abs(q[i][j] - q[i - 1][j]));
    }
  }
  return worst;
}

TEST(Path, ALineStaysOnTheLine) {
  const auto result = solve(kLine);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  const json answer = json_lines(result.out).at(0);
  EXPECT_EQ(answer.at("ok"), true);
  EXPECT_EQ(answer.at("fraction"), 1.0);
  EXPECT_GT(answer.at("min_manipulability").get<double>(), 0);
  const auto q = rows(answer.at("q"));
  EXPECT_DOUBLE_EQ(answer.at("max_step").get<double>(), largest_step(q));
  Oracle oracle(kUr5eScene, "attachment_site");
  for (std::size_t i = 0; i < q.size(); ++i) {
    EXPECT_TRUE(oracle.within_limits(q[i]));
    Row middle = q[i];
    for (std::size_t j = 0; i > 0 && j < 6; ++j) middle[j] = 0.5 * (q[i][j] + q[i - 1][j]);
    for (const Row& row : {q[i], middle}) {
      const Pose X = oracle.fk(row);
      EXPECT_LT(std::hypot(X.p.y() + 0.4, X.p.z() - 0.4), 1.1e-4);
      EXPECT_LT(angle_between(X.R, from_euler({std::numbers::pi, 0, 0})), 0.11 * kDegree);
    }
  }
  EXPECT_NEAR(oracle.fk(q.front()).p.x(), 0.3, 1e-6);
  EXPECT_NEAR(oracle.fk(q.back()).p.x(), -0.3, 1e-6);
}

TEST(Path, OptionsSayTheSameAsARequest) {
  const std::vector<std::string> robot = {"--robot", "ur5e", "--no-timing"};
  const auto request = solve(kLine, {"--no-timing"});
  ASSERT_EQ(request.exit_code, 0) << request.err;
  const auto options = path({"--robot", "ur5e", "--no-timing", "--from", "30cm,-0.4,0.4", "--to",
                             "-0.3,-400mm,0.4", "--quat", "0,1,0,0"});
  EXPECT_EQ(options.out, request.out);
  const auto arc = path({"--robot", "ur5e", "--from", "0.3,-0.4,0.4", "--via", "0,-0.5,0.4", "--to",
                         "-0.3,-0.4,0.4", "--quat", "0,1,0,0"});
  EXPECT_EQ(arc.exit_code, 0) << arc.err;
  const auto batch = path({"--robot", "ur5e", "--no-timing", "--in", "-"},
                          std::string(kLine) + "\n\n" + kLine + "\n");
  EXPECT_EQ(batch.out, request.out + request.out);
}

TEST(Path, AnEllipseHasARowAPoint) {
  const auto result = solve(kEllipse, {"--start", "-1.57,-1.34,2.65,-1.3,1.55,0"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto q = rows(json_lines(result.out).at(0).at("q"));
  ASSERT_EQ(q.size(), 200u);
  EXPECT_LT(largest_step(q), 5.2 * kDegree);
  Oracle oracle(kUr5eScene, "attachment_site");
  const auto points = ellipse_points(
      {{0, -0.3, 0.5}, 0.3, 0.15, Eigen::Vector3d::UnitZ(), Eigen::Matrix3d::Identity()}, 200);
  for (std::size_t i = 0; i < q.size(); ++i) {
    EXPECT_LT((oracle.fk(q[i]).p - points[i].p).norm(), 1e-6);
  }
}

TEST(Path, APathThatStopsSaysWhyAndWhatMendsIt) {
  const auto result = solve(kTooNear, {"--partial"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(only_line(result).find("18.5 % (pose 37)"), std::string::npos) << result.err;
  const json answer = json_lines(result.out).at(0);
  EXPECT_EQ(answer.at("ok"), false);
  EXPECT_EQ(answer.at("reason"), "inner_void");
  EXPECT_EQ(answer.at("at"), 37);
  EXPECT_DOUBLE_EQ(answer.at("fraction").get<double>(), 37 / 200.0);
  EXPECT_TRUE(answer.at("q").empty());
  EXPECT_EQ(answer.at("partial").size(), 37u);
  EXPECT_EQ(answer.at("unreachable"), json::array({{37, 62}}));
  const auto shift = answer.at("fix").at("shift").get<Row>();
  json mended = json::parse(kTooNear);
  for (std::size_t i = 0; i < 3; ++i) {
    mended["center"][i] = mended["center"][i].get<double>() + shift.at(i);
  }
  EXPECT_EQ(solve(mended.dump()).exit_code, 0);
  EXPECT_FALSE(json_lines(solve(kTooNear).out).at(0).contains("partial"));
}

TEST(Path, WhatTouchesIsRefused) {
  // Through the floor of the scene.
  json line = json::parse(kLine);
  line["to"]["pos"] = {0.3, -0.4, -0.1};
  EXPECT_EQ(solve(line.dump()).exit_code, 0);
  const auto result = solve(line.dump(), {"--collisions"});
  EXPECT_EQ(result.exit_code, 1);
  const json answer = json_lines(result.out).at(0);
  EXPECT_EQ(answer.at("reason"), "collision");
  EXPECT_EQ(answer.at("pair").size(), 2u);
  EXPECT_TRUE(answer.contains("min_clearance"));
  EXPECT_TRUE(answer.contains("fix")) << result.out;
}

TEST(Path, StartAndKeepStart) {
  json request = json::parse(kEllipse);
  const Row home = {-1.57, -1.34, 2.65, -1.3, 1.55, 0};
  request["start"] = home;
  const auto kept = solve(request.dump(), {"--keep-start"});
  ASSERT_EQ(kept.exit_code, 0) << kept.err;
  const auto first = rows(json_lines(kept.out).at(0).at("q")).at(0);
  // The answer to the first point that is nearest to the start.
  const auto nearest = mjarm({"ik", "--robot", "ur5e", "--pos", "0.3,-0.3,0.5", "--quat", "0,1,0,0",
                              "--seed-q", "-1.57,-1.34,2.65,-1.3,1.55,0"});
  const auto expected = json_lines(nearest.out).at(0).at("q").get<Row>();
  for (std::size_t j = 0; j < 6; ++j) EXPECT_NEAR(first[j], expected[j], 1e-6);
  request["max_step"] = 1e-3;
  const auto strict = solve(request.dump());
  EXPECT_EQ(strict.exit_code, 1);
}

TEST(Path, ASpeedThatAJointCannotKeep) {
  const std::string line = R"({"type":"line","from":{"pos":[0.4,-0.2,0.4],"quat":[0,1,0,0]},)"
                           R"("to":{"pos":[-0.4,-0.2,0.4],"quat":[0,1,0,0]},"speed":)";
  EXPECT_EQ(solve(line + "0.25}").exit_code, 0);
  const auto fast = solve(line + "1.5}");
  EXPECT_EQ(fast.exit_code, 1);
  const json answer = json::parse(fast.out);
  EXPECT_EQ(answer.at("reason"), "joint_speed");
  EXPECT_GT(answer.at("amount").get<double>(), 0);
  const double slower = answer.at("fix").at("slower").get<double>();
  EXPECT_LT(slower, 1.5);
  EXPECT_EQ(solve(line + std::to_string(slower) + "}").exit_code, 0);
  EXPECT_NE(only_line(fast).find("m/s"), std::string::npos) << fast.err;
}

TEST(Path, BadRequests) {
  const std::vector<std::pair<std::string, std::string>> bad = {
      {"", "--from"},
      {"[1]", "a JSON object"},
      {"{", "not valid JSON"},
      {"{}", "\"type\" is missing: one of poses, line"},
      {R"({"type":"lines"})", "did you mean line?"},
      {R"({"type":3})", "\"type\" is missing"},
      {R"({"type":"poses"})", "\"poses\" must be a list of at least one pose"},
      {R"({"type":"poses","poses":[]})", "at least one pose"},
      {R"({"type":"poses","poses":[3]})", "\"poses[0]\" must be a pose"},
      {R"({"type":"poses","poses":[{"pos":[0,0,0],"quat":[1,0,0]}]})", "poses[0]: \"quat\""},
      {R"({"type":"line","from":{"pos":[0,0,1],"quat":[1,0,0,0]}})", "\"to\" must be a pose"},
      {R"({"type":"line","from":{"pos":[0,0,1],"quat":[1,0,0,0]},"to":{"pos":[0,0,1],"quat":[1,0,0,0]}})",
       "the same"},
      {R"({"type":"ellipse","center":[0,0,0],"a":"x","b":1,"normal":[0,0,1],"quat":[1,0,0,0]})",
       "\"a\" must be a number"},
      {R"({"type":"ellipse","center":[0,0,0],"a":1,"b":0,"normal":[0,0,1],"quat":[1,0,0,0]})",
       "semi-axis"},
      {R"({"type":"ellipse","center":[0,0,0],"a":1,"b":1e-320,"normal":[0,0,1],"quat":[1,0,0,0]})",
       "expected a length from 1e-9"},
      {R"({"type":"ellipse","center":[0,0,0],"a":1,"b":1,"normal":[0,0,1],"quat":[1,0,0,0],"points":1e300})",
       "\"points\" must be a whole number"},
      {R"({"type":"poses","poses":[{"pos":[0,0,1],"quat":[1,0,0,0]}],"start":[1,2]})", "\"start\""},
      {R"({"type":"poses","poses":[{"pos":[0,0,1],"quat":[1,0,0,0]}],"max_step":0})",
       "\"max_step\" must be above 0"},
      {R"({"type":"poses","poses":[{"pos":[0,0,1],"quat":[1,0,0,0]}],"max_step":1000})",
       "\"max_step\" must be above 0 and at most pi"},
      {R"({"type":"poses","poses":[{"pos":[0,0,1],"quat":[1,0,0,0]}],"orientation_tol":2})",
       "\"orientation_tol\" must be"},
      {R"({"type":"poses","poses":[{"pos":[0,0,1],"quat":[1,0,0,0]}],"speed":0})",
       "\"speed\" must be above 0"},
  };
  for (const auto& [request, says] : bad) {
    SCOPED_TRACE(request);
    const auto result = solve(request);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(only_line(result).find(says), std::string::npos) << result.err;
    EXPECT_EQ(result.out, "");
  }
  const auto batch = path({"--robot", "ur5e", "--in", "-"}, std::string(kLine) + "\n{}\n");
  EXPECT_EQ(batch.exit_code, 2);
  EXPECT_NE(only_line(batch).find("stdin:2: "), std::string::npos) << batch.err;
}

TEST(Path, HelpInBothLanguages) {
  EXPECT_NE(path({"--help"}).out.find("\"type\":\"ellipse\""), std::string::npos);
  const auto chinese = mjarm({"path", "--help"},
                             {.folder = {}, .input = {}, .environment = {{"LANG", "zh_CN.UTF-8"}}});
  EXPECT_NE(chinese.out.find("关节值"), std::string::npos);
}

TEST(PathData, LinesAndEllipses) {
  MJARM_TEST_FILE(urdf, "ik/ur5e.urdf");
  MJARM_TEST_FILE(lines, "ik/ur5e_lines.jsonl");
  MJARM_TEST_FILE(far, "ik/ur5e_ellipse_far.jsonl");
  MJARM_TEST_FILE(near, "ik/ur5e_ellipse.jsonl");
  const auto all = path({"--robot", urdf.string(), "--in", lines.string()});
  EXPECT_EQ(all.exit_code, 0) << all.err;
  const auto answers = json_lines(all.out);
  EXPECT_EQ(answers.size(), 20u);
  for (const json& answer : answers) {
    EXPECT_LE(largest_step(rows(answer.at("q"))), 0.5);
    EXPECT_EQ(answer.at("q").size(), 100u);
  }
  const auto reached = path({"--robot", urdf.string(), "--in", far.string()});
  ASSERT_EQ(reached.exit_code, 0) << reached.err;
  EXPECT_LE(largest_step(rows(json_lines(reached.out).at(0).at("q"))), 2 * kDegree);
  const auto stopped = path({"--robot", urdf.string(), "--in", near.string()});
  EXPECT_EQ(stopped.exit_code, 1);
  const json answer = json_lines(stopped.out).at(0);
  EXPECT_EQ(answer.at("reason"), "inner_void");
  EXPECT_EQ(answer.at("at"), 37);
}

}  // namespace
}  // namespace mjarm::app
