#include "mjarm/model/mujoco_guard.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <filesystem>
#include <thread>

#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

TEST(MujocoGuard, TurnsAFatalErrorIntoAnOutcome) {
  const MujocoOutcome bad = call_mujoco([] { mju_error("broken %d", 7); });
  EXPECT_TRUE(bad.failed);
  EXPECT_EQ(bad.error, "broken 7");
  int reached = 0;
  const MujocoOutcome good = call_mujoco([&] { reached = 1; });
  EXPECT_FALSE(good.failed);
  EXPECT_EQ(reached, 1);
}

TEST(MujocoGuard, CollectsWarningsInOrder) {
  const MujocoOutcome outcome = call_mujoco([] {
    mju_warning("one");
    mju_warning("two");
  });
  EXPECT_FALSE(outcome.failed);
  EXPECT_EQ(outcome.warnings, (std::vector<std::string>{"one", "two"}));
}

TEST(MujocoGuard, NestsAndEndsTheInnerCallAlone) {
  bool went_on = false;
  MujocoOutcome inner;
  const MujocoOutcome outer = call_mujoco([&] {
    inner = call_mujoco([] { mju_error("inner"); });
    went_on = true;
    mju_warning("outer");
  });
  EXPECT_TRUE(inner.failed);
  EXPECT_TRUE(went_on);
  EXPECT_FALSE(outer.failed);
  EXPECT_EQ(outer.warnings, std::vector<std::string>{"outer"});
}

TEST(MujocoGuard, KeepsThreadsApart) {
  std::vector<std::thread> threads;
  std::vector<int> right(8, 0);
  for (int i = 0; i < 8; ++i) {
    threads.emplace_back([&right, i] {
      for (int n = 0; n < 200; ++n) {
        const MujocoOutcome outcome = call_mujoco([&] { mju_error("%d", i); });
        right[i] += outcome.failed && outcome.error == std::to_string(i) ? 1 : 0;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const int count : right) EXPECT_EQ(count, 200);
}

TEST(MujocoGuard, NoLogFileIsWritten) {
  const support::TempFolder folder;
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  (void)call_mujoco([] { mju_error("error"); });
  install_mujoco_handler();
  mju_warning("a warning outside of any guarded call goes to the log");
  std::filesystem::current_path(before);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

// Without a guard there is nothing to return to; the process ends with one line and code 1.
TEST(MujocoGuardDeathTest, ErrorOutsideOfAnyCallIsOneLine) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        install_mujoco_handler();
        mju_error("nobody listens");
      },
      ::testing::ExitedWithCode(1), "MuJoCo.*nobody listens");
}

}  // namespace
}  // namespace mjarm
