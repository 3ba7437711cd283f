#include <gtest/gtest.h>

#include "mjarm/core/os.hpp"
#include "mjarm/core/os_child_input.hpp"
#include "mjarm/core/os_child_program.hpp"
#include "mjarm/core/os_lock.hpp"
#include "mjarm/core/os_program.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

ChildResult run(const std::string& line, const ChildLimits& limits = {}) {
  return run_child_program("cmd.exe", {"/c", line}, "", limits).value();
}

TEST(ChildProgram, SaysWhatItHasToSay) {
  const ChildResult result = run("echo hello");
  EXPECT_EQ(result.end, ChildEnd::done);
  EXPECT_EQ(result.said.substr(0, 5), "hello");
}

TEST(ChildProgram, MayEndBadly) {
  const ChildResult result = run("exit 7");
  EXPECT_EQ(result.end, ChildEnd::crashed);
  EXPECT_EQ(result.signal, 7);
}

TEST(ChildProgram, MayNotWaitForever) {
  EXPECT_EQ(run("ping -n 60 127.0.0.1", {.idle_seconds = 0.5}).end, ChildEnd::stuck);
}

TEST(ChildProgram, MayNotComputeForever) {
  const ChildResult result =
      run("for /L %i in (1,0,2) do @rem", {.cpu_seconds = 0.5, .idle_seconds = 3});
  // Wine tells the time of the process that asks in the place of the other's.
  EXPECT_TRUE(result.end == ChildEnd::out_of_time || result.end == ChildEnd::stuck);
}

TEST(ChildProgram, IsAnErrorWhereThereIsNone) {
  EXPECT_FALSE(run_child_program("no such program.exe", {}, ""));
}

TEST(RunProgram, GivesTheExitCode) {
  EXPECT_EQ(run_program("cmd.exe", {"/c", "exit 7"}).value(), 7);
  EXPECT_FALSE(run_program("no such program.exe", {}));
}

TEST(FedProgram, IsKnownByItsExitCode) {
  Result<FedProgram> program = FedProgram::start("cmd.exe", {"/c", "exit 3"});
  ASSERT_TRUE(program) << program.error().what;
  EXPECT_EQ(program->finish().value().exit_code, 3);
  const Result<FedProgram> none = FedProgram::start("no such program.exe", {});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Errc::not_available);
}

TEST(FindProgram, KnowsEndings) {
  EXPECT_FALSE(find_program("cmd").empty());
  EXPECT_TRUE(find_program("no such program").empty());
}

TEST(FolderLock, IsHeldByOne) {
  const support::TempFolder folder;
  {
    const auto first = FolderLock::try_lock(folder.path());
    ASSERT_TRUE(first && *first);
    EXPECT_FALSE(FolderLock::try_lock(folder.path()).value());
  }
  EXPECT_TRUE(FolderLock::try_lock(folder.path()).value());
  EXPECT_FALSE(FolderLock::try_lock(folder.path() / "none"));
}

TEST(UserFolders, StandInThatOfTheUser) {
  const auto folder = user_folder("MJARM_NO_SUCH_VARIABLE", ".cache");
  ASSERT_TRUE(folder);
  EXPECT_TRUE(folder->is_absolute());
}

}  // namespace
}  // namespace mjarm
