#include <gmock/gmock.h>

#include "apps/bench/runs_test.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

TEST(BenchPick, PlacesWhatTheCameraSeesAndTwiceTheSame) {
  const std::vector<std::string> arguments = {"bench",    "pick", "--robot",    "panda",
                                              "--scenes", "1",    "--no-timing"};
  const json bench = bench_json(arguments);
  const json& set = bench.at("sets").at(0);
  EXPECT_EQ(set.at("robot"), "panda");
  ASSERT_EQ(set.at("scenes").size(), 1u);
  for (const json& scene : set.at("scenes")) {
    EXPECT_TRUE(scene.at("placed").get<bool>()) << scene;
    EXPECT_LT(scene.at("position").get<double>(), 5e-3);
    EXPECT_GT(scene.at("seen_position").get<double>(), 0) << "the truth was used";
    EXPECT_LT(scene.at("seen_position").get<double>(), 3e-3);
  }
  EXPECT_EQ(bench_json(arguments), bench);
}

TEST(BenchPick, KnowsItsRobots) {
  const auto result = mjarm({"bench", "pick", "--robot", "pr2"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("ur5e or panda"));
}

}  // namespace
}  // namespace mjarm::app
