#include <cmath>
#include <filesystem>

#include "apps/bench/runs_test.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;

/// The arm of `write_planar_arm` at j1, j2: where its tool is.
json pose_at(double j1, double j2) {
  const double turn = j1 + j2;
  return {{"pos", {std::cos(j1) + std::cos(turn), std::sin(j1) + std::sin(turn), 0}},
          {"quat", {std::cos(turn / 2), 0, 0, std::sin(turn / 2)}}};
}

std::string path_line(const std::vector<json>& poses) {
  return json{{"type", "poses"}, {"poses", poses}}.dump() + "\n";
}

/// A path that can be followed, one whose way is too long for a step, and one that leaves the
/// reach.
std::string write_path_data(const support::TempFolder& folder) {
  write_planar_arm(folder);
  folder.write("arm_lines.jsonl", path_line({pose_at(0, 1), pose_at(0.1, 1), pose_at(0.2, 1.1)}) +
                                      path_line({pose_at(0, 1), pose_at(1, 1)}));
  json far = pose_at(0, 1);
  far["pos"] = {4, 0, 0};
  folder.write("arm_ellipse.jsonl", path_line({pose_at(0, 1), far}));
  return folder.path().string();
}

TEST(BenchPath, JudgesThePathsOfAFolder) {
  const support::TempFolder folder;
  const std::string data = write_path_data(folder);
  const json bench = bench_json(bench_arm("path", data, {"--tip", "tool", "--rounds", "2"}));
  const json& lines = run_of(bench, "mjarm", "lines");
  EXPECT_EQ(lines.at("cases"), 2);
  EXPECT_EQ(lines.at("complete"), 1);
  EXPECT_EQ(lines.at("off"), 0);
  EXPECT_EQ(lines.at("flips"), 0);
  EXPECT_NEAR(lines.at("max_step").get<double>(), 0.1, 1e-6);
  ASSERT_EQ(lines.at("stopped").size(), 1u);
  EXPECT_EQ(lines.at("stopped")[0].at("case"), 1);
  EXPECT_NE(lines.at("stopped")[0].at("cause"), "");
  EXPECT_GT(lines.at("us").at("median").get<double>(), 0);
  const json& ellipse = run_of(bench, "mjarm", "ellipse");
  EXPECT_EQ(ellipse.at("complete"), 0);
  EXPECT_EQ(ellipse.at("stopped")[0].at("cause"), "out_of_reach @1");
}

TEST(BenchPath, RunsPeersAndJudgesThemToo) {
  const support::TempFolder folder;
  const std::string data = write_path_data(folder);
  // One peer completes the first path and flips on the second; the other is off its pose.
  const std::string venv = write_peers(folder, R"(
{"who":"flips","version":"1","set":"lines","timed":"python","us":[5,7],"q":[[[0,1],[0.1,1],[0.2,1.1]],[[0,1],[1,1]]]}
{"who":"off","version":"2","set":"lines","timed":"python","us":[5],"q":[[[0,1],[0.1,1.2],[0.2,1.1]]]}
{"who":"none","version":"?","error":"not installed"}
)");
  const json bench =
      bench_json(bench_arm("path", data, {"--tip", "tool", "--rounds", "1", "--peers", venv}));
  const json& flips = run_of(bench, "flips", "lines");
  EXPECT_EQ(flips.at("complete"), 1);
  EXPECT_EQ(flips.at("flips"), 1);
  EXPECT_NEAR(flips.at("max_step").get<double>(), 1, 1e-12);
  const json& off = run_of(bench, "off", "lines");
  EXPECT_EQ(off.at("cases"), 1);  // it was too slow for the second
  EXPECT_EQ(off.at("complete"), 0);
  EXPECT_EQ(off.at("off"), 1);
  EXPECT_NE(bench.dump().find("not installed"), std::string::npos);
}

TEST(BenchPath, MakesItsOwnPathsTheSameEveryTime) {
  const std::vector<std::string> arguments = {"bench",    "path", "--robot",    "ur5e",
                                              "--rounds", "1",    "--no-timing"};
  const auto first = mjarm(arguments);
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_NE(first.out.find("20/20"), std::string::npos) << first.out;
  EXPECT_NE(first.out.find("out_of_reach"), std::string::npos) << first.out;
  EXPECT_EQ(first.out, mjarm(arguments).out);
}

TEST(BenchPath, SaysWhatIsWrong) {
  const support::TempFolder folder;
  const std::string data = write_path_data(folder);
  const auto error = [&] {
    const auto result = mjarm(bench_arm("path", data, {"--tip", "tool"}));
    EXPECT_EQ(result.exit_code, 2) << result.out;
    return only_line(result);
  };
  folder.write("arm_lines.jsonl", R"({"type":"line","from":{"pos":[1,0,0],"quat":[1,0,0,0]},)"
                                  R"("to":{"pos":[1,1,0],"quat":[1,0,0,0]}})");
  EXPECT_NE(error().find("arm_lines.jsonl:1:"), std::string::npos);
  folder.write("arm_lines.jsonl", "{\"type\":");
  EXPECT_NE(error().find("arm_lines.jsonl:1:"), std::string::npos);
  folder.write("arm_lines.jsonl", "\n");
  EXPECT_NE(error().find("arm_lines.jsonl"), std::string::npos);
}

}  // namespace
}  // namespace mjarm::app
