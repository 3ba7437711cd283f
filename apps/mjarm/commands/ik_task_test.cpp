#include <algorithm>
#include <cmath>

#include "apps/mjarm/commands/oracle_test.hpp"
#include "apps/mjarm/commands/program_test.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;

const std::string kPandaScene = model_file("franka_emika_panda/scene.xml");
const std::vector<std::string> kPanda = {"--robot", "panda", "--no-timing"};

/// Poses that the Panda reaches, each with a seed, made by MuJoCo from random joint values near
/// home.
std::string panda_poses(int count) {
  Oracle oracle(kPandaScene, "hand_tcp");
  Rng rng(12);
  std::string lines;
  for (int i = 0; i < count; ++i) {
    std::vector<double> q{0, -0.8, 0, -2.3, 0, 1.6, 0.8}, seed = q;
    for (double& value : q) value += rng.uniform(-0.6, 0.6);
    for (double& value : seed) value += rng.uniform(-0.6, 0.6);
    const Pose X = oracle.fk(q);
    const Quat r = to_quat(X.R);
    lines += json({{"pos", {X.p.x(), X.p.y(), X.p.z()}},
                   {"quat", {r.w(), r.x(), r.y(), r.z()}},
                   {"seed", seed}})
                 .dump() +
             "\n";
  }
  return lines;
}

support::RunOptions given(const std::string& input) {
  return {.folder = {}, .input = input, .environment = {}};
}

TEST(IkTask, PositionNeedsNoOrientation) {
  const Eigen::Vector3d p(0.3, 0.4, 0.2);
  Oracle oracle(model_file("universal_robots_ur5e/scene.xml"), "attachment_site");
  const auto one = ik({"--robot", "ur5e", "--task", "position", "--pos", "0.3,0.4,0.2"});
  ASSERT_EQ(one.exit_code, 0) << one.err;
  const auto many =
      ik({"--robot", "ur5e", "--task", "position", "--in", "-"}, {},
         given("{\"pos\":[0.3,0.4,0.2]}\n{\"pos\":[0.3,0.4,0.2],\"quat\":[1,0,0,0]}\n"));
  ASSERT_EQ(many.exit_code, 0) << many.err;
  for (const json& answer : json_lines(one.out + many.out)) {
    EXPECT_LT((oracle.fk(numbers(answer.at("q"))).p - p).norm(), 1e-6);
    EXPECT_EQ(answer.at("rot_err").get<double>(), 0);
  }
  EXPECT_EQ(ik({"--robot", "ur5e", "--pos", "0.3,0.4,0.2"}).exit_code, 2);
  const auto far = ik({"--robot", "ur5e", "--task", "position", "--pos", "0,2,0.1"});
  EXPECT_EQ(far.exit_code, 1);
  EXPECT_EQ(json_lines(far.out).at(0).at("reason"), "out_of_reach");
}

TEST(IkTask, AxisMeetsPositionAndDirection) {
  Oracle oracle(kPandaScene, "hand_tcp");
  const std::string input = panda_poses(40);
  const auto result = ik(kPanda, {"--task", "axis", "--in", "-"}, given(input));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto goals = json_lines(input), answers = json_lines(result.out);
  ASSERT_EQ(answers.size(), 40U);
  int turned = 0;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const Pose goal = pose_of(goals[i]), X = oracle.fk(numbers(answers[i].at("q")));
    EXPECT_LT((X.p - goal.p).norm(), 1e-6);
    EXPECT_LT((X.R.col(2) - goal.R.col(2)).norm(), 1e-6);
    turned += angle_between(X.R, goal.R) > 0.1 ? 1 : 0;
  }
  EXPECT_GT(turned, 20);
}

/// How far from its wish an answer is: from the seed's joint values, or from the middle of the
/// limits in shares of their half width.
double distance(const std::string& wish, const std::vector<double>& q, const json& goal) {
  const std::vector<double> seed = numbers(goal.at("seed"));
  const double lower[] = {-2.8973, -1.7628, -2.8973, -3.0718, -2.8973, -0.0175, -2.8973};
  const double upper[] = {2.8973, 1.7628, 2.8973, -0.0698, 2.8973, 3.7525, 2.8973};
  double sum = 0;
  for (std::size_t i = 0; i < q.size(); ++i) {
    const double half = 0.5 * (upper[i] - lower[i]);
    const double off = wish == "posture" ? q[i] - seed[i] : (q[i] - lower[i]) / half - 1;
    sum += off * off;
  }
  return std::sqrt(sum);
}

TEST(IkPrefer, ComesNearerToTheWishWithTheToolAtRest) {
  Oracle oracle(kPandaScene, "hand_tcp");
  const std::string input = panda_poses(40);
  const auto goals = json_lines(input);
  const auto plain = json_lines(ik(kPanda, {"--in", "-"}, given(input)).out);
  for (const std::string wish : {"posture", "middle", "manipulability"}) {
    const auto result = ik(kPanda, {"--prefer", wish, "--in", "-"}, given(input));
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto answers = json_lines(result.out);
    ASSERT_EQ(answers.size(), plain.size());
    int moved = 0;
    for (std::size_t i = 0; i < answers.size(); ++i) {
      const auto q = numbers(answers[i].at("q")), before = numbers(plain[i].at("q"));
      const Pose goal = pose_of(goals[i]), X = oracle.fk(q);
      EXPECT_LT((X.p - goal.p).norm(), 1e-6);
      EXPECT_LT(angle_between(X.R, goal.R), 1e-6);
      EXPECT_TRUE(oracle.within_limits(q));
      moved += q != before ? 1 : 0;
      if (wish == "manipulability") continue;
      EXPECT_LE(distance(wish, q, goals[i]), distance(wish, before, goals[i]) + 1e-9);
    }
    EXPECT_GT(moved, 20) << wish;
  }
}

TEST(IkPrefer, HomeIsThePostureWithoutASeed) {
  const std::vector<std::string> goal = {"--pos", "0.45,0.1,0.4", "--euler", "180deg,0,0"};
  const auto home =
      ik(kPanda, {"--prefer", "posture", "--pos", "0.45,0.1,0.4", "--euler", "3,0,0"});
  ASSERT_EQ(home.exit_code, 0) << home.err;
  const json info = json::parse(mjarm({"model", "info", "panda", "--json"}).out);
  std::string q;
  for (const double value : numbers(info.at("arm").at("home")))
    q += (q.empty() ? "" : ",") + json(value).dump();
  const auto seeded = ik(
      kPanda, {"--prefer", "posture", "--pos", "0.45,0.1,0.4", "--euler", "3,0,0", "--seed-q", q});
  EXPECT_EQ(seeded.out, home.out);
}

TEST(IkPrefer, AnyNumberOfThreadsGivesTheSameBytes) {
  const support::TempFolder folder;
  folder.write("poses.jsonl", panda_poses(200));
  const support::RunOptions there{.folder = folder.path(), .input = {}, .environment = {}};
  for (const std::string threads : {"1", "2", "5"}) {
    const auto result = ik(kPanda,
                           {"--task", "axis", "--prefer", "manipulability", "--in", "poses.jsonl",
                            "--threads", threads, "--out", threads},
                           there);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(folder.read(threads), folder.read("1")) << threads;
  }
  EXPECT_EQ(json_lines(folder.read("1")).size(), 200U);
}

TEST(IkTask, BadWordsAreRefusedInOneLine) {
  const std::vector<std::string> goal = {"--robot",   "panda",  "--pos",
                                         "0.4,0,0.5", "--quat", "0,1,0,0"};
  const std::vector<std::pair<std::vector<std::string>, std::string>> bad = {
      {{"--task", "axes"},
       "--task: \"axes\" is unknown (did you mean \"axis\"?); expected one of: pose, position, "
       "axis"},
      {{"--task", "AXIS"}, "--task: \"AXIS\" is unknown"},
      {{"--task", ""}, "--task: \"\" is unknown"},
      {{"--prefer", "midle"}, "--prefer: \"midle\" is unknown (did you mean \"middle\"?)"},
      {{"--prefer", "middle", "--all"}, "--prefer and --all exclude each other"},
      {{"--prefer", "middle", "--windings"}, "--prefer and --windings exclude each other"},
      {{"--task", "axis", "--task", "pose"}, "--task may be given only once"},
      {{"--task", "position", "--euler", "0,0,0"}, "exactly one of --euler and --quat"},
      {{"--prefer"}, "--prefer needs a value"},
  };
  for (const auto& [arguments, says] : bad) {
    SCOPED_TRACE(says);
    const auto result = ik(goal, arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(only_line(result).find(says), std::string::npos) << result.err;
    EXPECT_EQ(result.out, "");
  }
  const auto chinese = ik(goal, {"--task", "axes", "--lang", "zh-CN"});
  EXPECT_NE(chinese.err.find("应为以下之一：pose、position、axis"), std::string::npos)
      << chinese.err;
  const auto alone =
      ik({"--robot", "panda", "--task", "axis", "--in", "-"}, {}, given("{\"pos\":[0.4,0,0.5]}\n"));
  EXPECT_EQ(alone.exit_code, 2);
  EXPECT_NE(only_line(alone).find("\"quat\" is missing"), std::string::npos) << alone.err;
}

}  // namespace
}  // namespace mjarm::app
