#include <cmath>
#include <filesystem>

#include "apps/bench/runs_test.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;

/// One joint: a move from rest of 1 rad, whose fastest motion follows in closed form, one from a
/// moving start, and a path of three waypoints.
std::string write_time_data(const support::TempFolder& folder) {
  const json limits = {{"v", {10}}, {"a", {10}}, {"j", {4}}};
  const json rest = {{"id", 0}, {"q0", {0}}, {"q1", {1}}};
  const json state = {{"id", 1}, {"q0", {0}}, {"q1", {1}}, {"v0", {0.5}}};
  folder.write("arm_p2p.json", json{{"limits", limits}, {"cases", {rest, state}}}.dump());
  const json path = {{"id", "a"}, {"waypoints", {{0.0}, {0.5}, {1.0}}}};
  folder.write("arm_paths.json", json{{"limits", limits}, {"cases", json::array({path})}}.dump());
  return folder.path().string();
}

/// Four phases of full jerk (h = 2 j (T / 4)^3).
const double kFastest = 4 * std::cbrt(1 / (2 * 4.0));

TEST(BenchTime, ComparesWithTheBestKnown) {
  const support::TempFolder folder;
  const std::string data = write_time_data(folder);
  folder.write("best_known.json",
               json{{"arm_p2p", {{"p2p_vaj", {{"0", kFastest / 2}, {"1", 1.0}}}}}}.dump());
  const json bench = bench_json(bench_arm("time", data, {"--rounds", "2"}));
  const json& rest = run_of(bench, "mjarm", "rest");
  EXPECT_EQ(rest.at("cases"), 1);
  EXPECT_EQ(rest.at("solved"), 1);
  EXPECT_EQ(rest.at("beyond"), 0);
  EXPECT_NEAR(rest.at("duration").at("mean").get<double>(), 2, 1e-12);
  EXPECT_NEAR(rest.at("use").get<double>(), 1, 1e-6);  // the jerk
  EXPECT_GT(rest.at("us").at("median").get<double>(), 0);
  EXPECT_EQ(run_of(bench, "mjarm", "state").at("cases"), 1);
  // No joint leaves its range.
  const json& range = run_of(bench, "mjarm", "range");
  EXPECT_EQ(range.at("solved"), 10'000);
  EXPECT_EQ(range.at("beyond"), 0);
  EXPECT_LE(range.at("outside").get<double>(), 1e-9);
  EXPECT_GE(range.at("duration").at("worst").get<double>(), 1);
  // Nothing is known of paths: ours stand in, and jerk limits cost time.
  EXPECT_EQ(run_of(bench, "mjarm", "path_va").at("duration").at("mean"), 1);
  EXPECT_GT(run_of(bench, "mjarm", "path_vaj").at("duration").at("mean").get<double>(), 1);
}

/// 201 states of one joint that steps at full speed from 0 to `way` in `duration`: q, v, a.
std::string jumpy_states(double way, double duration) {
  std::string bytes;
  for (int i = 0; i <= 200; ++i) {
    const double state[] = {way * i / 200, i % 200 == 0 ? 0 : way / duration, 0};
    bytes.append(reinterpret_cast<const char*>(state), sizeof state);
  }
  return bytes;
}

TEST(BenchTime, RunsPeersAndJudgesThemToo) {
  const support::TempFolder folder;
  const std::string data = write_time_data(folder);
  // At 20 rad/s, over the limit of 10; and one that stops half way.
  const std::string fast = folder.write("fast.f64", jumpy_states(1, 0.05)).string();
  const std::string half = folder.write("half.f64", jumpy_states(0.5, 1)).string();
  const json row = {{"version", "1"}, {"set", "rest"}, {"timed", "python"}, {"us", {8}}};
  json fast_row = row, half_row = row, none = row;
  fast_row.update({{"who", "fast"}, {"durations", {0.05}}, {"states", fast}});
  half_row.update({{"who", "half"}, {"durations", {1}}, {"states", half}});
  none.update({{"who", "none"}, {"durations", {nullptr}}, {"states", half}});
  const std::string venv =
      write_peers(folder, "\n" + fast_row.dump() + "\n" + half_row.dump() + "\n" + none.dump() +
                              "\n"
                              R"({"who":"gone","version":"?","error":"not installed"})"
                              "\n");
  const json bench = bench_json(bench_arm("time", data, {"--rounds", "1", "--peers", venv}));
  EXPECT_EQ(run_of(bench, "fast", "rest").at("solved"), 1);
  EXPECT_EQ(run_of(bench, "fast", "rest").at("beyond"), 1);
  EXPECT_GE(run_of(bench, "fast", "rest").at("use").get<double>(), 2 - 1e-9);
  EXPECT_LT(run_of(bench, "fast", "rest").at("duration").at("mean").get<double>(), 0.1);
  EXPECT_EQ(run_of(bench, "fast", "rest").at("us").at("median"), 8);
  EXPECT_EQ(run_of(bench, "half", "rest").at("solved"), 0);
  EXPECT_EQ(run_of(bench, "half", "rest").at("wrong")[0].at("reason"), "misses");
  EXPECT_EQ(run_of(bench, "none", "rest").at("solved"), 0);
  EXPECT_NE(bench.dump().find("not installed"), std::string::npos);
  folder.write("fast.f64", "too short");
  const auto broken = mjarm(bench_arm("time", data, {"--rounds", "1", "--quiet", "--peers", venv}));
  EXPECT_EQ(broken.exit_code, 1);
  EXPECT_NE(only_line(broken).find("fast.f64"), std::string::npos);
}

TEST(BenchTime, MakesItsOwnCasesTheSameEveryTime) {
  const std::vector<std::string> arguments = {"bench",    "time", "--robot",    "ur5e",
                                              "--rounds", "1",    "--no-timing"};
  const auto first = mjarm(arguments);
  ASSERT_EQ(first.exit_code, 0) << first.err;
  for (const char* set : {"rest", "state", "range", "path_va ", "path_vaj", "via_vaj", "ellipse"}) {
    EXPECT_NE(first.out.find(std::string("| ") + set), std::string::npos) << first.out;
  }
  EXPECT_EQ(first.out, mjarm(arguments).out);
}

TEST(BenchTime, RangesOfAnArmCostNoTime) {
  const json bench = bench_json({"bench", "time", "--robot", "ur5e", "--rounds", "1"});
  const json& range = run_of(bench, "mjarm", "range");
  EXPECT_EQ(range.at("solved"), 10'000);
  EXPECT_EQ(range.at("beyond"), 0);
  EXPECT_LE(range.at("duration").at("worst").get<double>(), 1.02);
}

TEST(BenchTime, SaysWhatIsWrong) {
  const support::TempFolder folder;
  const std::string data = write_time_data(folder);
  const auto error_of = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {"bench", "time", "--rounds", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = mjarm(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.out;
    return only_line(result);
  };
  const auto holds = [](const std::string& line, const std::string& word) {
    EXPECT_NE(line.find(word), std::string::npos) << line;
  };
  holds(error_of({"--robot", "ur5e", "--data", data}), "ur5e_p2p.json");
  holds(error_of({"--robot", "no_such_robot"}), "no_such_robot");
  folder.write("best_known.json", R"({"arm_p2p":7})");
  holds(error_of({"--robot", "arm", "--data", data}), "best_known.json");
  folder.write("best_known.json", "{");
  holds(error_of({"--robot", "arm", "--data", data}), "best_known.json");
  std::filesystem::remove(folder.path() / "best_known.json");
  folder.write("arm_p2p.json", R"({"limits":{"v":[1],"a":[1],"j":[1]},"cases":[]})");
  holds(error_of({"--robot", "arm", "--data", data}), "arm_p2p.json");
}

}  // namespace
}  // namespace mjarm::app
