#include "apps/mjarm/commands/program_test.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;

/// What is promised of an arm that is driven by its own model.
TEST(BenchControl, StaysOnTheCurveAndCoversIt) {
  const auto result = mjarm({"bench", "control", "--poses", "5", "--json", "--no-timing"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json bench = json::parse(result.out);
  EXPECT_EQ(bench.at("rest").front().at("control"), "servo");
  EXPECT_GT(bench.at("rest").front().at("position").get<double>(), 1e-3) << "servos sag";
  const json& rest = bench.at("rest").back();
  EXPECT_EQ(rest.at("control"), "computed_torque");
  EXPECT_LT(rest.at("position").get<double>(), 1e-5);
  EXPECT_LT(rest.at("rotation").get<double>(), 1.7e-5);
  int driven = 0;
  for (const json& lap : bench.at("laps")) {
    EXPECT_FALSE(lap.contains("rtf"));
    if (lap.at("control") == "servo") {
      EXPECT_LT(lap.at("coverage").get<double>(), 0.5) << lap;
    }
    if (lap.at("control") != "computed_torque") continue;
    ++driven;
    EXPECT_EQ(lap.at("coverage"), 1.0) << lap;
    const bool loaded = lap.at("payload") > 0.0;
    if (!loaded) {
      EXPECT_LT(lap.at("path_error_max").get<double>(), 5e-5) << lap;
    } else if (lap.at("integral") > 0.0) {
      EXPECT_LT(lap.at("second_half_max").get<double>(), 1e-4) << lap;
    } else {  // without integral action the load shows: the check can fail
      EXPECT_GT(lap.at("second_half_max").get<double>(), 1e-4) << lap;
    }
  }
  EXPECT_EQ(driven, 4);
}

}  // namespace
}  // namespace mjarm::app
