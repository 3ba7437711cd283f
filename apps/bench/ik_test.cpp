#include <cmath>

#include "apps/bench/runs_test.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;

/// Two poses of an arm, and one that is out of reach.
std::string write_ik_data(const support::TempFolder& folder) {
  write_planar_arm(folder);
  const double h = std::sqrt(0.5);
  const json turned = {{"pos", {1, 1, 0}}, {"quat", {h, 0, 0, h}}, {"seed", {0.1, 1.4}}};
  const json bent = {{"pos", {2 * std::cos(0.5), 0, 0}},  // q = -0.5, 1
                     {"quat", {std::cos(0.25), 0, 0, std::sin(0.25)}},
                     {"seed", {-0.4, 0.7}}};
  const json far = {{"pos", {3, 0, 0}}, {"quat", {1, 0, 0, 0}}};
  folder.write("arm_reachable.jsonl", turned.dump() + "\n\n" + bent.dump() + "\n");
  folder.write("arm_unreachable.jsonl", far.dump() + "\n");
  return folder.path().string();
}

TEST(BenchIk, JudgesTheCasesOfAFolder) {
  const support::TempFolder folder;
  const std::string data = write_ik_data(folder);
  const json bench = bench_json(bench_arm("ik", data, {"--tip", "tool", "--rounds", "2"}));
  const json& reachable = run_of(bench, "mjarm", "reachable");
  EXPECT_EQ(reachable.at("cases"), 2);
  EXPECT_EQ(reachable.at("right"), 2);
  EXPECT_EQ(reachable.at("misses").size(), 0u);
  EXPECT_GT(reachable.at("us").at("median").get<double>(), 0);
  EXPECT_EQ(run_of(bench, "mjarm", "unreachable").at("right"), 1);
  const json& track = run_of(bench, "mjarm", "track");
  EXPECT_EQ(track.at("cases"), run_of(bench, "mjarm", "path").at("cases"));
  EXPECT_GT(track.at("right").get<int>(), track.at("cases").get<int>() / 2);
  EXPECT_GT(track.at("max_step").get<double>(), 0);
  EXPECT_GT(track.at("us").at("median").get<double>(), 0);
  EXPECT_GT(run_of(bench, "mjarm", "fk_jacobian").at("us").at("median").get<double>(), 0);
}

TEST(BenchIk, AWrongSetShowsAsMissesWithTheReason) {
  const support::TempFolder folder;
  const std::string data = write_ik_data(folder);
  folder.write("arm_reachable.jsonl", R"({"pos":[3,0,0],"quat":[1,0,0,0],"seed":[0,0]})");
  folder.write("arm_unreachable.jsonl", R"({"pos":[4,0,0],"quat":[1,0,0,0]})");
  const json bench =
      bench_json(bench_arm("ik", data, {"--tip", "tool", "--rounds", "1", "--no-timing"}));
  EXPECT_EQ(bench.dump().find("\"us\""), std::string::npos);
  const json& reachable = run_of(bench, "mjarm", "reachable");
  EXPECT_EQ(reachable.at("right"), 0);
  ASSERT_EQ(reachable.at("misses").size(), 1u);
  EXPECT_EQ(reachable.at("misses")[0].at("case"), 0);
  EXPECT_EQ(reachable.at("misses")[0].at("reason"), "out_of_reach");
}

TEST(BenchIk, MakesItsOwnCasesTheSameEveryTime) {
  const support::TempFolder folder;
  write_ik_data(folder);
  const std::vector<std::string> arguments = {
      "bench",    "ik", "--robot",    (folder.path() / "arm.urdf").string(), "--tip", "tool",
      "--rounds", "1",  "--no-timing"};
  const auto first = mjarm(arguments);
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_NE(first.out.find("| unreachable"), std::string::npos) << first.out;
  EXPECT_EQ(first.out, mjarm(arguments).out);
}

TEST(BenchIk, RunsPeersAndJudgesThemToo) {
  const support::TempFolder folder;
  const std::string data = write_ik_data(folder);
  // A peer that answers the first pose rightly, the second one wrongly, and one that fails.
  const std::string venv = write_peers(folder, R"(
{"who":"good","version":"1","set":"reachable","timed":"python","us":[5,7],"q":[[0,1.5707963],[1,1]]}
{"who":"bad","version":"2","error":"no such arm"}
)",
                                       R"(grep -q '"tip":"tool"' "$2" || exit 9)");
  const std::vector<std::string> arguments =
      bench_arm("ik", data, {"--tip", "tool", "--peers", venv, "--rounds", "1"});
  const auto table = mjarm(arguments);
  ASSERT_EQ(table.exit_code, 0) << table.err;
  EXPECT_NE(table.out.find("good 1"), std::string::npos) << table.out;
  EXPECT_NE(table.out.find("no such arm"), std::string::npos) << table.out;
  std::vector<std::string> as_json = arguments;
  as_json.insert(as_json.end(), {"--json", "--out", (folder.path() / "bench.json").string()});
  ASSERT_EQ(mjarm(as_json).exit_code, 0);
  const json good = run_of(json::parse(folder.read("bench.json")), "good", "reachable");
  EXPECT_EQ(good.at("right"), 1);
  EXPECT_EQ(good.at("false_ok"), 1);
  EXPECT_EQ(good.at("misses")[0].at("case"), 1);
  EXPECT_EQ(good.at("us").at("median"), 7);
  EXPECT_GT(good.at("ratio").get<double>(), 0);
}

/// At each of the two poses there is one branch, as tool and joints lie in a plane.
TEST(BenchIk, CountsBranchesBesidePeers) {
  const support::TempFolder folder;
  const std::string data = write_ik_data(folder);
  const std::string venv = write_peers(folder, R"(
{"who":"half","version":"1","set":"branches","timed":"python","us":[5,7],"q":[[[0,1.5707963],[1,1]],[]]}
)");
  const json bench = bench_json(
      bench_arm("ik", data, {"--all", "--tip", "tool", "--peers", venv, "--rounds", "1"}));
  for (const char* who : {"mjarm", "mjarm search", "mjarm 10000 starts"}) {
    const json& run = run_of(bench, who, "branches");
    EXPECT_EQ(run.at("poses"), 2) << who;
    EXPECT_EQ(run.at("found"), 2) << who;
    EXPECT_EQ(run.at("known"), 2) << who;
    EXPECT_EQ(run.at("missed"), 0) << who;
    EXPECT_GT(run.at("us").at("median").get<double>(), 0) << who;
  }
  const json& half = run_of(bench, "half", "branches");
  EXPECT_EQ(half.at("found"), 1);
  EXPECT_EQ(half.at("missed"), 1);
  EXPECT_EQ(half.at("false_ok"), 1);
}

/// An arm in a plane reaches every pose of its own, with joints at limits or zero as well.
TEST(BenchIk, HardPosesAreCountedWithTheirCauses) {
  const support::TempFolder folder;
  const std::string data = write_ik_data(folder);
  const std::vector<std::string> hard =
      bench_arm("ik", data, {"--hard", "--tip", "tool", "--rounds", "1", "--no-timing"});
  const json bench = bench_json(hard);
  for (const char* set : {"limit_1", "limit_2", "limit_3", "inside_3", "zero", "limit_or_zero"}) {
    const json& run = run_of(bench, "mjarm", set);
    EXPECT_EQ(run.at("cases"), 300) << set;
    EXPECT_EQ(run.at("right"), 300) << set;
  }
  const auto table = mjarm(hard);
  EXPECT_NE(table.out.find("| limit_or_zero | mjarm"), std::string::npos) << table.out;
  EXPECT_NE(table.out.find("300/300"), std::string::npos) << table.out;
  std::vector<std::string> other = hard;
  other.insert(other.end(), {"--seed", "2"});
  EXPECT_EQ(mjarm(other).exit_code, 0);
  other.back() = "-2";
  EXPECT_NE(only_line(mjarm(other)).find("--seed"), std::string::npos);
}

/// A peer that gives nothing is counted as refusing, one that answers anything as wrong.
TEST(BenchIk, HardPosesJudgePeersToo) {
  const support::TempFolder folder;
  const std::string data = write_ik_data(folder);
  const std::string venv = write_peers(folder, R"(
{"who":"half","version":"1","set":"limit_1","timed":"python","us":[5,7],"q":[[],[9,9]]}
)");
  const auto table = mjarm(bench_arm(
      "ik", data, {"--hard", "--tip", "tool", "--peers", venv, "--rounds", "1", "--no-timing"}));
  ASSERT_EQ(table.exit_code, 0) << table.err;
  EXPECT_NE(table.out.find("half 1"), std::string::npos) << table.out;
  EXPECT_NE(table.out.find("0/2"), std::string::npos) << table.out;
}

TEST(BenchIk, SaysWhatIsWrong) {
  const support::TempFolder folder;
  const std::string data = write_ik_data(folder);
  const auto error_of = [&](std::vector<std::string> more, int code) {
    std::vector<std::string> arguments = {"bench", "ik", "--rounds", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = mjarm(arguments);
    EXPECT_EQ(result.exit_code, code) << result.out;
    return only_line(result);
  };
  const auto holds = [](const std::string& line, const std::string& word) {
    EXPECT_NE(line.find(word), std::string::npos) << line;
  };
  holds(error_of({"--robot", "ur5e", "--data", data}, 2), "ur5e.urdf");
  holds(only_line(mjarm({"bench", "ik", "--rounds", "0"})), "--rounds");
  folder.write("arm_unreachable.jsonl", "{\"pos\":[1,2],\"quat\":[1,0,0,0]}");
  holds(error_of({"--robot", "arm", "--data", data, "--tip", "tool"}, 2), "unreachable.jsonl:1:");
  folder.write("arm_unreachable.jsonl", "\n");
  holds(error_of({"--robot", "arm", "--data", data, "--tip", "tool"}, 2), "unreachable.jsonl");
  folder.write("arm_unreachable.jsonl", R"({"pos":[3,0,0],"quat":[1,0,0,0]})");
  const auto with_peers = [&](const std::string& venv, int code) {
    const auto result = mjarm(
        bench_arm("ik", data, {"--rounds", "1", "--tip", "tool", "--peers", venv, "--quiet"}));
    EXPECT_EQ(result.exit_code, code);
    return only_line(result);
  };
  holds(with_peers("/no/such/venv", 2), "/no/such/venv/bin/python");
  const auto python = folder.write("venv/bin/python", "#!/bin/sh\nexit 3\n");
  std::filesystem::permissions(python, std::filesystem::perms::owner_all);
  holds(with_peers((folder.path() / "venv").string(), 1), "3");
  folder.write("venv/bin/python", "#!/bin/sh\necho '{\"who\":' > \"$3\"\n");
  holds(with_peers((folder.path() / "venv").string(), 1), "not valid JSON");
}

}  // namespace
}  // namespace mjarm::app
