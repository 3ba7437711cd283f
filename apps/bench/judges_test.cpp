// The judges of all suites say no: answers that are nearly right, from peers and as if they were
// mjarm's own (an answer without a version counts as such).
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "apps/bench/runs_test.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// Where the tool of `write_planar_arm` is, turned by `more` [rad] about z.
json planar_pose(double j1, double j2, double more = 0) {
  const double half = (j1 + j2 + more) / 2;
  return {{"pos", {std::cos(j1) + std::cos(j1 + j2), std::sin(j1) + std::sin(j1 + j2), 0}},
          {"quat", {std::cos(half), 0, 0, std::sin(half)}}};
}

/// A run beside peers that answer in these lines.
support::ProgramResult judged(const support::TempFolder& folder, const std::string& suite,
                              const std::vector<json>& answers) {
  std::string lines = "\n";
  for (const json& answer : answers) lines += answer.dump() + "\n";
  std::vector<std::string> more = {"--rounds", "1",       "--json",
                                   "--quiet",  "--peers", write_peers(folder, lines)};
  if (suite != "time") more.insert(more.end(), {"--tip", "tool"});
  return mjarm(bench_arm(suite, folder.path().string(), more));
}

json peer(const std::string& who, const std::string& set, const json& members) {
  json answer = {{"who", who}, {"version", "1"}, {"set", set}, {"timed", "c++"}, {"us", {1}}};
  answer.update(members);
  return answer;
}

/// How many of its answers count as right, and how many are answers that should be none.
std::pair<int, int> counts(const json& bench, const std::string& who, const std::string& set) {
  const json& run = run_of(bench, who, set);
  EXPECT_EQ(run.at("misses").size() + run.at("right").get<std::size_t>(), run.at("cases"));
  return {run.at("right"), run.at("false_ok")};
}

TEST(BenchJudges, AnAnswerIsRightWithinItsTolerancesAndLimitsOnly) {
  const support::TempFolder folder;
  write_planar_arm(folder);
  const double arm = 2 * std::cos(0.5);  // [m] from the base to the tool at j2 = 1
  folder.write("arm_reachable.jsonl",
               planar_pose(0, 1).dump() + "\n" + planar_pose(0.5, 1, 0.9e-3).dump() + "\n" +
                   planar_pose(0.5, 1, 1.1e-3).dump() + "\n" + planar_pose(3, -1).dump() + "\n");
  folder.write("arm_unreachable.jsonl", R"({"pos":[3,0,0],"quat":[1,0,0,0]})"
                                        "\n");
  const auto first = [&](const std::string& who, const json& q) {
    return peer(who, "reachable", {{"q", json::array({q})}});
  };
  const json exact = {{0, 1}, {0.5, 1}, {0.5, 1}, {3, -1}};
  json beyond = exact;
  beyond[3] = {3 + 1e-6, -1};
  json more = exact;
  more.push_back({7, 7});
  const auto result = judged(
      folder, "ik",
      {peer("exact", "reachable", {{"q", exact}}), first("near", {0.9e-4 / arm, 1}),
       first("off", {1.1e-4 / arm, 1}), first("long", {0, 1, 0}), first("short", {0}),
       first("no", nullptr), peer("beyond", "reachable", {{"q", beyond}}),
       peer("more", "reachable", {{"q", more}}), peer("no", "unreachable", {{"q", {nullptr}}}),
       peer("yes", "unreachable", {{"q", {{0, 0}}}})});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json bench = json::parse(result.out);
  using Pair = std::pair<int, int>;
  EXPECT_EQ(counts(bench, "exact", "reachable"), Pair(3, 1));  // the third is turned too far
  EXPECT_EQ(run_of(bench, "exact", "reachable").at("misses")[0].at("case"), 2);
  EXPECT_EQ(counts(bench, "near", "reachable"), Pair(1, 0));
  EXPECT_EQ(counts(bench, "off", "reachable"), Pair(0, 1));
  EXPECT_EQ(counts(bench, "long", "reachable"), Pair(0, 1));
  EXPECT_EQ(counts(bench, "short", "reachable"), Pair(0, 1));
  EXPECT_EQ(counts(bench, "no", "reachable"), Pair(0, 0));
  EXPECT_EQ(counts(bench, "beyond", "reachable"), Pair(2, 2));
  EXPECT_EQ(counts(bench, "no", "unreachable"), Pair(1, 0));
  EXPECT_EQ(counts(bench, "yes", "unreachable"), Pair(0, 1));
  EXPECT_EQ(run_of(bench, "more", "reachable").at("right"), 3);  // nobody asked for a fifth
}

TEST(BenchJudges, APathIsWholeInStepsOfHalfARadianOnly) {
  const support::TempFolder folder;
  write_planar_arm(folder);
  const json poses = {planar_pose(0, 1), planar_pose(0.5, 1), planar_pose(0.5, 1.25)};
  folder.write(
      "arm_lines.jsonl",
      json{{"type", "poses"}, {"poses", poses}}.dump() + "\n" +
          json{{"type", "poses"}, {"poses", {planar_pose(0, 1), planar_pose(0.51, 1)}}}.dump() +
          "\n");
  const json whole = {{0, 1}, {0.5, 1}, {0.5, 1.25}};
  const auto follows = [&](const std::string& who, const json& q) {
    return peer(who, "lines", {{"q", json::array({q})}});
  };
  const auto result = judged(
      folder, "path",
      {peer("both", "lines", {{"q", {whole, {{0, 1}, {0.51, 1}}}}}),
       follows("stops", {{0, 1}, {0.5, 1}}), follows("off", {{0, 1}, {0.5, 1}, {0.5, 1.2502}}),
       follows("gap", {{0, 1}, nullptr, {0.5, 1.25}}), follows("none", json::array())});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json bench = json::parse(result.out);
  const auto is = [&](const std::string& who, int cases, int complete, int flips, int off) {
    const json& run = run_of(bench, who, "lines");
    EXPECT_EQ(run.at("cases"), cases) << who;
    EXPECT_EQ(run.at("complete"), complete) << who;
    EXPECT_EQ(run.at("flips"), flips) << who;
    EXPECT_EQ(run.at("off"), off) << who;
    EXPECT_EQ(run.at("stopped").size(), static_cast<std::size_t>(cases - complete)) << who;
  };
  is("both", 2, 1, 1, 0);  // half a radian is none, a hundredth more is a flip
  is("stops", 1, 0, 0, 0);
  is("off", 1, 0, 0, 1);
  is("gap", 1, 0, 0, 1);
  is("none", 1, 0, 0, 0);
  EXPECT_EQ(run_of(bench, "stops", "lines").at("stopped")[0].at("answers"), 2);
}

/// States of a quintic from 0 to `way` and from rest to rest: q, v and a of each joint.
std::string quintic_states(const std::vector<double>& way, double duration, int steps,
                           double v_end = 0) {
  std::string bytes;
  for (int i = 0; i <= steps; ++i) {
    const double x = static_cast<double>(i) / steps;
    const double shape[] = {x * x * x * (10 - x * (15 - 6 * x)),
                            30 * x * x * (1 - x) * (1 - x) / duration,
                            60 * x * (1 - x) * (1 - 2 * x) / (duration * duration)};
    for (int k = 0; k < 3; ++k) {
      for (const double h : way) {
        const double value = h * shape[k] + (k == 1 && i == steps ? v_end : 0);
        bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
      }
    }
  }
  return bytes;
}

TEST(BenchJudges, AMotionHoldsItsLimitsAndArrives) {
  const support::TempFolder folder;
  folder.write("arm_p2p.json", R"({"limits":{"v":[10],"a":[10],"j":[4]},)"
                               R"("cases":[{"id":"m","q0":[0],"q1":[1]}]})");
  const auto answer = [&](const std::string& who, double way, double duration, double v_end = 0) {
    const auto file =
        folder.write(who + ".f64", quintic_states({way}, duration, 200, v_end)).string();
    return peer(who, "rest", {{"durations", {duration}}, {"states", file}});
  };
  // The jerk of a quintic is 60 h / T^3 at its ends, the most of it.
  const double limit = std::cbrt(60.0 / 4);
  const auto result =
      judged(folder, "time",
             {answer("slow", 1, 2 * limit), answer("edge", 1, limit * 1.0001),
              answer("hasty", 1, limit / 1.1), answer("short", 1 - 2e-6, 2 * limit),
              answer("close", 1 - 0.5e-6, 2 * limit), answer("moving", 1, 2 * limit, 2e-6)});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json bench = json::parse(result.out);
  const auto is = [&](const std::string& who, int solved, int beyond, const std::string& why) {
    const json& run = run_of(bench, who, "rest");
    EXPECT_EQ(run.at("solved"), solved) << who;
    EXPECT_EQ(run.at("beyond"), beyond) << who;
    ASSERT_EQ(run.at("wrong").empty(), why.empty()) << run;
    if (why.empty()) return;
    EXPECT_EQ(run.at("wrong")[0].at("case"), "m");
    EXPECT_EQ(run.at("wrong")[0].at("reason"), why);
  };
  is("slow", 1, 0, "");
  is("edge", 1, 0, "");
  is("hasty", 1, 1, "limit");
  is("short", 0, 0, "misses");
  is("close", 1, 0, "");
  EXPECT_EQ(run_of(bench, "moving", "rest").at("solved"), 0);
  const double step = 1.0 / 200;  // over the first of them the jerk counts in the mean
  const double mean = (1 - step) * (1 - 2 * step);
  EXPECT_NEAR(run_of(bench, "slow", "rest").at("use").get<double>(), mean / 8, 1e-6);
  EXPECT_NEAR(run_of(bench, "hasty", "rest").at("use").get<double>(), mean * std::pow(1.1, 3),
              1e-6);
}

TEST(BenchJudges, AMotionPassesEveryWaypoint) {
  const support::TempFolder folder;
  const std::string limits = R"({"limits":{"v":[10,10],"a":[10,10],"j":[100,100]},"cases":[)";
  folder.write("arm_p2p.json", limits + R"({"id":0,"q0":[0,0],"q1":[1,0]}]})");
  folder.write("arm_paths.json", limits +
                                     R"({"id":"straight","waypoints":[[0,0],[0.3,0],[1,0]]},)"
                                     R"({"id":"bent","waypoints":[[0,0],[0.5,0.002],[1,0]]}]})");
  const std::string states = quintic_states({1, 0}, 4, 2000);
  const auto file = folder.write("path.f64", states + states).string();
  const auto result =
      judged(folder, "time", {peer("line", "path_va", {{"durations", {4, 4}}, {"states", file}})});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json run = run_of(json::parse(result.out), "line", "path_va");
  EXPECT_EQ(run.at("solved"), 1);
  ASSERT_EQ(run.at("wrong").size(), 1u);
  EXPECT_EQ(run.at("wrong")[0].at("case"), "bent");
  EXPECT_EQ(run.at("wrong")[0].at("reason"), "misses");
}

/// Two hinges about z, two links of 1 m; balls at the base and at the tool that meet when the arm
/// folds; a post far away from both.
constexpr const char* kFoldingArm = R"({"robot": {"name": "arm", "base": "base", "joints": [
{"name": "j1", "type": "revolute", "parent": "base", "child": "a", "xyz": [0, 0, 0],
 "quat": [1, 0, 0, 0], "axis": [0, 0, 1], "limits": [-3, 3]},
{"name": "j2", "type": "revolute", "parent": "a", "child": "b", "xyz": [1, 0, 0],
 "quat": [1, 0, 0, 0], "axis": [0, 0, 1], "limits": [-3, 3]}],
"joint_names": ["j1", "j2"],
"spheres": [{"link": "base", "center": [0, 0, 0], "radius": 0.1},
            {"link": "b", "center": [1, 0, 0], "radius": 0.05}],
"self_collision_link_pairs": [["base", "b"]]},
"problems": [{"id": "p", "scene": "one", "start": [-0.8, 0], "goals": [[0.8, 0], [1.2, 0]],
"valid": true, "obstacles": [{"name": "ball", "type": "sphere", "pos": [0, -3, 0],
"radius": 0.5}]}]})";

/// `bench plan` of that arm beside a peer that answers this path.
support::ProgramResult planned(const support::TempFolder& folder, const json& path,
                               const json& members = {{"version", "1"}}) {
  folder.write("mbm_panda_public.json", kFoldingArm);
  json answer = {
      {"who", "peer"}, {"timed", "c++"}, {"us", {1e6}}, {"problems", {"p"}}, {"paths", {path}}};
  answer.update(members);
  return mjarm({"bench", "plan", "--set", "panda", "--json", "--no-timing", "--quiet", "--data",
                folder.path().string(), "--out", (folder.path() / "out").string(), "--peers",
                write_peers(folder, "\n" + answer.dump() + "\n")});
}

TEST(BenchJudges, APathMayNotFoldTheArmIntoItself) {
  const support::TempFolder folder;
  for (const double fold : {2.9, 3.0}) {  // apart by 2 cos(fold / 2), of which 0.15 are the balls
    const json path = {{-0.8, 0}, {-0.8, fold}, {0.8, fold}, {0.8, 0}};
    const auto result = planned(folder, path);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const json run = run_of(json::parse(result.out), "peer", "one");
    const double depth = 0.15 - 2 * std::cos(fold / 2);
    EXPECT_EQ(run.at("valid"), depth > 0 ? 0 : 1);
    if (depth <= 0) {
      EXPECT_NEAR(run.at("cost").get<double>(), 2 * fold + 1.6, 1e-9);
      continue;
    }
    ASSERT_EQ(run.at("wrong").size(), 1u);
    EXPECT_EQ(run.at("wrong")[0].at("fault"), "self");
    EXPECT_NEAR(run.at("wrong")[0].at("depth").get<double>(), depth, 1e-12);
  }
}

TEST(BenchJudges, APathEndsAtAnyOfItsGoalsAndBeginsAtItsStart) {
  const support::TempFolder folder;
  for (const auto& [path, fault] : {std::pair<json, std::string>{{{-0.8, 0}, {1.2, 0}}, ""},
                                    {{{-0.8, 0.9e-4}, {0.8, 0}}, ""},
                                    {{{-0.8, 1.1e-4}, {0.8, 0}}, "start"},
                                    {{{-0.8, 0}, {0.8, 1.1e-4}}, "goal"},
                                    {{{-0.8, 0}, {1.0, 0}}, "goal"},
                                    {{{-0.8, 0}}, "goal"},
                                    {{{-0.8, 0}, {0.8}}, "shape"},
                                    {{{-0.8, 0}, {3.1, 0}, {0.8, 0}}, "limits"}}) {
    const auto result = planned(folder, path);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const json wrong = run_of(json::parse(result.out), "peer", "one").at("wrong");
    ASSERT_EQ(wrong.empty(), fault.empty()) << path;
    if (!fault.empty()) {
      EXPECT_EQ(wrong[0].at("fault"), fault) << path;
    }
  }
}

TEST(BenchJudges, WrongAnswersOfOurOwnAreTheExitCode) {
  const support::TempFolder folder;
  write_planar_arm(folder);
  folder.write("arm_reachable.jsonl", planar_pose(0, 1).dump());
  folder.write("arm_lines.jsonl",
               json{{"type", "poses"}, {"poses", {planar_pose(0, 1), planar_pose(0.1, 1)}}}.dump());
  folder.write("arm_p2p.json", R"({"limits":{"v":[10],"a":[10],"j":[4]},)"
                               R"("cases":[{"id":"m","q0":[0],"q1":[1]}]})");
  const std::string states = folder.write("m.f64", quintic_states({1}, 1, 200)).string();
  const auto as_ours = [](json answer) {
    answer.erase("version");
    return answer;
  };
  for (const auto& [suite, answer, words] :
       {std::tuple{"ik", peer("x", "reachable", {{"q", {{0, 0.9}}}}), "arm: 1 answers of mjarm"},
        {"path", peer("x", "lines", {{"q", {{{0, 1}}}}}), "arm: 1 paths that mjarm calls whole"},
        {"time", peer("x", "rest", {{"durations", {1}}, {"states", states}}),
         "arm: 1 motions of mjarm"}}) {
    const auto theirs = judged(folder, suite, {answer});
    EXPECT_EQ(theirs.exit_code, 0) << theirs.err;  // what a peer does wrong is told, no more
    const auto ours = judged(folder, suite, {as_ours(answer)});
    EXPECT_EQ(ours.exit_code, 1) << suite;
    EXPECT_THAT(only_line(ours), HasSubstr(words));
    EXPECT_TRUE(json::parse(ours.out).contains("robots")) << "the table comes all the same";
  }
  const auto plan = planned(folder, {{-0.8, 0}, {1.0, 0}}, {{"who", "peer"}});
  EXPECT_EQ(plan.exit_code, 1);
  EXPECT_THAT(only_line(plan), HasSubstr("panda: 1 paths of mjarm are not valid"));
  EXPECT_TRUE(folder.exists("out/bench.json"));
}

}  // namespace
}  // namespace mjarm::app
