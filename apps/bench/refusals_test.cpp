// What each suite refuses: wrong words, folders and files that are not what they should be, peers
// that are half there.
#include <gmock/gmock.h>

#include <filesystem>

#include "apps/bench/runs_test.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kPose = R"({"pos":[2,0,0],"quat":[1,0,0,0]})";

/// The one line of a run that has to end with this exit code.
std::string refusal(const std::vector<std::string>& arguments, int code = 2) {
  const auto result = mjarm(arguments);
  EXPECT_EQ(result.exit_code, code) << result.out << result.err;
  EXPECT_EQ(result.out, "");
  return only_line(result);
}

TEST(BenchRefuses, WordsThatNoSuiteKnows) {
  for (const auto& [words, reason] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"bench"}, "ik, path, plan, time, control, pick, sim, rl"},
           {{"bench", "ik", "path"}, "\"path\" is not expected"},
           {{"bench", "ik", "--robots", "ur5e"}, "did you mean \"--robot\"?"},
           {{"bench", "ik", "--peers"}, "--peers"},
           {{"bench", "path", "--poses", "3"}, "--poses"},
           {{"bench", "time", "--tip", "tool"}, "unknown option --tip"},
           {{"bench", "control", "--data", "."}, "unknown option --data"},
           {{"bench", "sim", "--peers", "."}, "unknown option --peers"},
           {{"bench", "rl", "--data", "."}, "unknown option --data"},
           {{"bench", "plan", "--robot", "panda"}, "unknown option --robot"}}) {
    EXPECT_THAT(refusal(words), HasSubstr(reason));
  }
}

TEST(BenchRefuses, NumbersBeyondTheirBounds) {
  for (const auto& [suite, option, max, none] :
       {std::tuple{"ik", "--rounds", "10000", ""},
        {"time", "--rounds", "10000", "1.5"},
        {"sim", "--rounds", "1000000", "1e3"},
        {"control", "--poses", "100000", "0x10"},
        {"rl", "--seeds", "100", "５"},
        {"plan", "--peer-every", "1000", "18446744073709551616"}}) {
    const std::string beyond = std::string(max) + "0";
    EXPECT_EQ(refusal({"bench", suite, option, beyond}),
              std::string(option) + " must be a whole number from 1 to " + max + ", not " + beyond);
    EXPECT_EQ(refusal({"bench", suite, option, none}),
              std::string(option) + ": \"" + none + "\" is not a whole number >= 0");
  }
}

TEST(BenchRefuses, RobotsThatAreNotThere) {
  for (const char* suite : {"ik", "path", "time", "control", "sim"}) {
    EXPECT_THAT(refusal({"bench", suite, "--robot", "ur6e"}),
                AllOf(HasSubstr("\"ur6e\""), HasSubstr("ur5e")));
  }
  for (const char* suite : {"ik", "path", "control", "sim"}) {
    EXPECT_THAT(refusal({"bench", suite, "--robot", "ur5e", "--tip", "hand"}), HasSubstr("hand"));
  }
}

/// A third line of cases, after a good one and a blank one.
TEST(BenchRefuses, BrokenPosesByFileLineAndMember) {
  const support::TempFolder folder;
  write_planar_arm(folder);
  for (const auto& [line, reason] :
       {std::pair{R"({"pos":[1,0,0],"quat":[1,0,0)", "not valid JSON"},
        {R"({"pos":[NaN,0,0],"quat":[1,0,0,0]})", "not valid JSON"},
        {R"({"pos":[1e999,0,0],"quat":[1,0,0,0]})", "range"},
        {R"([[1,0,0],[1,0,0,0]])", "object"},
        {R"({"quat":[1,0,0,0]})", "\"pos\""},
        {R"({"pos":[1,0,0]})", "\"quat\""},
        {R"({"pos":[1,0],"quat":[1,0,0,0]})", "3 numbers, it has 2"},
        {R"({"pos":[1,0,"0"],"quat":[1,0,0,0]})", "\"pos\""},
        {R"({"pos":[1,0,0],"quat":[0,0,0,0]})", "quat"},
        {R"({"pos":[1,0,0],"quat":[1,0,0,0],"seed":[0]})",
         "\"seed\" must have 2 numbers, it has 1"},
        {R"({"pos":[1,0,0],"quat":[1,0,0,0],"seed":null})", "\"seed\""}}) {
    folder.write("arm_reachable.jsonl", std::string(kPose) + "\r\n\n" + line + "\n");
    EXPECT_THAT(refusal(bench_arm("ik", folder.path().string(), {"--tip", "tool"})),
                AllOf(HasSubstr("arm_reachable.jsonl:3: "), HasSubstr(reason)));
  }
}

TEST(BenchRefuses, BrokenPathsByFileLineAndMember) {
  const support::TempFolder folder;
  write_planar_arm(folder);
  const std::string good = R"({"type":"poses","poses":[)" + std::string(kPose) + "]}\n";
  for (const auto& [line, reason] : {std::pair{R"({"type":"poses","poses":[)", "not valid JSON"},
                                     {R"({"type":"poses","poses":[]})", "\"poses\""},
                                     {R"({"type":"poses","poses":[{"pos":[1,0,0]}]})", "quat"},
                                     {R"({"type":"spiral"})", "spiral"},
                                     {R"({"poses":[]})", "type"},
                                     {R"({"type":"line","from":{"pos":[1,0,0],"quat":[1,0,0,0]},)"
                                      R"("to":{"pos":[1,1,0],"quat":[1,0,0,0]}})",
                                      "a path of given poses is needed here"}}) {
    folder.write("arm_ellipse_far.jsonl", good + line);
    EXPECT_THAT(refusal(bench_arm("path", folder.path().string(), {"--tip", "tool"})),
                AllOf(HasSubstr("arm_ellipse_far.jsonl:2: "), HasSubstr(reason)));
  }
}

TEST(BenchRefuses, BrokenMotionsByFileCaseAndMember) {
  const support::TempFolder folder;
  const std::string limits = R"("limits":{"v":[1,1],"a":[1,1],"j":[1,1]})";
  for (const auto& [content, reason] :
       {std::pair{std::string("{") + limits, "not valid JSON"},
        {std::string("{") + limits + "}", "cases"},
        {std::string("[]"), "object"},
        {std::string(R"({"cases":[]})"), "limits"},
        {std::string("{") + limits + R"(,"cases":[]})", "no cases in it"},
        {std::string("{") + limits + R"(,"cases":[{"id":0,"q0":[0,0],"q1":[1]}]})",
         "cases[0]: \"q1\" must have 2 numbers, it has 1"},
        {std::string(R"({"limits":{"v":[1,1],"a":[1],"j":[1,1]},"cases":[]})"), "a"}}) {
    folder.write("arm_p2p.json", content);
    EXPECT_THAT(refusal(bench_arm("time", folder.path().string(), {})),
                AllOf(HasSubstr("arm_p2p.json: "), HasSubstr(reason)));
  }
}

TEST(BenchRefuses, FoldersOfDataThatAreNone) {
  const support::TempFolder folder;
  write_planar_arm(folder);
  const std::string file = folder.write("file", "x").string();
  const std::string empty = (folder.path() / "empty").string();
  std::filesystem::create_directory(empty);
  for (const std::string& data : {empty, file, empty + "/无"}) {
    EXPECT_THAT(refusal(bench_arm("ik", data, {})), HasSubstr("arm.urdf"));
    EXPECT_THAT(refusal(bench_arm("path", data, {})), HasSubstr("arm.urdf"));
    EXPECT_THAT(refusal(bench_arm("time", data, {})), HasSubstr("arm_p2p.json"));
    EXPECT_THAT(refusal({"bench", "plan", "--data", data, "--set", "ur5"}, 1),
                AllOf(HasSubstr("mbm_ur5_public.json.gz"), HasSubstr("\"" + data + "\"")));
  }
  // The robot alone: nothing to solve.
  EXPECT_THAT(refusal(bench_arm("ik", folder.path().string(), {"--tip", "tool"})),
              HasSubstr("arm_reachable.jsonl: no such file"));
}

TEST(BenchRefuses, NothingIsMadeUpForFilesThatMayBeMissing) {
  const support::TempFolder folder;
  write_planar_arm(folder);
  folder.write("arm_reachable.jsonl", kPose);
  folder.write("arm_hard_negatives.jsonl", kPose);
  const std::string data = folder.path().string();
  const auto sets_of = [](const json& bench) {
    std::vector<std::string> sets;
    for (const json& run : bench.at("robots").at(0).at("runs")) {
      if (run.at("who") == "mjarm") sets.push_back(run.at("set"));
    }
    return sets;
  };
  EXPECT_THAT(
      sets_of(bench_json(bench_arm("ik", data, {"--tip", "tool", "--rounds", "1"}))),
      ::testing::ElementsAre("reachable", "hard_negatives", "path", "track", "fk_jacobian"));
  folder.write("arm_p2p.json", R"({"limits":{"v":[1],"a":[1],"j":[1]},"cases":[)"
                               R"({"id":"x","q0":[0],"q1":[1],"v1":[0.5]}]})");
  // The states near the ends of ranges come from no file.
  EXPECT_THAT(sets_of(bench_json(bench_arm("time", data, {"--rounds", "1"}))),
              ::testing::ElementsAre("state", "range"));
}

TEST(BenchRefuses, PeersThatAreHalfInstalled) {
  const support::TempFolder folder;
  write_planar_arm(folder);
  folder.write("arm_reachable.jsonl", kPose);
  const std::string venv = (folder.path() / "venv").string();
  const auto line = [&](int code) {
    return refusal(bench_arm("ik", folder.path().string(),
                             {"--tip", "tool", "--rounds", "1", "--quiet", "--peers", venv}),
                   code);
  };
  const std::string missing = "--peers: no Python environment: " + venv + "/bin/python is missing";
  EXPECT_EQ(line(2), missing);
  std::filesystem::create_directories(venv + "/bin");
  EXPECT_EQ(line(2), missing);
  std::filesystem::create_symlink("/no/such/python", venv + "/bin/python");
  EXPECT_EQ(line(2), missing);
  std::filesystem::remove(venv + "/bin/python");
  std::filesystem::create_directory(venv + "/bin/python");
  EXPECT_THAT(line(1), HasSubstr(venv + "/bin/python"));
  std::filesystem::remove(venv + "/bin/python");
  folder.write("venv/bin/python", "#!/bin/sh\n");  // nobody may run it
  EXPECT_THAT(line(1), HasSubstr(venv + "/bin/python"));
  (void)write_peers(folder, "", "kill -9 $$");
  EXPECT_THAT(line(1), HasSubstr("137"));
}

TEST(BenchRefuses, PeersWithoutAPythonInEverySuiteOfRobots) {
  const support::TempFolder folder;
  write_planar_arm(folder);
  folder.write("arm_lines.jsonl", R"({"type":"poses","poses":[)" + std::string(kPose) + "]}\n");
  folder.write("arm_p2p.json", R"({"limits":{"v":[1],"a":[1],"j":[1]},"cases":[)"
                               R"({"id":0,"q0":[0],"q1":[1]}]})");
  for (const char* suite : {"path", "time"}) {
    std::vector<std::string> more = {"--rounds", "1", "--quiet", "--peers", "/no/venv"};
    if (std::string(suite) == "path") more.insert(more.end(), {"--tip", "tool"});
    EXPECT_THAT(refusal(bench_arm(suite, folder.path().string(), more)),
                HasSubstr("/no/venv/bin/python is missing"));
  }
}

TEST(BenchRefuses, PeersThatAreNotThereBeforeAnythingIsMeasured) {
  const support::TempFolder folder;
  const std::string out = (folder.path() / "out").string();
  for (const char* suite : {"ik", "path", "time"}) {  // not even the cases are looked for
    EXPECT_THAT(refusal({"bench", suite, "--data", "/no/data", "--peers", "/no/venv"}),
                HasSubstr("/no/venv/bin/python is missing"));
  }
  for (const char* suite : {"plan", "rl"}) {
    EXPECT_THAT(refusal({"bench", suite, "--peers", "/no/venv", "--out", out}),
                HasSubstr("/no/venv/bin/python is missing"));
    EXPECT_FALSE(std::filesystem::exists(out)) << suite;
  }
}

TEST(BenchRefuses, PeersForARobotThatTheyCannotRead) {
  const support::TempFolder folder;
  const std::string peers = write_peers(folder, "\n{\"who\":\"never asked\"}\n");
  for (const char* suite : {"ik", "path"}) {
    EXPECT_THAT(refusal({"bench", suite, "--robot", model_file("universal_robots_ur5e/ur5e.xml"),
                         "--rounds", "1", "--quiet", "--peers", peers}),
                HasSubstr("ur5e.xml: the peers read URDF only"));
  }
}

TEST(BenchRefuses, BrokenAnswersByMember) {
  const support::TempFolder folder;
  write_planar_arm(folder);
  folder.write("arm_reachable.jsonl", kPose);
  folder.write("arm_lines.jsonl", R"({"type":"poses","poses":[)" + std::string(kPose) + "]}\n");
  folder.write("arm_p2p.json", R"({"limits":{"v":[1],"a":[1],"j":[1]},"cases":[)"
                               R"({"id":0,"q0":[0],"q1":[1]}]})");
  const std::string rest = R"({"who":"x","version":"1","set":"rest","us":[1])";
  for (const auto& [suite, answer, member] : std::vector<std::array<std::string, 3>>{
           {"ik", "[]", "object"},
           {"ik", R"({"version":"1"})", ": who"},
           {"ik", R"({"who":7})", ": who"},
           {"ik", R"({"who":"x","version":2})", ": version"},
           {"ik", R"({"who":"x","error":null})", ": error"},
           {"ik", R"({"who":"x","us":5})", ": us"},
           {"ik", R"({"who":"x","us":[1,null]})", ": us"},
           {"ik", R"({"who":"x","set":"reachable","q":"none"})", ": q"},
           {"ik", R"({"who":"x","set":"reachable","q":[[0,"1"]]})", ": q"},
           {"path", R"({"who":"x","set":"lines","q":[[0,1]]})", ": q"},
           {"path", R"({"who":"x","set":"lines","q":[[[0,1],7]]})", ": q"},
           {"time", R"({"who":"x","set":"nap"})", ": nap"},
           {"time", rest + "}", ": states"},
           {"time", rest + R"(,"states":"/no/such.f64"})", "/no/such.f64"},
           {"time", rest + R"(,"states":"/dev/null"})", ": durations"},
           {"time", rest + R"(,"states":"/dev/null","durations":["1"]})", ": durations"},
           {"time", rest + R"(,"states":"/dev/null","durations":[1]})", ": /dev/null"}}) {
    const std::string peers = write_peers(folder, "\n" + answer + "\n");
    std::vector<std::string> more = {"--rounds", "1", "--quiet", "--peers", peers};
    if (suite != "time") more.insert(more.end(), {"--tip", "tool"});
    const auto result = mjarm(bench_arm(suite, folder.path().string(), more));
    EXPECT_NE(result.exit_code, 0) << answer;
    EXPECT_EQ(result.out, "") << answer;
    EXPECT_THAT(only_line(result), HasSubstr(member)) << answer;
  }
}

TEST(BenchRefuses, PlacesThatCannotBeWritten) {
  const support::TempFolder folder;
  write_planar_arm(folder);
  folder.write("arm_reachable.jsonl", kPose);
  folder.write("file", "kept");
  const auto into = [&](const std::string& out, int code = 1) {
    return refusal(
        bench_arm("ik", folder.path().string(), {"--tip", "tool", "--rounds", "1", "--out", out}),
        code);
  };
  EXPECT_THAT(into((folder.path() / "no" / "table.md").string()), HasSubstr("table.md"));
  EXPECT_THAT(into((folder.path() / "file" / "table.md").string()), HasSubstr("table.md"));
  EXPECT_THAT(into(folder.path().string(), 2), HasSubstr("is a folder, a file is needed"));
  EXPECT_EQ(folder.read("file"), "kept");
  EXPECT_THAT(refusal({"bench", "rl", "--set", "tutorial", "--seeds", "1", "--steps", "1024",
                       "--quiet", "--out", (folder.path() / "file").string()},
                      1),
              AllOf(HasSubstr("file"), Not(HasSubstr("bench.json"))));
}

}  // namespace
}  // namespace mjarm::app
