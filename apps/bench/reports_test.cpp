// What the suites write: tables and JSON that say the same, in files as on standard output, the
// same bytes every time where no clock is told; pictures that are pictures.
#include <gmock/gmock.h>
#include <sched.h>
#include <tinyxml2.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "apps/bench/runs_test.hpp"
#include "mjarm/core/text_width.hpp"
#include "tests/support/rounds.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

using Rows = std::vector<std::vector<std::string>>;

std::string trimmed(const std::string& cell) {
  const auto from = cell.find_first_not_of(' '), to = cell.find_last_not_of(' ');
  return from == std::string::npos ? "" : cell.substr(from, to - from + 1);
}

/// The rows of all tables in a Markdown text, headings among them; checks that they are tables.
Rows rows_of(const std::string& markdown) {
  Rows rows;
  int width = 0;  // of the lines of one table
  for (const std::string& line : support::lines_of(markdown)) {
    if (!line.starts_with("|")) {
      width = 0;
      continue;
    }
    EXPECT_TRUE(line.ends_with("|")) << line;
    if (width != 0) {
      EXPECT_EQ(text_width(line), width) << markdown;
    }
    width = text_width(line);
    if (line.starts_with("|--")) continue;
    std::vector<std::string>& row = rows.emplace_back();
    std::size_t from = 1;
    for (std::size_t to = line.find('|', from); to != std::string::npos;
         from = to + 1, to = line.find('|', from)) {
      row.push_back(trimmed(line.substr(from, to - from)));
    }
  }
  return rows;
}

/// Cases of a planar arm for ik, path and time, and a problem for plan; peers that answer for ik.
struct Data {
  support::TempFolder folder;
  std::string peers;

  Data() {
    write_planar_arm(folder);
    folder.write("arm_reachable.jsonl", R"({"pos":[2,0,0],"quat":[1,0,0,0]})"
                                        "\n"
                                        R"({"pos":[3,0,0],"quat":[1,0,0,0]})");
    folder.write("arm_lines.jsonl", R"({"type":"poses","poses":[{"pos":[2,0,0],"quat":[1,0,0,0]},)"
                                    R"({"pos":[3,0,0],"quat":[1,0,0,0]}]})");
    folder.write("arm_p2p.json", R"({"limits":{"v":[1],"a":[1],"j":[1]},"cases":[)"
                                 R"({"id":"一","q0":[0],"q1":[1]}]})");
    folder.write("mbm_ur5_public.json", R"({"robot": {"name": "arm", "base": "base", "joints": [
{"name": "j1", "type": "revolute", "parent": "base", "child": "a", "xyz": [0, 0, 0],
 "quat": [1, 0, 0, 0], "axis": [0, 0, 1], "limits": [-3, 3]}], "joint_names": ["j1"],
"spheres": [{"link": "a", "center": [1, 0, 0], "radius": 0.05}], "self_collision_link_pairs": []},
"problems": [{"id": "p", "scene": "one", "start": [0], "goals": [[1]], "valid": true,
"obstacles": [{"name": "b", "type": "sphere", "pos": [-1, 0, 0], "radius": 0.1}]}]})");
    peers = write_peers(folder, R"(
{"who":"peer","version":"1","set":"reachable","timed":"python","us":[5,7],"q":[[0,0]]}
{"who":"gone","version":"?","error":"not \"here\" | at all"}
)");
  }

  [[nodiscard]] std::vector<std::string> ik(const std::vector<std::string>& more) const {
    std::vector<std::string> all = {"--tip", "tool", "--rounds", "1", "--quiet"};
    all.insert(all.end(), more.begin(), more.end());
    return bench_arm("ik", folder.path().string(), all);
  }
  [[nodiscard]] std::vector<std::string> plan(const std::vector<std::string>& more) const {
    std::vector<std::string> all = {
        "bench", "plan", "--set", "ur5", "--data", folder.path().string(), "--quiet"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
};

std::string content_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(BenchReports, AFileHoldsWhatWouldBePrinted) {
  const Data data;
  const std::string file = data.folder.write("answer", "older and much longer\n").string();
  for (const char* format : {"--json", "--no-timing"}) {
    const auto printed = mjarm(data.ik({"--no-timing", format, "--peers", data.peers}));
    const auto written =
        mjarm(data.ik({"--no-timing", format, "--peers", data.peers, "--out", file}));
    EXPECT_EQ(printed.exit_code, 0) << printed.err;
    EXPECT_EQ(written.exit_code, 0) << written.err;
    EXPECT_EQ(written.out, "");
    EXPECT_EQ(data.folder.read("answer"), printed.out);
    EXPECT_TRUE(printed.out.ends_with("\n"));
  }
}

TEST(BenchReports, TablesAndJsonSayTheSameInBothLanguages) {
  const Data data;
  const std::vector<std::string> words = {"--no-timing", "--peers", data.peers};
  const Rows english = rows_of(mjarm(data.ik(words)).out);
  std::vector<std::string> in_chinese = data.ik(words);
  in_chinese.insert(in_chinese.end(), {"--lang", "zh-CN"});
  const Rows chinese = rows_of(mjarm(in_chinese).out);
  const json bench = bench_json(data.ik(words));
  const json& runs = bench.at("robots").at(0).at("runs");
  ASSERT_EQ(english.size(), runs.size() + 1);
  ASSERT_EQ(chinese.size(), english.size());
  EXPECT_NE(chinese[0], english[0]);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const std::vector<std::string>& row = english[i + 1];
    EXPECT_EQ(chinese[i + 1][0], row[0]);
    EXPECT_EQ(row[0], runs[i].value("set", "-"));
    EXPECT_THAT(row[1], StartsWith(runs[i].at("who").get<std::string>()));
    if (!runs[i].contains("right")) continue;
    const double share = 100.0 * runs[i].at("right").get<double>() / runs[i].at("cases").get<int>();
    EXPECT_NEAR(std::stod(row[2]), share, 0.05) << row[0] << row[1];
  }
  EXPECT_EQ(run_of(bench, "mjarm", "reachable").at("right"), 1);
  EXPECT_THAT(chinese[5][2], Not(HasSubstr("first")));
}

TEST(BenchReports, JsonKeepsEveryCharacterOfWhatPeersSay) {
  const Data data;
  const json bench = bench_json(data.ik({"--no-timing", "--peers", data.peers}));
  EXPECT_EQ(bench.at("robots")[0].at("runs").back().at("error"), "not \"here\" | at all");
  EXPECT_EQ(json::parse(bench.dump()), bench);
  const json time = bench_json(bench_arm("time", data.folder.path().string(), {"--rounds", "1"}));
  EXPECT_EQ(run_of(time, "mjarm", "rest").at("cases"), 1);
}

/// All names of members in a document, however deep.
void collect_keys(const json& value, std::vector<std::string>& keys) {
  for (const auto& [key, member] : value.items()) {
    if (value.is_object()) keys.push_back(key);
    if (member.is_structured()) collect_keys(member, keys);
  }
}

TEST(BenchReports, WithoutTimingNothingTellsTheClock) {
  const Data data;
  const std::string folder = data.folder.path().string();
  const std::string out = (data.folder.path() / "out").string();
  const std::vector<std::vector<std::string>> suites = {
      data.ik({}),
      bench_arm("path", folder, {"--tip", "tool", "--rounds", "1"}),
      bench_arm("time", folder, {"--rounds", "1"}),
      data.plan({"--out", out}),
      {"bench", "sim", "--rounds", "1", "--steps", "5"},
      {"bench", "control", "--poses", "1"}};
  const std::vector<std::string> clocks = {"us",   "machine", "ratio",  "timed",    "rtf",
                                           "rate", "seconds", "p95_us", "check_ns", "world_us"};
  for (std::vector<std::string> words : suites) {
    const std::string suite = words[1];
    words.emplace_back("--no-timing");
    std::vector<std::string> keys;
    collect_keys(bench_json(words), keys);
    ASSERT_GT(keys.size(), 5u) << suite;
    for (const std::string& clock : clocks) {
      // How long a lap of `control` takes is asked for, not measured.
      if (suite == "control" && clock == "seconds") continue;
      EXPECT_EQ(std::ranges::count(keys, clock), 0) << suite << ": " << clock;
    }
  }
}

TEST(BenchReports, WithTimingTheMachineAndTheDayStandAbove) {
  const Data data;
  const json bench = bench_json(data.ik({}));
  const std::string machine = bench.at("machine");
  EXPECT_THAT(machine, ::testing::MatchesRegex(".*; 2[0-9]{3}-[01][0-9]-[0-3][0-9]"));
  const auto lines = support::lines_of(mjarm(data.ik({})).out);
  ASSERT_FALSE(lines.empty());
  EXPECT_EQ(lines.front(), machine);
}

/// This process and all that it starts have one core for as long as this stands.
class OneCore {
 public:
  OneCore() {
    EXPECT_EQ(sched_getaffinity(0, sizeof before_, &before_), 0);
    cpu_set_t one;
    CPU_ZERO(&one);
    for (int core = 0; core < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++core) {
      if (CPU_ISSET(core, &before_)) CPU_SET(core, &one);
    }
    EXPECT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
  }
  ~OneCore() { sched_setaffinity(0, sizeof before_, &before_); }
  OneCore(const OneCore&) = delete;
  OneCore& operator=(const OneCore&) = delete;

 private:
  cpu_set_t before_;
};

TEST(BenchReports, TheSameBytesForAnyNumberOfThreadsAndAgain) {
  if (!testing::is_long()) GTEST_SKIP() << testing::kLongOnly;
  const Data data;
  const auto plan = [&](const char* out) {
    const auto folder = (data.folder.path() / out).string();
    return mjarm(data.plan({"--no-timing", "--seed", "7", "--out", folder})).out;
  };
  const auto learn = [&](const char* out) {
    return mjarm({"bench", "rl", "--set", "tutorial", "--seeds", "1", "--steps", "1024", "--quiet",
                  "--no-timing", "--out", (data.folder.path() / out).string()})
        .out;
  };
  const std::string ik = mjarm(data.ik({"--no-timing"})).out;
  const std::string planned = plan("plan"), learned = learn("rl");
  const OneCore one;
  EXPECT_EQ(mjarm(data.ik({"--no-timing"})).out, ik);
  EXPECT_EQ(plan("plan_one"), planned);
  EXPECT_EQ(learn("rl_one"), learned);
  for (const char* file : {"bench.json", "paths_ur5_mjarm.json"}) {
    const std::string bytes = data.folder.read("plan/" + std::string(file));
    EXPECT_GT(bytes.size(), 20u);
    EXPECT_EQ(data.folder.read("plan_one/" + std::string(file)), bytes);
  }
  EXPECT_EQ(data.folder.read("rl_one/bench.json"), data.folder.read("rl/bench.json"));
  EXPECT_EQ(plan("plan"), planned) << "into the same folder again";
}

TEST(BenchReports, WorkThatWasStoppedWritesNoReport) {
  const support::TempFolder folder;
  // Told to stop as soon as the training has begun.
  const std::string script =
      "\"$@\" & until [ -d out/tutorial-1 ]; do kill -0 $! || exit 9; sleep 0.02; done\n"
      "kill -TERM $!; wait $!";
  const auto result = support::run_program("/bin/sh",
                                           {"-c", script, "sh", MJARM_PROGRAM, "bench", "rl",
                                            "--set", "tutorial", "--quiet", "--out", "out"},
                                           {.folder = folder.path()});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(only_line(result), "stopped by the user");
  EXPECT_EQ(result.out, "");
  EXPECT_FALSE(folder.exists("out/bench.json"));
  EXPECT_FALSE(folder.exists("out/curves.svg"));
}

TEST(BenchReports, PicturesAreWholeAndOfThoseWhoAreInTheTable) {
  const Data data;
  const std::string peers =
      write_peers(data.folder,
                  "\n{\"who\":\"peer & <co>\",\"version\":\"1\",\"timed\":\"c++\",\"us\":[1e6],"
                  "\"problems\":[\"p\"],\"paths\":[[[0],[1]]]}\n");
  const auto out = data.folder.path() / "out";
  const auto result = mjarm(data.plan({"--out", out.string(), "--peers", peers}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::string svg = content_of(out / "bench_plan.svg");
  tinyxml2::XMLDocument picture;
  ASSERT_EQ(picture.Parse(svg.c_str(), svg.size()), tinyxml2::XML_SUCCESS);
  EXPECT_STREQ(picture.RootElement()->Name(), "svg");
  const std::string png = content_of(out / "bench_plan.png");
  EXPECT_THAT(png, StartsWith("\x89PNG\r\n\x1a\n"));
  EXPECT_NE(png.find("IEND"), std::string::npos);
  const json bench = json::parse(content_of(out / "bench.json"));
  EXPECT_EQ(run_of(bench, "peer & <co>", "one").at("valid"), 1);
  EXPECT_TRUE(std::filesystem::exists(out / "paths_ur5_peer____co_.json"));
}

TEST(BenchReports, WhatAnEarlierRunLeftBehindIsReplaced) {
  const Data data;
  const auto out = data.folder.path() / "out";
  data.folder.write("out/bench.json", "{\"half\":");
  data.folder.write("out/paths_ur5_mjarm.json", std::string(100'000, ' '));
  data.folder.write("out/kept.txt", "mine");
  ASSERT_EQ(mjarm(data.plan({"--no-timing", "--out", out.string()})).exit_code, 0);
  EXPECT_TRUE(json::parse(content_of(out / "bench.json")).contains("robots"));
  const json paths = json::parse(content_of(out / "paths_ur5_mjarm.json"));
  EXPECT_EQ(paths.at("p").at("path").front(), json({0.0}));
  EXPECT_EQ(data.folder.read("out/kept.txt"), "mine");
  EXPECT_FALSE(std::filesystem::exists(out / "bench_plan.png")) << "no times, no picture of them";
}

}  // namespace
}  // namespace mjarm::app
