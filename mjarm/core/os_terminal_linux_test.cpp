// What is shown on a terminal, seen from its other side.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <optional>
#include <string>
#include <thread>

#include "mjarm/core/log.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/progress.hpp"
#include "mjarm/core/text_width.hpp"

namespace mjarm {
namespace {

using ::testing::HasSubstr;

/// Standard error as a terminal of some width, for the life of this object.
class Terminal {
 public:
  explicit Terminal(unsigned short columns, const char* kind = "xterm") {
    if (const char* before = std::getenv("TERM")) term_before_ = before;
    ::setenv("TERM", kind, 1);
    far_ = ::posix_openpt(O_RDWR | O_NOCTTY);
    if (far_ < 0 || ::grantpt(far_) != 0 || ::unlockpt(far_) != 0) return;
    const int near = ::open(::ptsname(far_), O_RDWR | O_NOCTTY);
    if (near < 0) return;
    winsize size{};
    size.ws_col = columns;
    ::ioctl(near, TIOCSWINSZ, &size);
    stderr_before_ = ::dup(STDERR_FILENO);
    ::dup2(near, STDERR_FILENO);
    ::close(near);
  }
  ~Terminal() {
    if (stderr_before_ >= 0) {
      ::dup2(stderr_before_, STDERR_FILENO);
      ::close(stderr_before_);
    }
    if (far_ >= 0) ::close(far_);
    if (term_before_) {
      ::setenv("TERM", term_before_->c_str(), 1);
    } else {
      ::unsetenv("TERM");
    }
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  [[nodiscard]] bool works() const { return stderr_before_ >= 0; }
  /// All that was written so far.
  [[nodiscard]] std::string seen() const {
    std::string all;
    char buffer[4096];
    for (pollfd waiting{far_, POLLIN, 0}; ::poll(&waiting, 1, 50) > 0;) {
      const ssize_t count = ::read(far_, buffer, sizeof buffer);
      if (count <= 0) break;
      all.append(buffer, static_cast<std::size_t>(count));
    }
    return all;
  }

 private:
  std::optional<std::string> term_before_;
  int far_ = -1;
  int stderr_before_ = -1;
};

#define NEEDS_TERMINAL(terminal) \
  if (!(terminal).works()) GTEST_SKIP() << "no pseudo-terminal to be had here"

TEST(OnATerminal, ItsWidthIsKnown) {
  {
    const Terminal terminal(123);
    NEEDS_TERMINAL(terminal);
    EXPECT_TRUE(stderr_is_terminal());
    EXPECT_EQ(terminal_width(), 123);
  }
  const Terminal unknown(0);
  EXPECT_EQ(terminal_width(), 80);
}

TEST(OnATerminal, ADumbOneGetsNoCursorControl) {
  const Terminal terminal(80, "dumb");
  NEEDS_TERMINAL(terminal);
  EXPECT_FALSE(stderr_is_terminal());
}

TEST(OnATerminal, ALongJobShowsItsLineAndTakesItAway) {
  const Terminal terminal(60);
  NEEDS_TERMINAL(terminal);
  std::string drawn;
  {
    Progress progress("solving", 10);
    progress.advance(5);
    std::this_thread::sleep_for(std::chrono::milliseconds(520));
    progress.advance();
    drawn = terminal.seen();
    EXPECT_THAT(drawn, HasSubstr("solving ["));
    EXPECT_THAT(drawn, HasSubstr(" 60% 6/10 "));
    EXPECT_LE(text_width(drawn.substr(drawn.rfind('K') + 1)), 59);
  }
  EXPECT_EQ(terminal.seen(), "\r\x1b[2K");
}

TEST(OnATerminal, WhoWantsOnlyWarningsSeesNoProgress) {
  const Terminal terminal(60);
  NEEDS_TERMINAL(terminal);
  set_log_level(LogLevel::warning);
  {
    Progress progress("solving", 10);
    std::this_thread::sleep_for(std::chrono::milliseconds(520));
    progress.advance(5);
  }
  set_log_level(LogLevel::info);
  EXPECT_EQ(terminal.seen(), "");
}

TEST(OnATerminal, ALineOfProgressNeverWrapsAndItsBarOnlyGrows) {
  for (const char* label : {"solving", "求解逆运动学", ""}) {
    for (int width = 0; width <= 200; ++width) {
      std::size_t before = 0;
      for (std::uint64_t done = 0; done <= 1000; done += 50) {
        const std::string line = progress_line(label, done, 1000, 1.0 + 0.01 * width, width);
        const std::size_t open = line.find('[');
        if (open == std::string::npos) continue;  // no room for a bar
        EXPECT_LT(text_width(line), width) << line;
        const auto filled = static_cast<std::size_t>(std::count(line.begin(), line.end(), '#'));
        const auto empty = line.find(']') - open - 1 - filled;
        EXPECT_GE(filled + empty, 5U);
        EXPECT_LE(filled + empty, 40U);
        // The tail grows by a digit now and then, and the bar shrinks by it.
        EXPECT_GE(filled + 2, before) << line;
        EXPECT_EQ(filled == filled + empty, done == 1000) << line;
        before = filled;
      }
    }
  }
}

}  // namespace
}  // namespace mjarm
