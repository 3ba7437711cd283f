// The figures of all suites: medians, percentiles, ratios and their order, counted again here.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "apps/bench/runs_test.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A folder with one pose for the arm of `write_planar_arm`, and what peers answer about it.
json bench_answers(const support::TempFolder& folder, const std::vector<json>& answers) {
  write_planar_arm(folder);
  folder.write("arm_reachable.jsonl", R"({"pos":[2,0,0],"quat":[1,0,0,0]})");
  std::string lines = "\n";
  for (const json& answer : answers) lines += answer.dump() + "\n";
  return bench_json(bench_arm(
      "ik", folder.path().string(),
      {"--tip", "tool", "--rounds", "1", "--quiet", "--peers", write_peers(folder, lines)}));
}

json answer_of(const std::string& who, const std::vector<double>& us) {
  return {{"who", who}, {"version", "1"}, {"set", "reachable"}, {"timed", "python"}, {"us", us}};
}

/// The value that exactly `percent` of all (rounded down) are below, found by counting.
double counted(const std::vector<double>& values, std::size_t percent) {
  for (const double value : values) {
    const auto below = std::ranges::count_if(values, [&](double v) { return v < value; });
    if (static_cast<std::size_t>(below) == values.size() * percent / 100) return value;
  }
  return std::nan("");
}

TEST(BenchStatistics, MediansAndPercentilesAreThoseThatCountingGives) {
  const support::TempFolder folder;
  std::mt19937 random(7);
  std::map<std::string, std::vector<double>> all;
  std::vector<json> answers;
  for (const int count : {1, 2, 3, 4, 10, 99, 100, 101, 200, 257}) {
    std::vector<double> us;
    for (int i = 0; i < count; ++i) us.push_back(0.1 + 1.7 * i * i);  // no two alike
    std::shuffle(us.begin(), us.end(), random);
    const std::string who = "peer of " + std::to_string(count);
    all[who] = us;
    answers.push_back(answer_of(who, us));
  }
  const json bench = bench_answers(folder, answers);
  const double ours = run_of(bench, "mjarm", "reachable").at("us").at("median");
  for (const auto& [who, us] : all) {
    const json& run = run_of(bench, who, "reachable");
    EXPECT_EQ(run.at("us").at("median"), counted(us, 50)) << who;
    EXPECT_EQ(run.at("us").at("p99"), counted(us, 99)) << who;
    EXPECT_NEAR(run.at("ratio").get<double>() * ours, counted(us, 50), 1e-9 * counted(us, 50));
  }
}

TEST(BenchStatistics, PeersStandBehindOursFromFastToSlow) {
  const support::TempFolder folder;
  const json broken = {{"who", "early"}, {"version", "1"}, {"error", "no such arm"}};
  const json bench = bench_answers(folder, {broken, answer_of("slow", {9e6, 9e6}),
                                            answer_of("fast", {1e6}), answer_of("same", {9e6})});
  std::vector<std::string> order;
  for (const json& run : bench.at("robots")[0].at("runs")) {
    if (run.value("set", "reachable") == "reachable") order.push_back(run.at("who"));
  }
  EXPECT_THAT(order, ElementsAre("mjarm", "mjarm numeric", "fast", "slow", "same", "early"));
}

TEST(BenchStatistics, ATableRoundsToThreeDigits) {
  const support::TempFolder folder;
  const std::vector<std::pair<double, std::string>> cells = {{1234.56, "1235"},
                                                             {123.456, "123"},
                                                             {12.3456, "12.3"},
                                                             {1.23456, "1.23"},
                                                             {0.123456, "0.123"}};
  std::vector<json> answers;
  for (const auto& [us, cell] : cells) answers.push_back(answer_of("at " + cell, {us}));
  answers.push_back(answer_of("two", {5, 7}));
  answers.push_back(answer_of("none", {}));
  (void)bench_answers(folder, answers);
  const auto table = mjarm(bench_arm(
      "ik", folder.path().string(),
      {"--tip", "tool", "--rounds", "1", "--quiet", "--peers", (folder.path() / "venv").string()}));
  const auto row_of = [&](const std::string& who) {
    std::string row;
    for (const std::string& line : support::lines_of(table.out)) {
      if (line.find("| " + who + " 1 ") != std::string::npos) row = line;
    }
    std::erase(row, ' ');
    return row;
  };
  for (const auto& [us, cell] : cells) {  // of one call alone there is no 99th percentile
    EXPECT_THAT(row_of("at " + cell), HasSubstr("|-|" + cell + "|-|"));
  }
  EXPECT_THAT(row_of("two"), HasSubstr("|7.00|7.00|"));
  EXPECT_THAT(row_of("none"), HasSubstr("|-|-|-|-|python|"));
}

/// 200 distances, so many of them at the mark itself, the others just beyond 2 cm.
std::vector<double> within(int count, double mark) {
  std::vector<double> distances(200, 0.020001);
  std::fill_n(distances.begin(), count, mark);
  return distances;
}

TEST(BenchStatistics, AMarkIsPassedByTheShareAndNotByOneGoalLess) {
  const support::TempFolder folder;
  std::vector<double> spread;
  for (int i = 0; i < 200; ++i) spread.push_back(0.001 * ((i * 37) % 200));  // 0 to 0.199, mixed
  json curve = json::array();
  for (const auto& distances :
       {within(189, 0.02), within(190, 0.02), spread, within(179, 0.005), within(180, 0.005)}) {
    const auto n = curve.size() + 1;
    curve.push_back({{"steps", 100 * n}, {"seconds", 3 * n}, {"distances", distances}});
  }
  const json answer = {
      {"who", "peer"}, {"version", "1"}, {"timed", "python"}, {"us", {500}}, {"curve", curve}};
  const json bench = bench_json({"bench", "rl", "--set", "tutorial", "--steps", "1024", "--seeds",
                                 "1", "--quiet", "--out", (folder.path() / "out").string(),
                                 "--peers", write_peers(folder, "\n" + answer.dump() + "\n")});
  const json& run = run_of(bench, "peer", "tutorial");
  EXPECT_EQ(run.at("rate"), 2000);  // [1/s] of 500 us a step
  const json& reached = run.at("reached");
  EXPECT_EQ(reached.at("2cm").at("steps"), json({200.0}));
  EXPECT_EQ(reached.at("2cm").at("seconds"), json({6.0}));
  EXPECT_EQ(reached.at("5mm").at("steps"), json({500.0}));  // 90 % are enough here
  EXPECT_EQ(reached.at("1cm").at("seeds"), 0);
  EXPECT_NEAR(run.at("in_the_end").at("2cm").get<double>(), 0.9, 1e-12);
  const json& points = run.at("runs")[0].at("curve");
  EXPECT_NEAR(points[0].at("2cm").get<double>(), 189.0 / 200, 1e-12);
  EXPECT_NEAR(points[2].at("1cm").get<double>(), 11.0 / 200, 1e-12);  // 0 to 0.010
  EXPECT_NEAR(points[2].at("median").get<double>(), 0.0995, 1e-12);   // between 0.099 and 0.1
}

/// One of three problems, solved by the way through free space.
std::string free_problem(const std::string& id) {
  return R"({"id": ")" + id + R"(", "scene": "one", "start": [0], "goals": [[1]], "valid": true,
"obstacles": [{"name": "b", "type": "sphere", "pos": [-1, 0, 0], "radius": 0.1}]})";
}

TEST(BenchStatistics, PlansAreComparedOnTheProblemsThatBothSolved) {
  const support::TempFolder folder;
  folder.write("mbm_ur5_public.json", R"({"robot": {"name": "arm", "base": "base", "joints": [
{"name": "j1", "type": "revolute", "parent": "base", "child": "a", "xyz": [0, 0, 0],
 "quat": [1, 0, 0, 0], "axis": [0, 0, 1], "limits": [-3, 3]}], "joint_names": ["j1"],
"spheres": [{"link": "a", "center": [1, 0, 0], "radius": 0.05}], "self_collision_link_pairs": []},
"problems": [)" + free_problem("p0") + "," +
                                          free_problem("p1") + "," + free_problem("p2") + "]}");
  const json answer = {
      {"who", "peer"},      {"version", "1"},           {"timed", "python"},
      {"us", {3000, 1000}}, {"problems", {"p2", "p1"}}, {"paths", {{{0}, {1}}, nullptr}}};
  const json bench = bench_json({"bench", "plan", "--set", "ur5", "--quiet", "--data",
                                 folder.path().string(), "--out", (folder.path() / "out").string(),
                                 "--peers", write_peers(folder, "\n" + answer.dump() + "\n")});
  const json ours = json::parse(folder.read("out/paths_ur5_mjarm.json"));
  const auto us = [&](const char* id) { return ours.at(id).at("us").get<double>(); };
  const std::vector<double> all = {us("p0"), us("p1"), us("p2")};
  const json& mine = run_of(bench, "mjarm", "one");
  EXPECT_EQ(mine.at("us").at("median"), counted(all, 50));
  EXPECT_EQ(mine.at("p95_us"), counted(all, 95));
  const json& theirs = run_of(bench, "peer", "one");
  EXPECT_EQ(theirs.at("problems"), 2);
  EXPECT_EQ(theirs.at("solved"), 1);
  EXPECT_EQ(theirs.at("us").at("median"), 3000);  // a problem without a path has taken its time
  EXPECT_NEAR(theirs.at("ratio").get<double>(), 3000 / std::max(us("p1"), us("p2")), 1e-9);
}

}  // namespace
}  // namespace mjarm::app
