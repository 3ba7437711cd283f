#include <gtest/gtest.h>

#include "mjarm/core/os_program.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

TEST(RunProgram, GivesTheExitCode) {
  EXPECT_EQ(run_program("sh", {"-c", "exit 0"}).value(), 0);
  EXPECT_EQ(run_program("/bin/sh", {"-c", "exit 7"}).value(), 7);
  EXPECT_EQ(run_program("sh", {"-c", "kill -9 $$"}).value(), 128 + 9);
}

TEST(RunProgram, PassesWordsAsTheyAre) {
  const support::TempFolder folder;
  const std::string file = (folder.path() / "out").string();
  EXPECT_EQ(
      run_program("sh", {"-c", "printf '%s' \"$2\" > \"$1\"", "sh", file, "a b'$HOME\""}).value(),
      0);
  EXPECT_EQ(folder.read("out"), "a b'$HOME\"");
}

TEST(RunProgram, NamesWhatCannotBeStarted) {
  const auto result = run_program("/no/such/program", {});
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, Errc::system);
  EXPECT_NE(result.error().what.find("/no/such/program"), std::string::npos);
}

}  // namespace
}  // namespace mjarm
