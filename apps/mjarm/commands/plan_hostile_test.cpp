#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "apps/mjarm/commands/two_problems_test.hpp"
#include "mjarm/core/rng.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;
using PlanHostile = PlanFile;

json box(const std::string& name, double x, double y, double half) {
  return {{"name", name},
          {"type", "box"},
          {"pos", {x, y, 0}},
          {"quat", {1, 0, 0, 0}},
          {"half", {half, half, half}}};
}

json one_problem() {
  json file = two_problems();
  file["problems"].erase(1);
  return file;
}

TEST_F(PlanHostile, NumbersThatAreNone) {
  const std::string sound = one_problem().dump(), start = "\"start\":[0.8,0.0]";
  ASSERT_NE(sound.find(start), std::string::npos);
  for (const char* wrong :
       {"[NaN,0.0]", "[1e999,0.0]", "[-Infinity,0]", "[null,0]", "[\"0.8\",0]"}) {
    std::string text = sound;
    text.replace(text.find(start), start.size(), std::string("\"start\":") + wrong);
    const auto result = mjarm({"plan", "--in", folder_.write("wrong.json", text).string()});
    EXPECT_EQ(result.exit_code, 2) << wrong;
    EXPECT_TRUE(result.out.empty());
    EXPECT_NE(only_line(result).find("wrong.json"), std::string::npos);
  }
}

TEST_F(PlanHostile, NestingWithoutEnd) {
  for (const std::string& text :
       {std::string(1'000'000, '['), "{\"robot\":" + std::string(500'000, '{')}) {
    const auto result = mjarm({"plan", "--in", folder_.write("deep.json", text).string()});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_LT(only_line(result).size(), 400u);
  }
}

TEST_F(PlanHostile, AHundredThousandObstaclesAreSolved) {
  json file = one_problem();
  Rng rng(3);
  json& obstacles = file["problems"][0]["obstacles"];
  // Thick beyond the reach, and a heap in place of the post.
  while (obstacles.size() < 50'000) {
    const double x = rng.uniform(-20, 20), y = rng.uniform(-20, 20);
    if (x * x + y * y > 2) obstacles.push_back(box("far", x, y, 0.01));
  }
  while (obstacles.size() < 100'000) {
    obstacles.push_back(box("heap", rng.uniform(0.66, 0.74), rng.uniform(-0.04, 0.04), 0.005));
  }
  const auto result = plan(file, {"--no-timing"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json round = json::parse(result.out).at("round");
  EXPECT_GT(round.at("path").size(), 2u);
  EXPECT_NEAR(round.at("cost"), json::parse(plan(one_problem()).out).at("round").at("cost"), 2.0);
}

TEST_F(PlanHostile, MoreThanThatAreRefused) {
  json file = one_problem();
  file["problems"][0]["obstacles"] = json(200'001, box("same", 5, 5, 0.1));
  const auto result = plan(file);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(only_line(result).find("200001"), std::string::npos);
}

TEST_F(PlanHostile, EndsThatCannotBeAreTold) {
  const auto reason = [&](const char* key, const json& value) {
    json file = one_problem();
    file["problems"][0][key] = value;
    const auto result = plan(file);
    EXPECT_EQ(result.exit_code, 1);
    const json answer = json::parse(result.out).at("round");
    EXPECT_EQ(answer.at("ok"), false);
    EXPECT_NE(only_line(result).find(answer.at("reason").get<std::string>()), std::string::npos);
    return answer.at("reason").get<std::string>();
  };
  EXPECT_EQ(reason("goals", json::array()),
            "expected one start and at least one goal of 2 finite joint values each");
  EXPECT_EQ(reason("start", {0, 0}),
            "the start is in collision: link \"lower\" overlaps obstacle \"post\" by 110.01 mm");
  EXPECT_NE(reason("goals", {{0, 0}, {0.1, 0}}).find("every goal is in collision"),
            std::string::npos);
  EXPECT_NE(reason("start", {3.5, 0}).find("outside of the limits"), std::string::npos);
  EXPECT_NE(reason("goals", {{0, 1e300}}).find("outside of the limits"), std::string::npos);
}

TEST_F(PlanHostile, AHundredThousandGoalsAndARoomWithoutAir) {
  json file = one_problem();
  json& goals = file["problems"][0]["goals"] = json::array();
  Rng rng(5);
  while (goals.size() < 100'000) goals.push_back({rng.uniform(-1, 1) * 1e-3, 0});
  const auto result = plan(file);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(only_line(result).find("every goal is in collision"), std::string::npos);

  json inside = one_problem();
  inside["problems"][0]["obstacles"] = {box("all", 0, 0, 1e4)};
  const auto full = plan(inside);
  EXPECT_EQ(full.exit_code, 1);
  EXPECT_NE(only_line(full).find("\"all\""), std::string::npos);
}

TEST_F(PlanHostile, RobotsThatAreTooMuch) {
  json many = one_problem();
  const json spheres = many["robot"]["spheres"];
  for (int k = 0; k < 100; ++k) {
    for (const json& sphere : spheres) many["robot"]["spheres"].push_back(sphere);
  }
  const auto balls = plan(many);
  EXPECT_EQ(balls.exit_code, 2);
  EXPECT_NE(only_line(balls).find("1010 spheres"), std::string::npos);

  json longest = one_problem();
  std::string before = "lower";
  for (int k = 0; k < 100; ++k) {
    const std::string next = "more" + std::to_string(k);
    longest["robot"]["joints"].push_back(turning_link(next, before, 0.1));
    before = next;
  }
  const auto joints = plan(longest);
  EXPECT_EQ(joints.exit_code, 2);
  EXPECT_NE(only_line(joints).find("joints[16]"), std::string::npos);
}

}  // namespace
}  // namespace mjarm::app
