// `mjarm bench plan`, as a user calls it.
#include <gmock/gmock.h>

#include "apps/bench/runs_test.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// Two hinges about z, two links of 1 m, a ball at the end.
constexpr const char* kRobot = R"({"name": "arm", "base": "base", "joints": [
{"name": "j1", "type": "revolute", "parent": "base", "child": "a", "xyz": [0, 0, 0],
 "quat": [1, 0, 0, 0], "axis": [0, 0, 1], "limits": [-3, 3]},
{"name": "j2", "type": "revolute", "parent": "a", "child": "b", "xyz": [1, 0, 0],
 "quat": [1, 0, 0, 0], "axis": [0, 0, 1], "limits": [-3, 3]}],
"joint_names": ["j1", "j2"],
"spheres": [{"link": "b", "center": [1, 0, 0], "radius": 0.05}],
"self_collision_link_pairs": []})";

/// From 45 degrees on one side to as much on the other, past a box that the stretched arm hits.
std::string problem(const std::string& id, const std::string& scene, const std::string& more = "") {
  return R"({"id": ")" + id + R"(", "scene": ")" + scene + R"(", "start": [-0.8, 0],
"goals": [[0.8, 0]], "valid": true, "obstacles": [{"name": "post", "type": "box",
"pos": [2, 0, 0], "quat": [1, 0, 0, 0], "half": [0.2, 0.1, 0.5]}])" +
         more + "}";
}

/// A folder of problems for every set, two scenes.
std::string write_problems(const support::TempFolder& folder, const std::string& problems) {
  const std::string content =
      std::string(R"({"robot": )") + kRobot + R"(, "problems": [)" + problems + "]}";
  folder.write("data/mbm_panda_public.json", content);
  folder.write("data/mbm_ur5_public.json", content);
  return (folder.path() / "data").string();
}
std::string write_problems(const support::TempFolder& folder) {
  return write_problems(
      folder, problem("p0", "one") + "," + problem("p1", "two") + "," + problem("p2", "two"));
}

std::vector<std::string> plan(const support::TempFolder& folder,
                              const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {
      "bench", "plan", "--data", write_problems(folder), "--out", (folder.path() / "out").string()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

/// The answer of a peer about one scene.
std::string answer(const std::string& problems, const std::string& paths,
                   const std::string& more = "") {
  return "\n{\"who\":\"peer\",\"version\":\"1\",\"timed\":\"python\",\"us\":[1e6],\"problems\":[" +
         problems + "],\"paths\":[" + paths + "]" + more + "}\n";
}

TEST(BenchPlan, ProblemsOfEverySceneAreSolvedAndJudged) {
  const support::TempFolder folder;
  const json bench = bench_json(plan(folder, {"--set", "panda", "--no-timing"}));
  for (const auto& [scene, problems] : {std::pair{"one", 1}, {"two", 2}, {"all", 3}}) {
    const json& run = run_of(bench, "mjarm", scene);
    EXPECT_EQ(run.at("problems"), problems);
    EXPECT_EQ(run.at("valid"), problems);
    EXPECT_GT(run.at("cost"), 1.6);  // round the box, not through it
    EXPECT_FALSE(run.contains("us"));
  }
  EXPECT_EQ(json::parse(folder.read("out/bench.json")), bench);
  const json paths = json::parse(folder.read("out/paths_panda_mjarm.json"));
  ASSERT_EQ(paths.size(), 3U);
  EXPECT_EQ(paths.at("p2").at("path").front(), json({-0.8, 0.0}));
  EXPECT_EQ(paths.at("p2").at("path").back(), json({0.8, 0.0}));
  EXPECT_FALSE(paths.at("p2").contains("us"));
  EXPECT_EQ(bench_json(plan(folder, {"--set", "panda", "--no-timing"})), bench);
}

TEST(BenchPlan, PeersAreAskedSceneBySceneAndTheirPathsJudged) {
  const support::TempFolder folder;
  const std::string round = "[[-0.8,0],[-0.8,1.5],[0.8,1.5],[0.8,0]]";
  const std::string through = "[[-0.8,0],[0.8,0]]";
  // The first scene: round the box. The second: one path through it, timed inside as well.
  const std::string peers = write_peers(
      folder, answer("\"p0\"", round),
      "grep -qF '\"every\":7' \"$2\" || exit 3; grep -qF mbm_panda_public.json \"$2\" || exit 4\n"
      "if grep -qF '\"p2\"' \"$2\"; then printf '%s\\n' '" +
          answer("\"p1\"", through, ",\"own\":[3],\"world\":[2]").substr(1, std::string::npos) +
          "' | grep . > \"$3\"; exit 0; fi");
  const json bench =
      bench_json(plan(folder, {"--set", "panda", "--peers", peers, "--peer-every", "7"}));
  EXPECT_EQ(run_of(bench, "peer", "one").at("valid"), 1);
  EXPECT_NEAR(run_of(bench, "peer", "one").at("cost"), 4.6, 1e-9);
  EXPECT_GT(run_of(bench, "peer", "one").at("ratio"), 1.0);
  const json& two = run_of(bench, "peer", "two");
  EXPECT_EQ(two.at("solved"), 1);
  EXPECT_EQ(two.at("valid"), 0);
  ASSERT_EQ(two.at("wrong").size(), 1U);
  EXPECT_EQ(two.at("wrong")[0].at("problem"), "p1");
  EXPECT_EQ(two.at("wrong")[0].at("fault"), "obstacle");
  EXPECT_NEAR(two.at("wrong")[0].at("depth"), 0.05, 1e-12);  // of a ball whose centre is inside
  EXPECT_EQ(two.at("world_us"), 2.0);
  EXPECT_EQ(run_of(bench, "peer, own clock", "two").at("us").at("median"), 3.0);
  EXPECT_EQ(run_of(bench, "peer", "all").at("problems"), 2);
  EXPECT_EQ(json::parse(folder.read("out/paths_panda_peer.json")).size(), 2U);
  EXPECT_TRUE(folder.exists("out/bench_plan.svg"));
  EXPECT_TRUE(folder.exists("out/bench_plan.png"));
}

TEST(BenchPlan, TheJudgeNamesEveryFault) {
  const std::string fold = "[0.8,1.5],[0.8,0]]";
  for (const auto& [path, fault] :
       {std::pair<std::string, std::string>{"[[-0.7,0],[-0.8,1.5]," + fold, "start"},
        {"[[-0.8,0],[-0.8,1.5],[0.8,1.5],[0.7,0]]", "goal"},
        {"[[-0.8,0],[-3.1,0],[-0.8,0],[-0.8,1.5]," + fold, "limits"},
        {"[[-0.8,0],[-0.8]," + fold, "shape"},
        {"[[-0.8,0],[-0.8,1.5],[0.8,1.5],[0.8,0]]", ""}}) {
    const support::TempFolder folder;
    const std::string peers = write_peers(folder, answer("\"p0\"", path),
                                          "grep -qF '\"p0\"' \"$2\" || : > \"$3\"\n"
                                          "grep -qF '\"p0\"' \"$2\" || exit 0");
    const json bench = bench_json(plan(folder, {"--set", "panda", "--peers", peers}));
    const json& wrong = run_of(bench, "peer", "one").at("wrong");
    if (fault.empty()) {
      EXPECT_TRUE(wrong.empty());
    } else {
      ASSERT_EQ(wrong.size(), 1U) << path;
      EXPECT_EQ(wrong[0].at("fault"), fault);
    }
  }
}

TEST(BenchPlan, APeerThatFailsIsToldOnce) {
  const support::TempFolder folder;
  const std::string peers = write_peers(
      folder, "\n{\"who\":\"peer\",\"version\":\"1\",\"error\":\"no code for this arm\"}\n");
  const json bench = bench_json(plan(folder, {"--set", "ur5", "--peers", peers}));
  int told = 0;
  for (const json& run : bench.at("robots")[0].at("runs")) told += run.contains("error") ? 1 : 0;
  EXPECT_EQ(told, 1);
}

TEST(BenchPlan, BrokenAnswersAreOneLine) {
  const std::string path = "[[-0.8,0],[0.8,0]]";
  for (const auto& [broken, reason] : {std::pair{answer("\"p9\"", path), "problems"},
                                       {answer("\"p0\"", path + "," + path), "paths"},
                                       {answer("\"p0\",\"p0\"", path + "," + path), "us"},
                                       {answer("\"p0\"", path, ",\"own\":[1,2]"), "own"},
                                       {answer("\"p0\"", path, ",\"world\":[]"), "world"},
                                       {answer("\"p0\"", "[[0,\"x\"]]"), "paths"}}) {
    const support::TempFolder folder;
    const std::string peers = write_peers(folder, broken);
    const auto result = mjarm(plan(folder, {"--set", "panda", "--peers", peers, "--quiet"}));
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(only_line(result), HasSubstr(reason));
  }
}

TEST(BenchPlan, MoreTimeAndMoreObstacles) {
  const support::TempFolder folder;
  const json anytime = bench_json(plan(folder, {"--set", "anytime"}));
  ASSERT_EQ(anytime.at("robots").size(), 2U);
  EXPECT_LE(run_of(anytime, "mjarm", "10 ms").at("cost"),
            run_of(anytime, "mjarm", "0 ms").at("cost").get<double>() + 1e-9);
  const json crowds = bench_json(plan(folder, {"--set", "scaling"}));
  for (const char* crowd :
       {"boxes: 1", "boxes: 10", "boxes: 100", "boxes: 1000", "points: 1000", "points: 100000"}) {
    const json& run = run_of(crowds, "mjarm", crowd);
    EXPECT_EQ(run.at("solved"), run.at("valid"));
    EXPECT_GT(run.at("check_ns").at("along"), 0.0);
    EXPECT_GT(run.at("check_ns").at("together"), 0.0);
  }
  EXPECT_TRUE(folder.exists("out/bench_plan.svg"));
}

TEST(BenchPlan, SeveralSetsAreAskedForWithCommas) {
  const support::TempFolder folder;
  const json bench = bench_json(plan(folder, {"--set", "ur5,anytime"}));
  std::vector<std::string> names;
  for (const json& robot : bench.at("robots")) names.push_back(robot.at("robot"));
  EXPECT_THAT(names, ::testing::ElementsAre("ur5", "ur5, anytime", "panda, anytime"));
}

TEST(BenchPlan, MissingDataAndWrongOptionsAreOneLine) {
  const support::TempFolder folder;
  const auto missing = mjarm({"bench", "plan", "--data", folder.path().string()});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(only_line(missing), HasSubstr("mbm_panda_public.json"));
  EXPECT_EQ(mjarm({"bench", "plan"}).exit_code, 1);
  const std::string none = write_problems(folder, problem("p0", "one", ", \"valid\": false"));
  const auto empty = mjarm({"bench", "plan", "--data", none});
  EXPECT_EQ(empty.exit_code, 2);
  EXPECT_THAT(only_line(empty), HasSubstr("mbm_panda_public.json"));
  for (const auto& [words, reason] :
       {std::pair{std::vector<std::string>{"--set", "pandas"}, "did you mean \"panda\""},
        {{"--seed", "first"}, "--seed"},
        {{"--peer-every", "0"}, "--peer-every"},
        {{"--set", "anytime", "--no-timing"}, "--no-timing"}}) {
    const auto refused = mjarm(plan(folder, words));
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(only_line(refused), HasSubstr(reason));
  }
}

}  // namespace
}  // namespace mjarm::app
