#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <thread>
#include <vector>

#include "mjarm/core/os_child.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

using support::kSanitized;

TEST(Child, SaysAnything) {
  const std::string words = std::string(3'000'000, 'x') + '\0' + "\x04 end";
  const auto result = run_in_child([&](const ChildVoice& voice) { voice.send(words); });
  ASSERT_TRUE(result) << result.error().what;
  EXPECT_EQ(result->end, ChildEnd::done);
  EXPECT_EQ(result->said, words);
}

TEST(Child, TellsHowFarItCameBeforeItCrashed) {
  for (const int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGKILL}) {
    const auto result = run_in_child([&](const ChildVoice& voice) {
      voice.send("half");
      ::kill(::getpid(), signal);
    });
    ASSERT_TRUE(result);
    EXPECT_EQ(result->end, ChildEnd::crashed);
    EXPECT_EQ(result->signal, signal);
    EXPECT_EQ(result->said, "half");
  }
}

TEST(Child, AnExceptionOrAnExitIsACrash) {
  const auto thrown = run_in_child([](const ChildVoice&) { throw 1; });
  ASSERT_TRUE(thrown);
  EXPECT_EQ(thrown->end, ChildEnd::crashed);
  const auto left = run_in_child([](const ChildVoice&) { ::_exit(0); });
  ASSERT_TRUE(left);
  EXPECT_EQ(left->end, ChildEnd::crashed);
}

TEST(Child, NeverEndsLaterThanItMay) {
  const auto busy = run_in_child(
      [](const ChildVoice&) {
        for (volatile bool forever = true; forever;) {
        }
      },
      {.cpu_seconds = 1});
  ASSERT_TRUE(busy);
  EXPECT_EQ(busy->end, ChildEnd::out_of_time);
}

TEST(Child, WaitingIsTimeAsWell) {
  const auto idle = run_in_child([](const ChildVoice&) { ::pause(); }, {.idle_seconds = 0.3});
  ASSERT_TRUE(idle);
  EXPECT_EQ(idle->end, ChildEnd::stuck);
}

TEST(Child, MemoryIsBounded) {
  if (kSanitized) GTEST_SKIP() << "a sanitizer holds the address space";
  const auto result = run_in_child(
      [](const ChildVoice& voice) {
        try {
          const std::vector<char> much(std::size_t{1} << 28);
          voice.send("got it");
        } catch (const std::bad_alloc&) {
          voice.send("refused");
        }
      },
      {.memory = std::size_t{1} << 26});
  ASSERT_TRUE(result);
  EXPECT_EQ(result->said, "refused");
}

TEST(Child, SaysNoMoreThanItMay) {
  const auto result = run_in_child(
      [](const ChildVoice& voice) {
        for (int i = 0; i < 1000; ++i) voice.send(std::string(10'000, 'x'));
      },
      {.answer = 100'000});
  ASSERT_TRUE(result);
  EXPECT_EQ(result->end, ChildEnd::too_long);
}

TEST(Child, WritesNoFileAndIsSilent) {
  const support::TempFolder folder;
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const auto result = run_in_child([&](const ChildVoice& voice) {
    std::puts("out");
    std::fputs("err", stderr);
    std::fflush(stdout);
    ::signal(SIGXFSZ, SIG_IGN);
    std::ofstream file(folder.path() / "stray");
    file << "words" << std::flush;
    voice.send(file ? "written" : "refused");
  });
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  ASSERT_TRUE(result);
  EXPECT_EQ(result->said, "refused");
}

TEST(Child, ManyThreadsMayHaveSome) {
  std::vector<std::thread> threads;
  std::vector<int> right(4, 0);
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&right, i] {
      for (int n = 0; n < 20; ++n) {
        const std::string words(static_cast<std::size_t>(10'000 * i + n), 'x');
        const auto result = run_in_child([&](const ChildVoice& voice) { voice.send(words); });
        right[i] += result && result->end == ChildEnd::done && result->said == words ? 1 : 0;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(right, std::vector<int>(4, 20));
}

TEST(Child, WorksWhereTheHostIgnoresTheEndOfProcesses) {
  const auto before = std::signal(SIGCHLD, SIG_IGN);
  const auto result = run_in_child([](const ChildVoice& voice) { voice.send("here"); });
  std::signal(SIGCHLD, before);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->end, ChildEnd::done);
  EXPECT_EQ(result->said, "here");
}

}  // namespace
}  // namespace mjarm
