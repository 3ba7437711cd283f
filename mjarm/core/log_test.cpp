#include "mjarm/core/log.hpp"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "mjarm/core/progress.hpp"
#include "mjarm/core/progress_sink.hpp"
#include "tests/support/run_program.hpp"

namespace mjarm {
namespace {

using ::testing::internal::CaptureStderr;
using ::testing::internal::GetCapturedStderr;

class Log : public ::testing::Test {
 protected:
  ~Log() override { set_log_level(LogLevel::info); }
};

std::string say_everything() {
  CaptureStderr();
  log_debug("one");
  log_info("two");
  log_warning("three");
  log_error("f.json:4: four");
  return GetCapturedStderr();
}

TEST_F(Log, LevelsDecideWhatIsSaid) {
  EXPECT_EQ(log_level(), LogLevel::info);
  EXPECT_EQ(say_everything(), "two\nwarning: three\nf.json:4: four\n");
  set_log_level(LogLevel::debug);
  EXPECT_EQ(log_level(), LogLevel::debug);
  EXPECT_EQ(say_everything(), "one\ntwo\nwarning: three\nf.json:4: four\n");
  set_log_level(LogLevel::warning);
  EXPECT_EQ(say_everything(), "warning: three\nf.json:4: four\n");
  set_log_level(LogLevel::error);
  EXPECT_EQ(log_level(), LogLevel::error);
  EXPECT_EQ(say_everything(), "f.json:4: four\n");
}

TEST_F(Log, OneMessageIsOneLine) {
  CaptureStderr();
  log_info("first\nsecond\r\nthird\n");
  log_info("");
  log_info("{} {not a format} %s");
  EXPECT_EQ(GetCapturedStderr(), "first second  third\n\n{} {not a format} %s\n");
}

TEST_F(Log, LinesOfThreadsStayWhole) {
  CaptureStderr();
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([i] {
      for (int k = 0; k < 200; ++k) log_info(std::string(50, static_cast<char>('a' + i)));
    });
  }
  for (std::thread& thread : threads) thread.join();
  const std::vector<std::string> lines = support::lines_of(GetCapturedStderr());
  ASSERT_EQ(lines.size(), 800u);
  for (const std::string& line : lines) ASSERT_EQ(line, std::string(50, line.at(0)));
}

TEST_F(Log, StatusLineGivesWayToMessages) {
  CaptureStderr();
  show_status("50%");
  log_info("message");
  show_status("");
  EXPECT_EQ(GetCapturedStderr(), "\r\x1b[2K50%\r\x1b[2Kmessage\n50%\r\x1b[2K");
}

TEST(Progress, LineFitsTheTerminal) {
  const std::string line = progress_line("solving", 50, 200, 10, 80);
  EXPECT_EQ(line, "solving [##########..............................]  25% 50/200 5.0/s 0:30 left");
  EXPECT_LE(progress_line("solving", 50, 200, 10, 60).size(), 59u);
  EXPECT_EQ(progress_line("solving", 50, 200, 10, 20), "solving  25% 50/200 5.0/s 0:30 left");
  EXPECT_EQ(progress_line("solving", 50, 0, 10, 80), "solving 50 5.0/s");
}

TEST(Progress, OddNumbersAreHarmless) {
  EXPECT_NE(progress_line("x", 0, 200, 0, 80).find("  0% 0/200"), std::string::npos);
  EXPECT_NE(progress_line("x", 300, 200, 1, 80).find("100% 300/200"), std::string::npos);
  EXPECT_NE(progress_line("x", 1, 1000000, 1000, 80).find("99:59:59"), std::string::npos);
}

TEST(Progress, GoesWhereAProgramWantsIt) {
  std::vector<std::string> lines;
  set_progress_sink([&lines](const std::string& line) { lines.push_back(line); });
  CaptureStderr();
  {
    Progress progress("solving", 100);
    progress.advance(25);  // too soon to be shown
    std::this_thread::sleep_for(std::chrono::milliseconds(550));
    progress.advance(25);
  }
  set_progress_sink({});
  EXPECT_EQ(GetCapturedStderr(), "");
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_NE(lines[0].find(" 50% 50/100"), std::string::npos);
  EXPECT_EQ(lines[1], "");
}

TEST(Progress, SilentWhereStderrIsNoTerminal) {
  CaptureStderr();
  {
    Progress progress("solving", 100);
    for (int i = 0; i < 100; ++i) progress.advance();
  }
  EXPECT_EQ(GetCapturedStderr(), "");
}

}  // namespace
}  // namespace mjarm
