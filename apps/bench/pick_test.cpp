#include <gmock/gmock.h>

#include <stdexcept>

#include "apps/bench/runs_test.hpp"
#include "mjarm/perception/tag_detector.hpp"
#include "tests/support/rounds.hpp"

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
  if (!testing::is_long()) GTEST_SKIP() << testing::kLongOnly;
  expect_placed(one_scene("ur5e", "clutter"), "ur5e", "clutter");
}

/// The errors of an object that is known in one way, at the camera's noise or at none.
json seen_as(const json& bench, const std::string& object, bool by_tag, bool noisy) {
  for (const json& one : bench.at("seen")) {
    if (one.at("object") == object && one.at("by_tag") == by_tag &&
        (one.at("depth_sigma").get<double>() > 0) == noisy) {
      return one;
    }
  }
  throw std::runtime_error("nothing of " + object);
}

void expect_seen(const json& errors) {
  EXPECT_EQ(errors.at("placements"), 1) << errors;
  EXPECT_TRUE(errors.at("wrong").empty() && errors.at("missed").empty()) << errors;
  ASSERT_EQ(errors.at("position").size(), 1u) << errors;
  EXPECT_GT(errors.at("position").at(0).get<double>(), 0) << "the truth was used";
  EXPECT_LT(errors.at("position").at(0), errors.at("position_goal"));
  EXPECT_LT(errors.at("rotation").at(0), errors.at("rotation_goal"));
}

TEST(BenchPick, MeasuresWhatIsSeenByTagAndByShape) {
  const json bench = bench_json({"bench", "pick", "--set", "seen", "--scenes", "1"});
  EXPECT_FALSE(bench.contains("sets"));
  for (const char* object : {"box", "can", "step"}) {
    expect_seen(seen_as(bench, object, false, true));
    expect_seen(seen_as(bench, object, false, false));
    EXPECT_NE(seen_as(bench, object, false, true).at("position"),
              seen_as(bench, object, false, false).at("position"))
        << "noise changed nothing";
  }
  if (perception::has_tags()) expect_seen(seen_as(bench, "box", true, true));
}

TEST(BenchPick, MeasuresWhatIsHeldAndDropsItWithoutFriction) {
  if (!testing::is_long()) GTEST_SKIP() << testing::kLongOnly;
  const json bench =
      bench_json({"bench", "pick", "--set", "creep", "--robot", "panda", "--hold", "1"});
  ASSERT_EQ(bench.at("creep").size(), 9u);
  int own_steps = 0;
  for (const json& one : bench.at("creep")) {
    EXPECT_EQ(one.at("robot"), "panda");
    EXPECT_TRUE(one.at("good").get<bool>()) << one;
    EXPECT_GT(one.at("rest").at("moved").get<double>(), 0) << one;
    EXPECT_GT(one.at("carried").at("fastest").get<double>(), 0) << one;
    EXPECT_GT(one.at("fallen").get<double>(), 0.1) << one;
    own_steps += one.at("own_step").get<bool>() ? 1 : 0;
  }
  EXPECT_EQ(own_steps, 3);
}

TEST(BenchPick, KnowsItsSets) {
  const auto result = mjarm({"bench", "pick", "--set", "cluter"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("table, clutter, seen or creep"));
  EXPECT_EQ(mjarm({"bench", "pick", "--set", "seen", "--robot", "panda"}).exit_code, 2);
  EXPECT_EQ(mjarm({"bench", "pick", "--set", "creep", "--hold", "0"}).exit_code, 2);
}

TEST(BenchPick, KnowsItsRobots) {
  const auto result = mjarm({"bench", "pick", "--robot", "pr2"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("ur5e or panda"));
}

}  // namespace
}  // namespace mjarm::app
