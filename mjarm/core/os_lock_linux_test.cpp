#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "mjarm/core/os_lock.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

TEST(FolderLock, IsHeldByOneAtATime) {
  const support::TempFolder folder;
  {
    const auto first = FolderLock::try_lock(folder.path());
    ASSERT_TRUE(first && *first);
    const auto second = FolderLock::try_lock(folder.path());
    ASSERT_TRUE(second);
    EXPECT_FALSE(*second);
  }
  const auto third = FolderLock::try_lock(folder.path());
  EXPECT_TRUE(third && *third);
}

TEST(FolderLock, EndsWithAKilledProcess) {
  const support::TempFolder folder;
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t child = fork();
  if (child == 0) {
    const auto lock = FolderLock::try_lock(folder.path());
    const char held = lock && *lock ? 'y' : 'n';
    if (write(ready[1], &held, 1) != 1) _exit(1);
    for (;;) pause();
  }
  char held = 0;
  ASSERT_EQ(read(ready[0], &held, 1), 1);
  EXPECT_EQ(held, 'y');
  const auto while_held = FolderLock::try_lock(folder.path());
  ASSERT_TRUE(while_held);
  EXPECT_FALSE(*while_held);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  const auto afterwards = FolderLock::try_lock(folder.path());
  EXPECT_TRUE(afterwards && *afterwards);
  close(ready[0]);
  close(ready[1]);
}

TEST(FolderLock, NeedsAFolder) {
  const support::TempFolder folder;
  const auto lock = FolderLock::try_lock(folder.path() / "none");
  ASSERT_FALSE(lock);
  EXPECT_NE(lock.error().what.find("none"), std::string::npos);
}

}  // namespace
}  // namespace mjarm
