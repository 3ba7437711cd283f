#include <cmath>
#include <numbers>
#include <set>

#include "apps/mjarm/commands/oracle_test.hpp"
#include "apps/mjarm/commands/program_test.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;

const std::vector<std::string> kTutorialPose = {"--pos", "-0.13,0.6,0.1", "--euler", "3.14,0,1.57"};

/// Poses that the arm can reach, each made by MuJoCo from random joint values.
std::string reachable_poses(int count) {
  Oracle oracle(kUr5eScene, "attachment_site");
  Rng rng(11);
  std::string lines;
  for (int i = 0; i < count; ++i) {
    std::vector<double> q(6);
    for (double& value : q) value = rng.uniform(-3.1, 3.1);
    const Pose X = oracle.fk(q);
    const Quat r = to_quat(X.R);
    lines += json({{"pos", {X.p.x(), X.p.y(), X.p.z()}}, {"quat", {r.w(), r.x(), r.y(), r.z()}}})
                 .dump() +
             "\n";
  }
  return lines;
}

TEST(Ik, OneRequest) {
  const auto result = ik({"--robot", "ur5e"}, kTutorialPose);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  const auto answers = json_lines(result.out);
  ASSERT_EQ(answers.size(), 1u);
  const json& answer = answers[0];
  EXPECT_EQ(answer.at("ok"), true);
  EXPECT_GE(answer.at("us").get<double>(), 0);
  EXPECT_FALSE(answer.contains("branches"));
  Oracle oracle(kUr5eScene, "attachment_site");
  const Pose X = oracle.fk(numbers(answer.at("q")));
  EXPECT_LT((X.p - Eigen::Vector3d(-0.13, 0.6, 0.1)).norm(), 1e-6);
  EXPECT_LT(angle_between(X.R, from_euler({3.14, 0, 1.57})), 1e-6);
  EXPECT_LT(answer.at("pos_err").get<double>(), 1e-6);
  EXPECT_LT(answer.at("rot_err").get<double>(), 1e-6);
}

TEST(Ik, UnitsQuaternionsAndSeedsMeanTheSame) {
  const std::vector<std::string> robot = {"--robot", "ur5e", "--no-timing"};
  const auto metres = ik(robot, {"--pos", "-0.13,0.6,0.1", "--quat", "0,1,0,0"});
  ASSERT_EQ(metres.exit_code, 0) << metres.err;
  EXPECT_EQ(ik(robot, {"--pos", "-130mm,60cm,0.1m", "--quat", "0,1,0,0"}).out, metres.out);
  EXPECT_EQ(ik(robot, {"--pos=-.13,.6,.1", "--quat", "0,-1,0,0"}).out, metres.out);
  const auto seeded = ik(robot, {"--pos", "-0.13,0.6,0.1", "--quat", "0,1,0,0", "--seed-q",
                                 "90deg,-2.2,-1.8,-0.7,90deg,1"});
  ASSERT_EQ(seeded.exit_code, 0) << seeded.err;
  EXPECT_NE(seeded.out, metres.out);
}

TEST(Ik, UnreachablePoseHasAReason) {
  const auto result = ik({"--robot", "ur5e", "--pos", "0,2,0.1", "--quat", "1,0,0,0"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(only_line(result).find("the pose has no answer: "), std::string::npos);
  const auto answers = json_lines(result.out);
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_EQ(answers[0].at("ok"), false);
  EXPECT_EQ(answers[0].at("reason"), "out_of_reach");
  EXPECT_FALSE(answers[0].at("detail").get<std::string>().empty());
  EXPECT_EQ(answers[0].at("best").size(), 6u);
  const auto inside = ik({"--robot", "ur5e", "--pos", "0.05,0,0.5", "--euler", "180deg,0,0"});
  EXPECT_EQ(inside.exit_code, 1);
  EXPECT_EQ(json_lines(inside.out).at(0).at("reason"), "inner_void");
  const auto chinese =
      ik({"--lang", "zh-CN", "--robot", "ur5e", "--pos", "0,2,0.1", "--quat", "1,0,0,0"});
  EXPECT_NE(chinese.err.find("无解"), std::string::npos);
  EXPECT_EQ(json_lines(chinese.out).at(0).at("reason"), "out_of_reach");
}

TEST(Ik, AnswersStandInOrderAndFailuresDoNotStopTheBatch) {
  const support::TempFolder folder;
  const auto poses = support::lines_of(reachable_poses(3));
  const std::string far = "{\"pos\":[0,5,0],\"quat\":[1,0,0,0]}";
  folder.write("poses.jsonl", poses[0] + "\n\n" + far + "\n" + poses[1] + "\n" + poses[2] + "\n");
  const auto result = ik({"--robot", "ur5e", "--in", "poses.jsonl", "--out", "sol.jsonl"}, {},
                         {.folder = folder.path(), .input = {}, .environment = {}});
  EXPECT_EQ(result.exit_code, 1);
  const std::string line = only_line(result);
  EXPECT_EQ(line.rfind("poses.jsonl:3: ", 0), 0u) << line;
  EXPECT_NE(line.find("1 of 4 poses"), std::string::npos) << line;
  const auto answers = json_lines(folder.read("sol.jsonl"));
  ASSERT_EQ(answers.size(), 4u);
  Oracle oracle(kUr5eScene, "attachment_site");
  for (std::size_t i = 0, pose = 0; i < 4; ++i) {
    EXPECT_EQ(answers[i].at("ok"), i != 1);
    if (i == 1) continue;
    const Pose goal = pose_of(json::parse(poses[pose++]));
    EXPECT_LT((oracle.fk(numbers(answers[i].at("q"))).p - goal.p).norm(), 1e-6);
  }
}

TEST(Ik, AllGivesDistinctSolutionsThatAllReachThePose) {
  const auto result = ik({"--robot", "ur5e", "--all"}, kTutorialPose);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json answer = json_lines(result.out).at(0);
  const auto& branches = answer.at("branches");
  // Five-axis geometry of this arm: shoulder left/right, elbow up/down, wrist flipped or not.
  EXPECT_EQ(branches.size(), 8u);
  Oracle oracle(kUr5eScene, "attachment_site");
  std::set<std::vector<int>> rounded;
  for (const json& branch : branches) {
    const std::vector<double> q = numbers(branch);
    const Pose X = oracle.fk(q);
    EXPECT_LT((X.p - Eigen::Vector3d(-0.13, 0.6, 0.1)).norm(), 1e-6);
    EXPECT_LT(angle_between(X.R, from_euler({3.14, 0, 1.57})), 1e-6);
    EXPECT_TRUE(oracle.within_limits(q));
    std::vector<int> key;
    for (const double value : q) {
      key.push_back(
          static_cast<int>(std::lround(std::remainder(value, 2 * std::numbers::pi) * 100)));
    }
    EXPECT_TRUE(rounded.insert(key).second) << "twice: " << branch;
  }
  const auto none = ik({"--robot", "ur5e", "--all", "--pos", "0,5,0", "--quat", "1,0,0,0"});
  EXPECT_EQ(json_lines(none.out).at(0).at("branches").size(), 0u);
}

TEST(Ik, WithoutTimingEqualRunsGiveEqualBytes) {
  const support::TempFolder folder;
  folder.write("poses.jsonl", reachable_poses(40) + "{\"pos\":[0,5,0],\"quat\":[1,0,0,0]}\n");
  const support::RunOptions there{.folder = folder.path(), .input = {}, .environment = {}};
  for (const char* out : {"a", "b"}) {
    const auto result = ik({"--robot", "ur5e", "--in", "poses.jsonl", "--out", out, "--no-timing",
                            "--all", "--seed", "7"},
                           {}, there);
    EXPECT_EQ(result.exit_code, 1);
  }
  EXPECT_EQ(folder.read("a"), folder.read("b"));
  EXPECT_EQ(folder.read("a").find("\"us\""), std::string::npos);
  ik({"--robot", "ur5e", "--in", "poses.jsonl", "--out", "timed"}, {}, there);
  EXPECT_NE(folder.read("timed").find("\"us\""), std::string::npos);
}

TEST(Ik, MalformedLinesNameFileAndLine) {
  const std::string good = support::lines_of(reachable_poses(1)).front() + "\n";
  const std::vector<std::pair<std::string, std::string>> bad = {
      {"{\"pos\":[0,0,1]}", "\"quat\" is missing"},
      {"{\"quat\":[1,0,0,0]}", "\"pos\" is missing"},
      {"{\"pos\":[0,0],\"quat\":[1,0,0,0]}", "\"pos\" must have 3 numbers, it has 2"},
      {"{\"pos\":[0,0,1],\"quat\":[1,0,0]}", "\"quat\" must have 4 numbers, it has 3"},
      {"{\"pos\":[0,0,1],\"quat\":[0,0,0,0]}", "must have length 1, it has 0"},
      {"{\"pos\":[0,0,1],\"quat\":[1,1,0,0]}", "must have length 1, it has 1.41421"},
      {"{\"pos\":[0,0,\"1\"],\"quat\":[1,0,0,0]}", "entry 2 of \"pos\" is not a number"},
      {"{\"pos\":[0,0,1e400],\"quat\":[1,0,0,0]}", "beyond the range"},
      {"{\"pos\":[0,0,1],\"quat\":[1,0,0,0],\"seed\":[1]}", "\"seed\" must have 6 numbers"},
      {"{\"pos\":[0,0,1],\"quat\":[1,0,0,0],\"seed\":null}", "\"seed\" must be a list"},
  };
  for (const auto& [line, says] : bad) {
    SCOPED_TRACE(line);
    const support::TempFolder folder;
    folder.write("poses.jsonl", good + line + "\n");
    const auto result = ik({"--robot", "ur5e", "--in", "poses.jsonl", "--out", "sol.jsonl"}, {},
                           {.folder = folder.path(), .input = {}, .environment = {}});
    EXPECT_EQ(result.exit_code, 2);
    const std::string message = only_line(result);
    EXPECT_EQ(message.rfind("poses.jsonl:2: ", 0), 0u) << message;
    EXPECT_NE(message.find(says), std::string::npos) << message;
    EXPECT_FALSE(folder.exists("sol.jsonl"));
  }
}

TEST(Ik, HugeAndTinyNumbersAreAnswered) {
  const std::string input =
      "{\"pos\":[1e308,-1e308,1e308],\"quat\":[1,0,0,0]}\n"
      "{\"pos\":[1e-320,0,0],\"quat\":[1,0,0,0]}\n"
      "{\"pos\":[0.3,0.3,0.3],\"quat\":[1,0,0,0],\"seed\":[1e300,-1e300,0,0,0,1e17]}\n";
  const auto result =
      ik({"--robot", "ur5e", "--in", "-"}, {}, {.folder = {}, .input = input, .environment = {}});
  EXPECT_LE(result.exit_code, 1) << result.err;
  EXPECT_GE(result.exit_code, 0);
  EXPECT_EQ(json_lines(result.out).size(), 3u);
}

TEST(Ik, BadOptions) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> bad = {
      {{"--pos", "1,2,3"}, "exactly one of --euler and --quat"},
      {{"--pos", "1,2,3", "--euler", "0,0,0", "--quat", "1,0,0,0"}, "exactly one of"},
      {{"--pos", "1,2", "--euler", "0,0,0"}, "--pos: 3 values are needed, 2 are given"},
      {{"--pos", "1,2,3deg", "--euler", "0,0,0"}, "unknown unit \"deg\""},
      {{"--pos", "1,2,3", "--euler", "0,0,1cm"}, "unknown unit \"cm\""},
      {{"--pos", "1,2,3", "--quat", "1,0,0,0deg"}, "no unit is expected"},
      {{"--pos", "1,2,3", "--quat", "2,0,0,0"}, "must have length 1"},
      {{"--pos", "1,2,inf", "--quat", "1,0,0,0"}, "not a finite number"},
      {{"--pos", "1,2,3", "--quat", "1,0,0,0", "--seed-q", "1"}, "--seed-q: 6 values"},
      {{"--pos", "1,2,3", "--quat", "1,0,0,0", "--seed", "x"}, "--seed: \"x\""},
      {{"--pos", "1,2,3", "--quat", "1,0,0,0", "--seed", "-1"}, "--seed: \"-1\""},
  };
  for (const auto& [arguments, says] : bad) {
    SCOPED_TRACE(says);
    const auto result = ik({"--robot", "ur5e"}, arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(only_line(result).find(says), std::string::npos) << result.err;
    EXPECT_EQ(result.out, "");
  }
}

/// A frame in which poses are given, seen in the world of the robot's model, and its tool.
struct Setting {
  std::string robot, tip;
  Pose X_WB;
};

/// The poses of a file of the data folder, moved into the robot's world.
std::string poses_in_world(const std::filesystem::path& file, const Pose& X_WB) {
  std::string lines;
  for (json request : support::load_json_lines(file)) {
    const Pose X = X_WB * pose_of(request);
    const Quat r = to_quat(X.R);
    request["pos"] = {X.p.x(), X.p.y(), X.p.z()};
    request["quat"] = {r.w(), r.x(), r.y(), r.z()};
    lines += request.dump() + "\n";
  }
  return lines;
}

/// Solves a file of poses and checks every answer with MuJoCo on our own model.
void expect_all_solved(const std::filesystem::path& poses, const Setting& setting, Oracle& oracle) {
  const std::string input = poses_in_world(poses, setting.X_WB);
  const auto result = ik({"--robot", setting.robot, "--tip", setting.tip, "--in", "-"}, {},
                         {.folder = {}, .input = input, .environment = {}});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const auto requests = json_lines(input), answers = json_lines(result.out);
  ASSERT_EQ(answers.size(), requests.size());
  std::size_t solved = 0;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (!answers[i].at("ok").get<bool>()) continue;
    const std::vector<double> q = numbers(answers[i].at("q"));
    const Pose goal = pose_of(requests[i]), got = oracle.fk(q);
    const bool right = (goal.p - got.p).norm() < 1e-4 && angle_between(goal.R, got.R) < 1e-3;
    EXPECT_TRUE(right) << "line " << i + 1;
    EXPECT_TRUE(oracle.within_limits(q)) << "line " << i + 1;
    solved += right;
  }
  EXPECT_EQ(solved, requests.size());
}

void expect_all_refused(const std::filesystem::path& poses, const Setting& setting) {
  const auto result =
      ik({"--robot", setting.robot, "--tip", setting.tip, "--in", "-"}, {},
         {.folder = {}, .input = poses_in_world(poses, setting.X_WB), .environment = {}});
  EXPECT_EQ(result.exit_code, 1);
  const auto answers = json_lines(result.out);
  EXPECT_GE(answers.size(), 100u);
  for (const json& answer : answers) {
    EXPECT_EQ(answer.at("ok"), false);
    EXPECT_EQ(answer.at("reason"), "out_of_reach");
  }
}

TEST(IkData, Ur5e) {
  MJARM_TEST_FILE(reachable, "ik/ur5e_reachable.jsonl");
  MJARM_TEST_FILE(unreachable, "ik/ur5e_unreachable.jsonl");
  Oracle oracle(kUr5eScene, "attachment_site");
  // The poses are in base_link of a URDF, which is turned by half a turn about z against our world.
  const Setting setting{
      "ur5e", "attachment_site", {Eigen::Vector3d::Zero(), from_euler({0, 0, std::numbers::pi})}};
  expect_all_solved(reachable, setting, oracle);
  expect_all_refused(unreachable, setting);
}

TEST(IkData, Panda) {
  MJARM_TEST_FILE(reachable, "ik/panda_reachable.jsonl");
  MJARM_TEST_FILE(unreachable, "ik/panda_unreachable.jsonl");
  Oracle oracle(model_file("franka_emika_panda/scene.xml"), "panda_link8");
  const Setting setting{"panda", "panda_link8", {}};
  expect_all_solved(reachable, setting, oracle);
  expect_all_refused(unreachable, setting);
}

TEST(IkData, TheUrdfsBesideThePoses) {
  MJARM_TEST_FILE(ur5e, "ik/ur5e.urdf");
  MJARM_TEST_FILE(panda, "ik/panda.urdf");
  MJARM_TEST_FILE(ur5e_poses, "ik/ur5e_reachable.jsonl");
  MJARM_TEST_FILE(panda_poses, "ik/panda_reachable.jsonl");
  for (const auto& [urdf, poses] : {std::pair(ur5e, ur5e_poses), std::pair(panda, panda_poses)}) {
    // Geometry only, without any mass: enough for kinematics, and no reason to say anything.
    const auto result = ik({"--robot", urdf.string(), "--in", poses.string()});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    EXPECT_EQ(json_lines(result.out).size(), 1000u);
  }
}

TEST(IkData, ReachableEllipse) {
  MJARM_TEST_FILE(file, "ik/ur5e_ellipse_far.jsonl");
  const auto lines = support::load_json_lines(file);
  std::string input;
  for (const json& pose : lines.at(0).at("poses")) input += pose.dump() + "\n";
  const auto result =
      ik({"--robot", "ur5e", "--in", "-"}, {}, {.folder = {}, .input = input, .environment = {}});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(json_lines(result.out).size(), 200u);
}

}  // namespace
}  // namespace mjarm::app
