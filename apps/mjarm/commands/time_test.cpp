#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "apps/mjarm/commands/program_test.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;
using Row = std::vector<double>;

/// Limits of two joints, a spline and a straight way.
json two_paths() {
  return {{"limits", {{"v", {2, 3}}, {"a", {5, 4}}, {"j", {100, 80}}}},
          {"cases",
           {{{"id", 0}, {"waypoints", {{0, 0}, {1, 0.5}, {0.5, 1}, {0, 0}}}},
            {{"id", "way"}, {"waypoints", {{0, 0}, {1, 1}}}}}}};
}

json two_moves() {
  json cases = two_paths();
  cases["cases"] = {{{"id", 2}, {"q0", {0, 0}}, {"q1", {1, -1}}},
                    {{"id", 4}, {"q0", {0, 0}}, {"q1", {1, -1}}, {"v0", {1, 0}}}};
  return cases;
}

std::vector<std::string> arguments(const std::string& problem, const std::string& in,
                                   std::vector<std::string> more = {}) {
  std::vector<std::string> all = {"time", "--problem", problem, "--in", in};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

/// Checks samples against the limits and each other by differences alone.
void expect_sound(const json& answer, const json& limits, bool with_jerk) {
  const json& samples = answer.at("samples");
  ASSERT_GE(samples.size(), 2u);
  EXPECT_EQ(samples.front().at(0), 0);
  EXPECT_EQ(samples.back().at(0), answer.at("duration"));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Row q = samples[i].at(1), v = samples[i].at(2), a = samples[i].at(3);
    for (std::size_t k = 0; k < q.size(); ++k) {
      EXPECT_LE(std::abs(v[k]), limits.at("v").at(k).get<double>() * (1 + 1e-6));
      EXPECT_LE(std::abs(a[k]), limits.at("a").at(k).get<double>() * (1 + 1e-6));
      if (i == 0) continue;
      const double dt = samples[i].at(0).get<double>() - samples[i - 1].at(0).get<double>();
      const Row q_before = samples[i - 1].at(1), v_before = samples[i - 1].at(2);
      const Row a_before = samples[i - 1].at(3);
      const double jump = with_jerk ? 100 * dt : 10;
      EXPECT_NEAR(q[k] - q_before[k], 0.5 * dt * (v[k] + v_before[k]), jump * dt * dt + 1e-9);
      EXPECT_LE(std::abs(v[k] - v_before[k]), 5.001 * dt + 1e-9);
      if (with_jerk && dt > 1e-5) {
        EXPECT_LE(std::abs(a[k] - a_before[k]) / dt, limits.at("j").at(k).get<double>() * 1.0001);
      }
    }
  }
}

TEST(Time, EveryProblemKeepsItsLimits) {
  const support::TempFolder folder;
  const std::string paths = folder.write("paths.json", two_paths().dump(1)).string();
  const std::string moves = folder.write("moves.json", two_moves().dump()).string();
  const std::string out = (folder.path() / "traj.json").string();
  for (const std::string problem : {"p2p", "path_va", "path_vaj", "via_vaj"}) {
    const auto result = mjarm(arguments(problem, problem == "p2p" ? moves : paths,
                                        {"--out", out, "--dt", "1ms", "--check"}));
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.out, "");
    const json answers = json::parse(folder.read("traj.json"));
    ASSERT_EQ(answers.size(), 2u);
    for (const auto& [id, answer] : answers.items()) {
      EXPECT_EQ(answer.at("ok"), true) << id;
      EXPECT_GT(answer.at("us").get<double>(), 0);
      expect_sound(answer, two_paths().at("limits"), problem != "path_va");
      EXPECT_LE(answer.at("use").at("acceleration").get<double>(), 1 + 1e-6);
      EXPECT_GE(answer.at("use").at("acceleration").get<double>(), 0.9) << problem << " " << id;
      EXPECT_EQ(answer.at("use").contains("jerk"), problem != "path_va");
    }
    EXPECT_TRUE(answers.contains(problem == "p2p" ? "4" : "way"));
  }
}

TEST(Time, AnswersOneRequestAndLeavesOutTimes) {
  const std::vector<std::string> request = {"time",
                                            "--problem",
                                            "path_vaj",
                                            "--robot",
                                            "ur5e",
                                            "--points",
                                            "0,-90deg,90deg,0,0,0;0.5,-1,1,0,0,0;1,-1,1,1,0,0",
                                            "--no-timing"};
  const auto first = mjarm(request);
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const json answer = json::parse(first.out);
  EXPECT_EQ(answer.at("ok"), true);
  EXPECT_GT(answer.at("duration").get<double>(), 0.5);
  EXPECT_FALSE(answer.contains("us"));
  EXPECT_FALSE(answer.contains("samples"));
  EXPECT_EQ(mjarm(request).out, first.out);
}

/// A path of the UR5e that needs more torque than a third of it.
const std::vector<std::string> kStretched = {
    "time",
    "--problem",
    "path_va",
    "--robot",
    "ur5e",
    "--points",
    "0,-90deg,90deg,0,0,0;0.5,-0.6,0.6,0,0,0;1,-1.6,0.5,1,0,0",
    "--check",
    "--no-timing"};

TEST(Time, TorqueLimitsAreKeptWhereTheyAreAskedFor) {
  const auto answer = [](const std::vector<std::string>& more) {
    std::vector<std::string> all = kStretched;
    all.insert(all.end(), more.begin(), more.end());
    const auto result = mjarm(all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return json::parse(result.out);
  };
  const json free = answer({}), whole = answer({"--torque"}), part = answer({"--torque", "0.37"});
  EXPECT_FALSE(free.at("use").contains("torque"));
  EXPECT_LE(whole.at("use").at("torque").get<double>(), 0.9);
  EXPECT_NEAR(whole.at("duration").get<double>(), free.at("duration").get<double>(), 1e-3);
  EXPECT_NEAR(part.at("use").at("torque").get<double>(), 1, 1e-2);
  EXPECT_GE(part.at("duration").get<double>(), 1.002 * free.at("duration").get<double>());
}

TEST(Time, TorqueLimitsThatCannotBeKeptAreRefused) {
  std::vector<std::string> weak = kStretched;
  weak.insert(weak.end(), {"--torque", "0.1"});
  const auto result = mjarm(weak);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(only_line(result).find("joint 2"), std::string::npos) << result.err;
  const support::TempFolder folder;
  const std::string file = folder.write("paths.json", two_paths().dump()).string();
  const auto joints = mjarm(arguments("path_va", file, {"--torque"}));
  EXPECT_EQ(joints.exit_code, 2);
  EXPECT_NE(only_line(joints).find("6 joints"), std::string::npos) << joints.err;
}

TEST(Time, ACaseThatCannotBeDoneIsToldApart) {
  const support::TempFolder folder;
  json cases = two_moves();
  cases["cases"][1]["v1"] = {9, 0};  // beyond the limit
  const auto result = mjarm(arguments("p2p", folder.write("moves.json", cases.dump()).string()));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(only_line(result).find("moves.json: "), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("case 4"), std::string::npos) << result.err;
  const json answers = json::parse(result.out);
  EXPECT_EQ(answers.at("2").at("ok"), true);
  EXPECT_EQ(answers.at("4").at("ok"), false);
  EXPECT_FALSE(answers.at("4").at("reason").get<std::string>().empty());
}

TEST(Time, HostileFilesAreRefusedInOneLine) {
  const support::TempFolder folder;
  const auto says = [&](const std::string& content, const std::string& word,
                        const std::string& problem = "path_va") {
    const std::string file = folder.write("cases.json", content).string();
    const auto result = mjarm(arguments(problem, file));
    EXPECT_EQ(result.exit_code, 2) << content.substr(0, 200);
    EXPECT_EQ(result.out, "");
    const std::string line = only_line(result);
    EXPECT_NE(line.find("cases.json"), std::string::npos) << line;
    EXPECT_NE(line.find(word), std::string::npos) << line;
  };
  const auto with = [](const json& patch) {
    json cases = two_paths();
    cases.merge_patch(patch);
    return cases.dump();
  };
  says("", "JSON");
  says("[]", "object");
  says("{\"limits\":", "JSON");
  says(std::string(100'000, '['), "deep");
  says(R"({"limits":{"v":[1e999]}})", "range");
  says(with({{"limits", nullptr}}), "\"limits\"");
  says(with({{"limits", 3}}), "\"limits\"");
  says(with({{"limits", {{"v", {1, 0}}}}}), "\"v\"");
  says(with({{"limits", {{"a", {1}}}}}), "\"a\"");
  says(with({{"limits", {{"v", json::array()}}}}), "0 joints");
  says(with({{"limits", {{"v", Row(17, 1.0)}}}}), "17 joints");
  says(with({{"cases", nullptr}}), "\"cases\"");
  says(with({{"cases", 1}}), "\"cases\"");
  says(with({{"cases", {1}}}), "cases[0]");
  const auto one_case = [&](const json& entry) { return with({{"cases", {entry}}}); };
  says(one_case({{"waypoints", {{0, 0}}}}), "\"id\"");
  says(one_case({{"id", 0.5}, {"waypoints", {{0, 0}}}}), "\"id\"");
  says(one_case({{"id", 0}, {"waypoint", {{0, 0}}}}), "\"waypoints\"");
  says(one_case({{"id", 0}, {"waypoints", json::array()}}), "\"waypoints\"");
  says(one_case({{"id", 0}, {"waypoints", {{0, 0}, {1, 2, 3}}}}), "waypoints[1]");
  says(one_case({{"id", 0}, {"waypoints", {{0, 0}, {1, nullptr}}}}), "waypoints[1]");
  says(one_case({{"id", 0}, {"waypoints", {{0, 0}, 7}}}), "waypoints[1]");
  says(one_case({{"id", 0}, {"q0", {0, 0}}}), "\"q1\"", "p2p");
  const json entry = {{"id", 3}, {"waypoints", {{0, 0}}}};
  says(with({{"cases", {entry, entry}}}), "cases[1]");
}

TEST(Time, UsageErrorsNameTheOption) {
  const auto says = [](const std::vector<std::string>& more, const std::string& word) {
    std::vector<std::string> all = {"time"};
    all.insert(all.end(), more.begin(), more.end());
    const auto result = mjarm(all);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(only_line(result).find(word), std::string::npos) << result.err;
  };
  const std::string q = "0,0,0,0,0,0";
  says({"--problem", "p2p"}, "--points");
  says({"--problem", "path_av", "--points", q}, "path_va");
  says({"--points", q}, "--problem");
  says({"--problem", "p2p", "--points", q}, "2 points");
  says({"--problem", "path_va", "--points", "1,2;3"}, "--points");
  says({"--problem", "path_va", "--points", q, "--dt", "0"}, "--dt");
  says({"--problem", "path_va", "--points", q, "--dt", "-1ms"}, "--dt");
  says({"--problem", "path_va", "--in", "/no/such/file.json"}, "/no/such/file.json");
  says({"--problem", "path_va", "--points", q, "--torque", "1.5"}, "--torque");
  says({"--problem", "path_va", "--points", q, "--torque", "much"}, "--torque");
  says({"--problem", "via_vaj", "--points", q, "--torque"}, "via_vaj");
}

TEST(Time, TinyStepsAreRefusedInsteadOfFillingTheDisk) {
  const auto result = mjarm(
      {"time", "--problem", "path_va", "--points", "0,0,0,0,0,0;1,1,1,1,1,1", "--dt", "1e-12"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(only_line(result).find("samples"), std::string::npos);
}

}  // namespace
}  // namespace mjarm::app
