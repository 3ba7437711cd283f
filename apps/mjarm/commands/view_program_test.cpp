// mjarm view PROGRAM, as a user calls it.
#include <gmock/gmock.h>

#include <cstdio>
#include <cstdlib>

#include "apps/mjarm/commands/program_test.hpp"
#include "mjarm/view/turn_test.hpp"

namespace mjarm::app {
namespace {

using ::testing::HasSubstr;

TEST(ViewProgram, FaultsAreThoseOfRun) {
  const support::TempFolder folder;
  const std::string cannot = folder
                                 .write("far.yaml", R"(robot: ur5e
program:
  - movej: {pos: [0.1, -1.45, 0.4], euler: [180deg, 0, 0]}
)")
                                 .string();
  const std::string wrong = folder.write("wrong.yml", "robot: ur5e\n").string();
  for (const auto& [file, code] :
       {std::pair{cannot, 1}, {wrong, 2}, {std::string("none.yaml"), 2}}) {
    const auto seen = app::mjarm({"view", file});
    EXPECT_EQ(seen.exit_code, code) << file;
    EXPECT_EQ(only_line(seen), only_line(app::mjarm({"run", file}))) << file;
  }
}

TEST(ViewProgram, RefusesWhatIsForModels) {
  const auto result = app::mjarm({"view", "movej", "--passive"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(only_line(result), HasSubstr("--passive"));
  EXPECT_EQ(app::mjarm({"view", "movej", "--tip", "tool0"}).exit_code, 2);
  EXPECT_EQ(app::mjarm({"view", "movej", "--size", "no"}).exit_code, 2);
}

TEST(ViewProgram, WithoutADisplaySaysWhatElseThereIs) {
  const auto result =
      app::mjarm({"view", "movej"}, {.environment = {{"DISPLAY", ""}, {"WAYLAND_DISPLAY", ""}}});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(only_line(result), HasSubstr("mjarm render"));
}

TEST(ViewProgram, AWindowOpensDrawsAndCloses) {
  if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "DISPLAY is not set";
  const testing::Turn turn;
  const auto result = app::mjarm({"view", "movej", "--seconds", "1", "--stats", "--paused"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  int frames = 0;
  ASSERT_EQ(std::sscanf(result.out.c_str(), "%d frames", &frames), 1) << result.out;
  EXPECT_GE(frames, 1);
}

}  // namespace
}  // namespace mjarm::app
