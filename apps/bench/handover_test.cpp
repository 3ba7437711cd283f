// `mjarm bench ...` is `mjarm-bench ...`, wherever the global options stand.
#include <filesystem>

#include "apps/mjarm/commands/program_test.hpp"

namespace mjarm::app {
namespace {

const std::filesystem::path kBench =
    std::filesystem::path(MJARM_PROGRAM).parent_path() / "mjarm-bench";

TEST(Handover, IsTheSameProgram) {
  const auto alone = support::run_program(kBench, {"sim", "--help"});
  const auto handed = mjarm({"bench", "sim", "--help"});
  EXPECT_EQ(alone.exit_code, 0);
  EXPECT_NE(alone.out.find("Usage: mjarm bench sim"), std::string::npos) << alone.out;
  EXPECT_EQ(handed.out, alone.out);
  EXPECT_EQ(support::run_program(kBench, {"bench", "sim", "--help"}).out, alone.out);
}

TEST(Handover, GlobalOptionsMayStandBeforeIt) {
  const std::string chinese = mjarm({"bench", "sim", "--help", "--lang", "zh-CN"}).out;
  EXPECT_EQ(mjarm({"--lang", "zh-CN", "bench", "sim", "--help"}).out, chinese);
  EXPECT_EQ(mjarm({"--lang=zh-CN", "bench", "sim", "--help"}).out, chinese);
  EXPECT_EQ(mjarm({"--quiet", "bench", "sim", "--help"}).out,
            mjarm({"bench", "sim", "--help"}).out);
  EXPECT_NE(chinese, mjarm({"bench", "sim", "--help"}).out);
}

TEST(Handover, AValueThatIsCalledBenchIsNoCommand) {
  const support::TempFolder folder;
  const auto result =
      support::run_program(kBench, {"sim", "--robot", "bench", "--rounds", "1", "--steps", "9"},
                           {.folder = folder.path()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(only_line(result).find("\"bench\""), std::string::npos) << result.err;
}

TEST(Handover, MistakesKeepTheirExitCode) {
  const auto result = mjarm({"bench", "smi"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(only_line(result).find("sim"), std::string::npos);
  EXPECT_EQ(mjarm({"bench"}).exit_code, 2);
}

TEST(Handover, AProgramThatIsNotThereIsNamed) {
  const support::TempFolder folder;
  const std::filesystem::path lonely = folder.path() / "mjarm";
  std::filesystem::copy_file(MJARM_PROGRAM, lonely);
  const auto result = support::run_program(lonely, {"bench", "sim"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(only_line(result).find("mjarm-bench"), std::string::npos);
}

}  // namespace
}  // namespace mjarm::app
