#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "mjarm/core/file.hpp"
#include "tests/support/own_display.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::app {
namespace {

support::ProgramResult mjarm_in(std::vector<std::string> arguments,
                                std::vector<std::pair<std::string, std::string>> environment = {}) {
  return support::run_program(MJARM_PROGRAM, arguments, {.environment = std::move(environment)});
}

TEST(ViewCommand, RefusesWhatMakesNoSense) {
  const auto refused = [](const std::vector<std::string>& arguments, const char* part) {
    const support::ProgramResult result = mjarm_in(arguments);
    EXPECT_EQ(result.exit_code, 2) << part;
    EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
    EXPECT_EQ(support::lines_of(result.err).size(), 1U) << result.err;
  };
  refused({"view"}, "mjarm view FILE");
  refused({"view", "ur5"}, "ur5e");
  refused({"view", "ur5e", "--size", "12x"}, "1280x720");
  refused({"view", "ur5e", "--size", "90000x800"}, "8192");
  refused({"view", "ur5e", "--quality", "best"}, "low");
  refused({"view", "ur5e", "--seconds", "-1"}, "--seconds");
  refused({"view", "ur5e", "--camera", "nose"}, "nose");
}

TEST(ViewCommand, WithoutADisplaySaysWhatElseThereIs) {
  const support::ProgramResult result =
      mjarm_in({"view", "ur5e"}, {{"DISPLAY", ""}, {"WAYLAND_DISPLAY", ""}});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("mjarm render"), std::string::npos) << result.err;
  EXPECT_EQ(support::lines_of(result.err).size(), 1U) << result.err;
}

TEST(ViewCommand, TheHelpListsEveryControlInBothLanguages) {
  const std::string english = mjarm_in({"view", "--help"}).out;
  for (const char* part : {"double click", "Ctrl-P", "Ctrl-T", "contact points", "Backspace"}) {
    EXPECT_NE(english.find(part), std::string::npos) << part;
  }
  EXPECT_NE(mjarm_in({"view", "--help", "--lang", "zh"}).out.find("接触点"), std::string::npos);
}

using OnADisplay = support::OwnDisplay;

TEST_F(OnADisplay, AWindowOpensDrawsAndCloses) {
  const support::ProgramResult result = mjarm_in(
      {"view", "ur5e", "--seconds", "1", "--stats", "--size", "640x400"}, {{"DISPLAY", display_}});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  int frames = 0;
  ASSERT_EQ(std::sscanf(result.out.c_str(), "%d frames", &frames), 1) << result.out;
  EXPECT_GE(frames, 1);
}

/// The window looks on: the log of a demo has the same bytes with and without it, whatever the user
/// does with the clock, be it shown as it goes (the tutorial's way) or as a program after it was
/// run. Closing it ends the program.
class DemoOnADisplay : public OnADisplay, public ::testing::WithParamInterface<bool> {};

std::string way_name(const ::testing::TestParamInfo<bool>& info) {
  return info.param ? "Guide" : "Program";
}

INSTANTIATE_TEST_SUITE_P(Ways, DemoOnADisplay, ::testing::Bool(), way_name);

TEST_P(DemoOnADisplay, AWindowNeverChangesTheLog) {
  static constexpr const char* kXdotool = "/usr/bin/xdotool";
  if (!std::filesystem::exists(kXdotool)) GTEST_SKIP() << "xdotool is not installed";
  const support::TempFolder folder;
  const auto arguments = [&](const char* name) {
    std::vector<std::string> words{"demo", "movej", "--seconds",
                                   "1.5",  "--out", (folder.path() / name).string()};
    if (GetParam()) words.emplace_back("--guide");
    return words;
  };
  support::ProgramResult seen;
  std::thread program([&] { seen = mjarm_in(arguments("seen"), {{"DISPLAY", display_}}); });
  const auto xdotool = [this](const std::vector<std::string>& words) {
    return support::run_program(kXdotool, words, {.environment = {{"DISPLAY", display_}}});
  };
  const auto found =
      xdotool({"search", "--sync", "--onlyvisible", "--limit", "1", "--name", "mjarm movej"});
  const std::string window = support::lines_of(found.out).at(0);
  xdotool({"windowfocus", "--sync", window, "key", "--delay", "60", "space", "Left", "Left",
           "Right", "minus", "space", "BackSpace", "plus", "Tab", "c"});
  const std::filesystem::path log = folder.path() / "seen" / "log.csv";
  // A program is run before it is shown.
  EXPECT_TRUE(GetParam() || std::filesystem::exists(log));
  for (int i = 0; i < 3000 && !std::filesystem::exists(log); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  // Until it is gone: on a busy machine a key may get lost between the programs.
  while (xdotool({"search", "--name", "mjarm movej"}).exit_code == 0) {
    xdotool({"windowfocus", window, "key", "Escape", "sleep", "0.3"});
  }
  program.join();
  std::vector<std::string> headless = arguments("unseen");
  headless.emplace_back("--headless");
  const support::ProgramResult unseen = mjarm_in(headless);
  EXPECT_EQ(seen.exit_code, unseen.exit_code) << seen.err;
  const Result<std::string> bytes = read_file(log);
  ASSERT_TRUE(bytes) << seen.err;
  EXPECT_GT(bytes->size(), 1000U);
  EXPECT_EQ(*bytes, read_file(folder.path() / "unseen" / "log.csv").value());
}

}  // namespace
}  // namespace mjarm::app
