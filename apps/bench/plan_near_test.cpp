// `mjarm bench plan --set near`, as a user calls it.
#include <gmock/gmock.h>

#include "apps/bench/runs_test.hpp"
#include "tests/support/rounds.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// The first goals of all robots, without Menagerie's.
support::ProgramResult near(const support::TempFolder& folder, const std::string& goals,
                            const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {
      "bench", "plan", "--set", "near", "--goals", goals, "--out", (folder.path() / "out").string(),
      "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return mjarm(arguments, {.environment = {{"MJARM_TEST_DATA", ""}}});
}

json near_json(const support::TempFolder& folder, const std::string& goals,
               const std::vector<std::string>& more) {
  const auto result = near(folder, goals, more);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return json::parse(result.out);
}

const json& near_run(const json& robot, const std::string& who, const std::string& set) {
  for (const json& run : robot.at("runs")) {
    if (run.value("who", "") == who && run.value("set", "") == set) return run;
  }
  throw std::runtime_error("no run of " + who + " on " + set);
}

json our_paths(const support::TempFolder& folder) {
  return json::parse(folder.read("out/paths_ur5e__gripper__near_mjarm.json"));
}

/// Two joint goals of the UR5e with its gripper and a pose; the same of the Panda.
constexpr const char* kFew = "9";

TEST(BenchPlanNear, EveryGoalIsReachedByAPathWithoutContact) {
  const support::TempFolder folder;
  const json bench = near_json(folder, kFew, {"--no-timing"});
  ASSERT_EQ(bench.at("robots").size(), 2U);
  for (const json& robot : bench.at("robots")) {
    for (const auto& [set, count] : {std::pair{"joints", 2}, {"pose", 1}, {"all", 3}}) {
      const json& run = near_run(robot, "mjarm", set);
      EXPECT_EQ(run.at("problems"), count);
      EXPECT_EQ(run.at("valid"), count);
      EXPECT_GT(run.at("cost"), 0.1);
      EXPECT_GT(run.at("motion_s"), 0.1);
      EXPECT_GT(run.at("jerk_limited_motion_s"), run.at("motion_s").get<double>() - 0.02);
      EXPECT_FALSE(run.contains("us"));
    }
    EXPECT_EQ(near_run(robot, "mjarm", "first plan").at("valid"), 3);
  }
  const json paths = our_paths(folder);
  ASSERT_EQ(paths.size(), 3U);
  for (const json& path : paths) {
    EXPECT_EQ(path.at("path").front(), json({-1.5708, -1.5708, 1.5708, -1.5708, -1.5708, 0.0}));
  }
}

TEST(BenchPlanNear, TheSameSeedGivesTheSameProblemsAndAnotherOthers) {
  if (!testing::is_long()) GTEST_SKIP() << testing::kLongOnly;
  const support::TempFolder folder;
  const json bench = near_json(folder, kFew, {"--no-timing"});
  const json paths = our_paths(folder);
  EXPECT_EQ(near_json(folder, kFew, {"--no-timing"}), bench);
  EXPECT_EQ(our_paths(folder), paths);
  (void)near_json(folder, kFew, {"--no-timing", "--seed", "2"});
  EXPECT_NE(our_paths(folder), paths);
}

TEST(BenchPlanNear, TimesAreTold) {
  const support::TempFolder folder;
  const json robot = near_json(folder, "1", {}).at("robots").at(0);
  EXPECT_EQ(robot.at("robot"), "ur5e, gripper, near");
  const json& joints = near_run(robot, "mjarm", "joints");
  EXPECT_GE(joints.at("max_us"), joints.at("us").at("median"));
  const json& first = near_run(robot, "mjarm", "first plan");
  EXPECT_GT(first.at("us").at("median"), first.at("world_us"));
  EXPECT_GT(first.at("world_us"), 0.0);
}

TEST(BenchPlanNear, WithoutMenagerieItsRobotIsLeftOut) {
  const support::TempFolder folder;
  EXPECT_THAT(near(folder, "1", {"--no-timing"}).err, HasSubstr("franka_emika_panda.tar.xz"));
}

TEST(BenchPlanNear, MenageriesPandaIsReadFromItsArchive) {
  MJARM_TEST_FILE(archive, "menagerie/franka_emika_panda.tar.xz");
  const support::TempFolder folder;
  const std::string data = archive.parent_path().string();
  const json bench = near_json(folder, "3", {"--no-timing", "--data", data});
  ASSERT_EQ(bench.at("robots").size(), 3U);
  EXPECT_EQ(bench.at("robots").at(2).at("robot"), "panda, Menagerie, near");
  EXPECT_EQ(near_run(bench.at("robots").at(2), "mjarm", "all").at("valid"), 1);
}

/// What the judge says of a peer's path for the first goal of the UR5e.
json judged(const support::TempFolder& folder, const json& path) {
  const json answer = {{"who", "peer"},     {"version", "1"}, {"set", "joints"},
                       {"timed", "python"}, {"us", {1e6}},    {"problems", {"table 1, 1"}},
                       {"paths", {path}},   {"motions", {10}}};
  const std::string peers = write_peers(folder, "\n" + answer.dump() + "\n",
                                        "grep -qF ur5e_gripper.xml \"$2\" || exit 3\n"
                                        "grep -qF '\"acceleration\":[5' \"$2\" || exit 5\n"
                                        "grep -qF '\"every\":7' \"$2\" || exit 4");
  const json bench = near_json(folder, "1", {"--peers", peers, "--peer-every", "7"});
  return near_run(bench.at("robots").at(0), "peer", "joints");
}

TEST(BenchPlanNear, TheJudgeNamesEveryFault) {
  const support::TempFolder folder;
  const json ours =
      near_run(near_json(folder, "1", {"--no-timing"}).at("robots").at(0), "mjarm", "joints");
  const json path = our_paths(folder).at("table 1, 1").at("path");
  const json same = judged(folder, path);
  EXPECT_EQ(same.at("valid"), 1);
  EXPECT_EQ(same.at("motion_s"), 10);
  const auto expect_ratio = [&](const char* ratio, const char* seconds) {
    EXPECT_EQ(same.at(ratio).at("problems"), 1);
    EXPECT_NEAR(same.at(ratio).at("max"), ours.at(seconds).get<double>() / 10, 1e-9);
    EXPECT_EQ(same.at(ratio).at("mean"), same.at(ratio).at("max"));
  };
  expect_ratio("motion_ratio", "motion_s");
  expect_ratio("jerk_limited_motion_ratio", "jerk_limited_motion_s");
  const auto via = [&](std::size_t joint, double value) {
    json bent = path, q = path.front();
    q[joint] = value;
    bent.insert(bent.begin() + 1, {q, path.front()});
    return bent;
  };
  json late = path, early = path, shorter = path;
  late.front()[0] = -1.5;
  early.back()[5] = path.back()[5].get<double>() + 0.001;
  shorter.back().erase(5);
  for (const auto& [bent, fault] : {std::pair<json, std::string>{via(1, 0.6), "obstacle"},
                                    {via(2, -3.1), "self"},
                                    {via(5, 6.29), "limits"},
                                    {late, "start"},
                                    {early, "goal"},
                                    {shorter, "shape"}}) {
    const json run = judged(folder, bent);
    EXPECT_EQ(run.at("valid"), 0) << fault;
    EXPECT_FALSE(run.contains("motion_ratio")) << "beside a path that is no path";
    ASSERT_EQ(run.at("wrong").size(), 1U) << fault;
    EXPECT_EQ(run.at("wrong")[0].at("fault"), fault);
    const bool touches = fault == "obstacle" || fault == "self";
    EXPECT_EQ(run.at("wrong")[0].at("depth") > 0.005, touches) << fault;
  }
}

TEST(BenchPlanNear, APeerThatFailsIsTold) {
  const support::TempFolder folder;
  const std::string peers = write_peers(
      folder,
      "\n{\"who\":\"one\",\"version\":\"1\",\"set\":\"pose\",\"error\":\"no inverse kinematics\"}\n"
      "{\"who\":\"two\",\"version\":\"?\",\"error\":\"not installed\"}\n");
  const json robot = near_json(folder, "1", {"--peers", peers}).at("robots").at(0);
  EXPECT_EQ(near_run(robot, "one", "pose").at("error"), "no inverse kinematics");
  EXPECT_EQ(near_run(robot, "two", "").at("error"), "not installed");
}

TEST(BenchPlanNear, BrokenAnswersAreOneLine) {
  for (const auto& [broken, reason] :
       {std::pair<std::string, std::string>{R"("set":"lines","us":[1],"problems":["table 1, 1"])",
                                            "set"},
        {R"("set":"pose","us":[1],"problems":["none"])", "problems"},
        {R"("set":"pose","us":[1],"problems":[7])", "problems"},
        {R"("set":"pose","us":[1,2],"problems":["table 1, 1"])", "us"},
        {R"("set":"pose","us":[1],"problems":["table 1, 1"],"world":[])", "world"},
        {R"("set":"pose","us":[1],"problems":["table 1, 1"],"motions":[1,2])", "motions"}}) {
    const support::TempFolder folder;
    const std::string peers =
        write_peers(folder, "\n{\"who\":\"peer\",\"version\":\"1\",\"timed\":\"python\"," + broken +
                                ",\"paths\":[null]}\n");
    const auto result = near(folder, "1", {"--peers", peers, "--quiet"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.err, HasSubstr(reason));
  }
}

TEST(BenchPlanNear, WrongOptionsAreOneLine) {
  const support::TempFolder folder;
  const auto refused = near(folder, "0", {});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(only_line(refused), HasSubstr("--goals"));
  const auto unknown = mjarm({"bench", "plan", "--set", "near,nearer"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(only_line(unknown), HasSubstr("nearer"));
}

}  // namespace
}  // namespace mjarm::app
