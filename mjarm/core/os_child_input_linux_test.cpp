#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>

#include "mjarm/core/os_child_input.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

/// Runs a line of the shell.
Result<FedProgram> shell(const std::string& line) {
  return FedProgram::start("/bin/sh", {"-c", line});
}

TEST(FedProgram, GetsAllThatIsFed) {
  const support::TempFolder folder;
  const std::string file = (folder.path() / "got").string();
  std::string bytes(3'000'000, 'x');
  bytes[7] = '\0';
  Result<FedProgram> program = shell("cat > '" + file + "'");
  ASSERT_TRUE(program) << program.error().what;
  EXPECT_TRUE(program->feed(bytes));
  EXPECT_TRUE(program->feed("end"));
  const Result<FedProgramEnd> end = program->finish();
  ASSERT_TRUE(end) << end.error().what;
  EXPECT_EQ(end->exit_code, 0);
  EXPECT_EQ(end->complaints, "");
  EXPECT_EQ(folder.read("got"), bytes + "end");
}

TEST(FedProgram, OneThatEndsEarlyHarmsNobodyAndSaysWhy) {
  Result<FedProgram> program = shell("echo no room >&2; exit 3");
  ASSERT_TRUE(program);
  const std::string bytes(100'000, 'x');
  bool taken = true;
  for (int i = 0; i < 1000 && taken; ++i) taken = program->feed(bytes);
  EXPECT_FALSE(taken);
  const Result<FedProgramEnd> end = program->finish();
  ASSERT_TRUE(end);
  EXPECT_EQ(end->exit_code, 3);
  EXPECT_EQ(end->complaints, "no room\n");
}

TEST(FedProgram, KeepsTheEndOfLongComplaintsWithoutBlocking) {
  Result<FedProgram> program =
      shell("head -c 1000000 /dev/zero | tr '\\0' 'x' >&2; echo last >&2; cat > /dev/null");
  ASSERT_TRUE(program);
  EXPECT_TRUE(program->feed(std::string(1'000'000, 'y')));
  const Result<FedProgramEnd> end = program->finish();
  ASSERT_TRUE(end);
  EXPECT_EQ(end->complaints.size(), 65536U);
  EXPECT_TRUE(end->complaints.ends_with("xlast\n"));
}

TEST(FedProgram, TellsTheSignalThatEndedIt) {
  Result<FedProgram> program = shell("kill -TERM $$");
  ASSERT_TRUE(program);
  const Result<FedProgramEnd> end = program->finish();
  ASSERT_TRUE(end);
  EXPECT_EQ(end->exit_code, 128 + SIGTERM);
}

TEST(FedProgram, IsEndedWithItsObject) {
  const support::TempFolder folder;
  const std::string file = (folder.path() / "late").string();
  {
    Result<FedProgram> program = shell("cat > /dev/null; echo late > '" + file + "'");
    ASSERT_TRUE(program);
    EXPECT_TRUE(program->feed("words"));
  }
  EXPECT_FALSE(folder.exists("late"));
}

TEST(FedProgram, WorksWhereTheHostIgnoresTheEndOfProcesses) {
  const auto before = std::signal(SIGCHLD, SIG_IGN);
  Result<FedProgram> program = shell("cat > /dev/null");
  ASSERT_TRUE(program);
  EXPECT_TRUE(program->feed("words"));
  const Result<FedProgramEnd> end = program->finish();
  std::signal(SIGCHLD, before);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->exit_code, 0);
}

TEST(FedProgram, OneThatIsMissingIsNamed) {
  const Result<FedProgram> program = FedProgram::start("no-such-program-here", {});
  ASSERT_FALSE(program);
  EXPECT_EQ(program.error().code, Errc::not_available);
  EXPECT_NE(program.error().what.find("no-such-program-here"), std::string::npos);
}

TEST(FindProgram, LooksThroughPath) {
  const support::TempFolder folder;
  folder.write("plain", "words");
  const auto tool = folder.write("tool", "#!/bin/sh\n");
  std::filesystem::permissions(tool, std::filesystem::perms::owner_all);
  const std::string before = std::getenv("PATH") == nullptr ? "" : std::getenv("PATH");
  ::setenv("PATH", ("/nowhere:" + folder.path().string()).c_str(), 1);
  EXPECT_EQ(find_program("tool"), tool);
  EXPECT_EQ(find_program("plain"), "");
  EXPECT_EQ(find_program("sh"), "");
  ::setenv("PATH", before.c_str(), 1);
  EXPECT_NE(find_program("sh"), "");
}

}  // namespace
}  // namespace mjarm
