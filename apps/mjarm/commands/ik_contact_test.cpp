// Contact and branches of a single `mjarm ik`.
#include <set>

#include "apps/mjarm/commands/oracle_test.hpp"
#include "apps/mjarm/commands/program_test.hpp"
#include "mjarm/collision/exact.hpp"
#include "mjarm/model/robot.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;

const std::vector<std::string> kUr5eWords = {"--robot", "ur5e", "--no-timing"};
const std::vector<std::string> kUnderTheFloor = {"--pos", "-0.13,0.6,-0.1", "--euler",
                                                 "180deg,0,90deg"};
const std::vector<std::string> kAbove = {"--pos", "0,-0.3,0.5", "--euler", "3.14,0,0"};

json answer_of(const support::ProgramResult& result) {
  const auto answers = json_lines(result.out);
  EXPECT_EQ(answers.size(), 1U) << result.out << result.err;
  return answers.empty() ? json::object() : answers[0];
}

bool touches_nothing(const std::string& model, const std::vector<double>& q) {
  const Result<Robot> robot = load_robot(model);
  EXPECT_TRUE(robot.has_value());
  return robot && ExactChecker(robot->model, robot->arm).is_free(q);
}

TEST(IkContact, APoseUnderTheFloorIsACollisionWithPairAndDepth) {
  const auto result = ik(kUr5eWords, kUnderTheFloor);
  EXPECT_EQ(result.exit_code, 1);
  const json answer = answer_of(result);
  EXPECT_EQ(answer.at("ok"), false);
  EXPECT_EQ(answer.at("reason"), "collision");
  EXPECT_EQ(answer.at("pair").size(), 2U);
  const auto pair = answer.at("pair").get<std::set<std::string>>();
  EXPECT_TRUE(pair.contains("floor")) << answer;
  EXPECT_GT(answer.at("depth").get<double>(), 0.05);
  const std::string detail = answer.at("detail");
  EXPECT_NE(detail.find("floor and "), std::string::npos) << detail;
  EXPECT_NE(detail.find(" overlap by 1"), std::string::npos) << detail;
  EXPECT_NE(only_line(result).find(detail), std::string::npos);
}

TEST(IkContact, IsLookedAtForOneRequestUnlessToldOtherwise) {
  auto words = kUnderTheFloor;
  words.emplace_back("--no-collisions");
  const auto geometry = ik(kUr5eWords, words);
  EXPECT_EQ(geometry.exit_code, 0) << geometry.err;
  EXPECT_EQ(answer_of(geometry).at("ok"), true);
  words.emplace_back("--collisions");
  EXPECT_EQ(ik(kUr5eWords, words).exit_code, 2);
}

TEST(IkContact, OfABatchOnlyWhereAskedFor) {
  const std::string line = "{\"pos\":[-0.13,0.6,-0.1],\"quat\":[0,1,0,0]}\n";
  const support::RunOptions input{.folder = {}, .input = line + line, .environment = {}};
  const auto geometry = ik(kUr5eWords, {"--in", "-"}, input);
  EXPECT_EQ(geometry.exit_code, 0) << geometry.err;
  for (const char* threads : {"1", "3"}) {
    const auto contact = ik(kUr5eWords, {"--in", "-", "--collisions", "--threads", threads}, input);
    EXPECT_EQ(contact.exit_code, 1);
    const auto answers = json_lines(contact.out);
    ASSERT_EQ(answers.size(), 2U);
    for (const json& answer : answers) EXPECT_EQ(answer.at("reason"), "collision");
  }
}

TEST(IkContact, AFreeBranchIsTakenRatherThanOneInContact) {
  // Near the floor and near the arm some of the answers touch something.
  int some_touch = 0;
  for (const char* pos : {"0.3,0.3,0.02", "0.4,0.2,0.03", "-0.3,0.4,0.05", "0,0.5,0.02"}) {
    const auto all = ik(kUr5eWords, {"--pos", pos, "--euler", "180deg,0,0", "--all"});
    const json answer = answer_of(all);
    ASSERT_EQ(answer.at("branches").size(), answer.at("states").size());
    std::size_t free = 0;
    for (std::size_t i = 0; i < answer.at("branches").size(); ++i) {
      const json& state = answer.at("states")[i];
      EXPECT_EQ(state.at("free"), touches_nothing("ur5e", numbers(answer.at("branches")[i])));
      EXPECT_EQ(state.contains("pair"), !state.at("free").get<bool>());
      EXPECT_EQ(state.contains("depth"), !state.at("free").get<bool>());
      free += state.at("free").get<bool>() ? 1 : 0;
    }
    EXPECT_EQ(answer.at("ok"), free > 0);
    if (free > 0) {
      EXPECT_TRUE(touches_nothing("ur5e", numbers(answer.at("q")))) << pos;
    }
    if (free > 0 && free < answer.at("branches").size()) {
      ++some_touch;
      // Also where the seed stands at one that touches.
      for (std::size_t i = 0; i < answer.at("branches").size(); ++i) {
        if (answer.at("states")[i].at("free").get<bool>()) continue;
        std::string seed;
        for (const double q : numbers(answer.at("branches")[i])) {
          seed += (seed.empty() ? "" : ",") + std::to_string(q);
        }
        const auto seeded =
            ik(kUr5eWords, {"--pos", pos, "--euler", "180deg,0,0", "--seed-q=" + seed});
        EXPECT_TRUE(touches_nothing("ur5e", numbers(answer_of(seeded).at("q")))) << pos;
        break;
      }
    }
  }
  EXPECT_GT(some_touch, 0);
}

TEST(IkBranch, WithoutASeedTheElbowIsUp) {
  const json answer = answer_of(ik(kUr5eWords, kAbove));
  EXPECT_EQ(answer.at("branch").at("elbow"), "up");
  const json panda =
      answer_of(ik({"--robot", "panda"}, {"--pos", "0.4,0.1,0.4", "--euler", "180deg,0,0"}));
  EXPECT_EQ(panda.at("branch").at("elbow"), "up");
}

TEST(IkBranch, WithASeedTheNearestAnswerIsTakenAsInABatch) {
  auto words = kAbove;
  const std::string seed = "-1.1,-3.0,1.6,-0.14,-1.57,0.46";
  words.push_back("--seed-q=" + seed);
  const json answer = answer_of(ik(kUr5eWords, words));
  EXPECT_EQ(answer.at("branch").at("elbow"), "down");
  Oracle oracle(kUr5eScene, "attachment_site");
  const Pose X = oracle.fk(numbers(answer.at("q")));
  const Quat r = to_quat(X.R);
  const std::string line = json({{"pos", {X.p.x(), X.p.y(), X.p.z()}},
                                 {"quat", {r.w(), r.x(), r.y(), r.z()}},
                                 {"seed", json::parse("[" + seed + "]")}})
                               .dump();
  const auto batch =
      ik(kUr5eWords, {"--in", "-"}, {.folder = {}, .input = line + "\n", .environment = {}});
  const json of_batch = answer_of(batch);
  EXPECT_FALSE(of_batch.contains("branch"));
  const auto a = numbers(answer.at("q")), b = numbers(of_batch.at("q"));
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-6);
}

TEST(IkBranch, IsAskedForByWords) {
  std::set<std::vector<double>> found;
  for (const char* shoulder : {"left", "right"}) {
    for (const char* elbow : {"up", "down"}) {
      for (const char* wrist : {"flip", "no_flip"}) {
        auto words = kAbove;
        words.insert(words.end(), {"--branch", std::string("shoulder=") + shoulder +
                                                   ",elbow=" + elbow + ",wrist=" + wrist});
        const json answer = answer_of(ik(kUr5eWords, words));
        ASSERT_EQ(answer.at("ok"), true) << answer;
        EXPECT_EQ(answer.at("branch"),
                  json({{"shoulder", shoulder}, {"elbow", elbow}, {"wrist", wrist}}));
        EXPECT_TRUE(found.insert(numbers(answer.at("q"))).second);
      }
    }
  }
}

TEST(IkBranch, BadWordsAreAnsweredByTheNearest) {
  const std::pair<const char*, const char*> bad[] = {
      {"elbow=upp",
       "--branch: elbow: unknown word \"upp\", expected one of up, down (did you mean "
       "\"up\"?)"},
      {"sholder=left", "(did you mean \"shoulder\"?)"},
      {"left", "\"left\": expected PART=WORD, as in elbow=up"}};
  for (const auto& [branch, says] : bad) {
    auto words = kAbove;
    words.insert(words.end(), {"--branch", branch});
    const auto result = ik(kUr5eWords, words);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(only_line(result).find(says), std::string::npos) << result.err;
  }
}

TEST(IkBranch, WhatIsNotThereIsSaidWithWhatIs) {
  const auto result = ik(kUr5eWords, {"--pos", "-0.13,0.6,0.1", "--euler", "180deg,0,90deg",
                                      "--task", "position", "--branch", "wrist=flip"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(only_line(result).find("has no wrist that is known by words, only: elbow"),
            std::string::npos)
      << result.err;
}

TEST(Ik, AnAbsurdlyFarPoseIsOutOfReachByABoundedNumber) {
  for (const char* pos : {"1e308m,0,0", "1e308m,1e308m,1e308m", "2000km,0,0", "1e12m,0,0"}) {
    const auto result = ik(kUr5eWords, {"--pos", pos, "--euler", "0,0,0"});
    if (result.exit_code == 2) continue;  // a unit that is not known
    EXPECT_EQ(result.exit_code, 1);
    const json answer = answer_of(result);
    EXPECT_EQ(answer.at("reason"), "out_of_reach");
    const std::string detail = answer.at("detail");
    EXPECT_EQ(detail.find("inf"), std::string::npos) << detail;
    EXPECT_NE(detail.find("more than 1000 km"), std::string::npos) << detail;
  }
}

}  // namespace
}  // namespace mjarm::app
