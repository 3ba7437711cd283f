#include "mjarm/core/long_result.hpp"

#include <gmock/gmock.h>
#if !defined(_WIN32)
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#endif

#include <string>

#include "mjarm/core/file.hpp"
#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/os_file_note.hpp"
#include "mjarm/core/output_folder.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class LongResults : public ::testing::Test {
 protected:
  void SetUp() override {
    set_file_note(temp_.path(), "probe", "yes");
    if (!file_note(temp_.path(), "probe")) GTEST_SKIP() << "the file system keeps no notes";
  }
  bool is_kept(const fs::path& path, bool overwrite = false) const {
    return !LongResult::begin(path, {.overwrite = overwrite});
  }

  LanguageScope english_{Language::english};
  support::TempFolder temp_;
};

TEST_F(LongResults, AreNotReplacedUnasked) {
  const fs::path file = temp_.write("out.json", "{}");
  EXPECT_FALSE(is_kept(file));
  note_work(file, 81.4);
  const auto second = LongResult::begin(file, {});
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, Errc::usage);
  EXPECT_EQ(second.error().what, file.string() +
                                     ": took 81 s to make: replace it with --overwrite, or take "
                                     "another --out");
  EXPECT_FALSE(is_kept(file, true));
}

TEST_F(LongResults, ShortOnesAreAndEndTheNote) {
  const fs::path file = temp_.write("out.json", "{}");
  note_work(file, 60);
  EXPECT_FALSE(is_kept(file));
  note_work(file, 61);
  EXPECT_TRUE(is_kept(file));
  const auto again = LongResult::begin(file, {.overwrite = true});
  ASSERT_TRUE(again);
  again->made();  // at once
  EXPECT_FALSE(is_kept(file));
}

TEST_F(LongResults, TheNoteGoesWithTheFileAndEndsWithIt) {
  const fs::path file = temp_.write("a", "{}"), other = temp_.path() / "b";
  note_work(file, 100);
  fs::rename(file, other);
  EXPECT_TRUE(is_kept(other));
  EXPECT_FALSE(is_kept(file)) << "nothing stands there";
  ASSERT_TRUE(write_file(other, "new"));
  EXPECT_FALSE(is_kept(other)) << "another file of that name";
}

TEST_F(LongResults, FoldersAreKeptAsLongAsSomethingIsInThem) {
  const fs::path folder = temp_.path() / "run";
  {
    const auto held = OutputFolder::open(folder);
    ASSERT_TRUE(held);
    ASSERT_TRUE(write_file(folder / "report.json", "{}"));
    held->made();
  }
  EXPECT_TRUE(OutputFolder::open(folder)) << "it took no minute";
  note_work(folder, 3600);
  const auto second = OutputFolder::open(folder);
  ASSERT_FALSE(second);
  EXPECT_THAT(second.error().what, HasSubstr("3600 s"));
  EXPECT_TRUE(OutputFolder::open(folder, {.overwrite = true}));
  fs::remove(folder / "report.json");
  EXPECT_TRUE(OutputFolder::open(folder));
}

TEST_F(LongResults, WhatIsNoFileKeepsNothing) {
  note_work("/dev/null", 100);
  for (const char* path : {"", "/dev/null", "/no/such/file"}) EXPECT_FALSE(is_kept(path)) << path;
}

/// Waiting is no work: a window that stood open an hour keeps no result from being replaced.
TEST(WorkClock, CountsNoTimeOfWaiting) {
  const WorkClock clock;
  const Stopwatch watch;
  ::usleep(200'000);
  EXPECT_LT(clock.seconds(), 1e-6 * watch.us() - 0.1);
  const double before = clock.seconds();
  while (clock.seconds() < before + 0.05) {
  }
  EXPECT_LE(clock.seconds(), 1e-6 * watch.us());
}

#if defined(__linux__)
/// On a busy machine the user waits as long, whoever has the core.
TEST(WorkClock, CountsTheTimeInWhichOthersHaveTheCore) {
  cpu_set_t before, one;
  CPU_ZERO(&one);
  ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
  for (int core = 0; CPU_COUNT(&one) == 0; ++core) {
    if (CPU_ISSET(core, &before)) CPU_SET(core, &one);
  }
  ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
  const pid_t other = fork();
  if (other == 0) {
    for (;;) {
    }
  }
  const WorkClock clock;
  const Stopwatch watch;
  const double cpu = cpu_seconds(), busy = busy_seconds();
  while (watch.us() < 600'000) {
  }
  const double seconds = 1e-6 * watch.us(), used = cpu_seconds() - cpu;
  const double both = busy_seconds() - busy, counted = clock.seconds();
  kill(other, SIGKILL);
  waitpid(other, nullptr, 0);
  EXPECT_EQ(sched_setaffinity(0, sizeof before, &before), 0);
  if (both < used + 0.01)
    GTEST_SKIP() << "the system does not tell how long a process waits for a core";
  EXPECT_LT(used, 0.8 * seconds);
  EXPECT_GT(counted, 0.9 * seconds);
  EXPECT_LE(counted, seconds + 0.05);
}
#endif

}  // namespace
}  // namespace mjarm
