// mjarm teleop, as a user calls it.
#include <gmock/gmock.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "apps/mjarm/commands/program_test.hpp"
#include "tests/support/own_display.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::app {
namespace {

using ::testing::HasSubstr;

constexpr const char* kTeleopScene = "franka_emika_panda/pick.xml";
constexpr const char* kDown =
    "time,vx,vy,vz,wx,wy,wz,gripper\n0,0,0,-0.25,0,0,0,0\n3,0,0,0,0,0,0,0\n";

TEST(TeleopCommand, PlaysInputsAndStopsAboveTheTable) {
  const support::TempFolder folder;
  const std::string input = folder.write("down.csv", kDown).string();
  const std::string out = (folder.path() / "out").string();
  const std::vector<std::string> words = {"teleop", kTeleopScene, "--headless", "--input",    input,
                                          "--out",  out,          "--json",     "--no-timing"};
  const auto played = mjarm(words);
  ASSERT_EQ(played.exit_code, 0) << played.err;
  const auto report = nlohmann::json::parse(played.out);
  EXPECT_EQ(report.at("ok"), true);
  EXPECT_GT(report.at("slowed"), 0.5);
  EXPECT_LT(report.at("nearest").at("distance"), 0.007);
  EXPECT_GT(report.at("nearest").at("distance"), 0.002);
  EXPECT_EQ(folder.read("out/report.json"), played.out);
  const std::string log = folder.read("out/log.csv");
  EXPECT_EQ(mjarm(words).exit_code, 0) << "a second time into the same folder";
  EXPECT_EQ(folder.read("out/log.csv"), log);
}

TEST(TeleopCommand, WithoutTheGuardItTouchesAndSaysSo) {
  const support::TempFolder folder;
  const std::string input = folder.write("down.csv", kDown).string();
  const auto played = mjarm({"teleop", kTeleopScene, "--headless", "--input", input, "--no-guard"});
  EXPECT_EQ(played.exit_code, 1);
  EXPECT_THAT(played.err, HasSubstr("the arm touched something"));
}

TEST(TeleopCommand, RefusesInOneLine) {
  const support::TempFolder folder;
  const std::string bad = folder.write("bad.csv", "0,1,2\n").string();
  const auto refused = [](const std::vector<std::string>& words, const char* part) {
    const auto result = mjarm(words);
    EXPECT_EQ(result.exit_code, 2) << part;
    EXPECT_THAT(result.err, HasSubstr(part));
    EXPECT_EQ(support::lines_of(result.err).size(), 1U) << result.err;
  };
  refused({"teleop"}, "mjarm teleop panda");
  refused({"teleop", "pandaa"}, "panda");
  refused({"teleop", "panda", "--headless"}, "--input");
  refused({"teleop", "panda", "--input", bad}, "--headless");
  refused({"teleop", "panda", "--headless", "--input", bad}, "bad.csv:1");
  refused({"teleop", "panda", "--headless", "--input", "nowhere.csv"}, "nowhere.csv");
  refused({"teleop", "panda", "--frame", "hand"}, "world");
  refused({"teleop", "panda", "--speed", "0"}, "--speed");
  refused({"teleop", "panda", "--margin", "x"}, "--margin");
  refused({"teleop", "panda", "--fps", "0"}, "--fps");
  refused({"teleop", "panda", "--task", "wave"}, "--out");
}

TEST(TeleopCommand, TheHelpListsTheKeysInBothLanguages) {
  EXPECT_THAT(mjarm({"teleop", "--help"}).out, HasSubstr("the last 3 s once more"));
  EXPECT_THAT(mjarm({"teleop", "--help", "--lang", "zh"}).out, HasSubstr("退回 3 s 重来"));
}

/// With a stand-in for the user.
class TeleopOnADisplay : public support::OwnDisplay {
 protected:
  void SetUp() override {
    if (std::system("command -v xdotool >/dev/null") != 0) GTEST_SKIP() << "no xdotool";
    OwnDisplay::SetUp();
  }
  bool user(const std::string& words) const {
    return std::system(("DISPLAY=" + display_ + " timeout 20 xdotool " + words).c_str()) == 0;
  }
};

TEST_F(TeleopOnADisplay, KeysLeadRecordAndKeep) {
  const support::TempFolder folder;
  const std::string out = (folder.path() / "demos").string();
  support::ProgramResult result;
  std::thread program([&] {
    result = support::run_program(MJARM_PROGRAM,
                                  {"teleop", kTeleopScene, "--out", out, "--task", "up", "--size",
                                   "320x240", "--quality", "low", "--json", "--seconds", "60"},
                                  {.environment = {{"DISPLAY", display_}}});
  });
  const auto file = std::filesystem::path(out) / "episode_000000.zip";
  bool seen = false;
  for (int i = 0; i < 60 && !seen; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(250));
    seen = user("search --sync --onlyvisible --name 'mjarm teleop' windowfocus >/dev/null 2>&1");
  }
  EXPECT_TRUE(seen);
  for (int i = 0; i < 8 && !std::filesystem::exists(file); ++i) {
    user("key r keydown q sleep 1 keyup q key space sleep 1 key k sleep 1");
  }
  user("key Escape");
  program.join();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  ASSERT_TRUE(std::filesystem::exists(file));
  const auto told = nlohmann::json::parse(result.out);
  EXPECT_GE(told.at("latency").at("count"), 1);  // keys that come within a picture count as one
  EXPECT_GT(told.at("latency").at("mean"), 0);
  // What was done there can be played again, and went upwards.
  const std::string again = (folder.path() / "again").string();
  const auto played = mjarm({"teleop", kTeleopScene, "--headless", "--input", out + "/inputs.csv",
                             "--out", again, "--json"});
  ASSERT_EQ(played.exit_code, 0) << played.err;
  EXPECT_GT(nlohmann::json::parse(played.out).at("way"), 0.02);
}

}  // namespace
}  // namespace mjarm::app
