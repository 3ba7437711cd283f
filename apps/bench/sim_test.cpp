#include "apps/mjarm/commands/program_test.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;

TEST(BenchSim, ComparesWithBareStepsAsJson) {
  const auto result = mjarm({"bench", "sim", "--rounds", "1", "--steps", "20", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json bench = json::parse(result.out, nullptr, false);
  EXPECT_EQ(bench.at("steps"), 20);
  ASSERT_GE(bench.at("entries").size(), 4u);
  EXPECT_EQ(bench.at("entries")[0].at("name"), "mj_step");
  EXPECT_EQ(bench.at("entries")[0].at("ratio"), 1.0);
  for (const json& entry : bench.at("entries")) {
    EXPECT_GT(entry.at("us").get<double>(), 0);
    EXPECT_GT(entry.at("rtf").get<double>(), 0);
  }
}

TEST(BenchSim, SameBytesWithoutTiming) {
  for (const char* format : {"--json", "--quiet"}) {
    const std::vector<std::string> arguments = {"bench",       "sim", "--robot", "panda",
                                                "--rounds",    "1",   "--steps", "20",
                                                "--no-timing", format};
    const auto first = mjarm(arguments);
    ASSERT_EQ(first.exit_code, 0) << first.err;
    EXPECT_EQ(first.out, mjarm(arguments).out);
    EXPECT_EQ(first.out.find("rtf\":"), std::string::npos);
  }
}

TEST(BenchSim, SaysWhatItNeeds) {
  const auto nothing = mjarm({"bench"});
  EXPECT_EQ(nothing.exit_code, 2);
  EXPECT_NE(only_line(nothing).find("sim"), std::string::npos);
  for (const char* steps : {"0", "-1", "many", "99999999"}) {
    const auto result = mjarm({"bench", "sim", "--steps", steps});
    EXPECT_EQ(result.exit_code, 2) << steps;
    EXPECT_NE(only_line(result).find("--steps"), std::string::npos);
  }
  const support::TempFolder folder;
  const auto limp = folder.write("limp.xml", R"(<mujoco><worldbody><body><joint name="j"/>
    <geom type="box" size="1 1 1"/></body></worldbody></mujoco>)");
  const auto result = mjarm({"bench", "sim", "--robot", limp.string()});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(only_line(result).find("actuator"), std::string::npos);
}

}  // namespace
}  // namespace mjarm::app
