#include <gmock/gmock.h>

#include "apps/bench/runs_test.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

json one_scene(const char* robot, const char* set) {
  return bench_json(
      {"bench", "pick", "--robot", robot, "--set", set, "--scenes", "1", "--no-timing"});
}

void expect_placed(const json& bench, const char* robot, const char* name) {
  const json& set = bench.at("sets").at(0);
  EXPECT_EQ(set.at("robot"), robot);
  EXPECT_EQ(set.at("set"), name);
  ASSERT_EQ(set.at("scenes").size(), 1u);
  const json& scene = set.at("scenes").at(0);
  EXPECT_TRUE(scene.at("placed").get<bool>()) << scene;
  EXPECT_LT(scene.at("position").get<double>(), 5e-3);
  EXPECT_GT(scene.at("seen_position").get<double>(), 0) << "the truth was used";
  EXPECT_LT(scene.at("seen_position").get<double>(), 3e-3);
}

TEST(BenchPick, PlacesWhatTheCameraSeesAndTwiceTheSame) {
  const json bench = one_scene("panda", "table");
  expect_placed(bench, "panda", "table");
  EXPECT_EQ(one_scene("panda", "table"), bench);
}

TEST(BenchPick, PlacesWhatStandsInClutter) {
  expect_placed(one_scene("ur5e", "clutter"), "ur5e", "clutter");
}

TEST(BenchPick, KnowsItsScenes) {
  const auto result = mjarm({"bench", "pick", "--set", "cluter"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("table or clutter"));
}

TEST(BenchPick, KnowsItsRobots) {
  const auto result = mjarm({"bench", "pick", "--robot", "pr2"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("ur5e or panda"));
}

}  // namespace
}  // namespace mjarm::app
