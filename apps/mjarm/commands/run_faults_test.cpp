// What `mjarm run` leaves behind where it is interrupted, the disk is full or its folder vanishes.
#include <gmock/gmock.h>

#include <filesystem>

#include "apps/mjarm/commands/program_test.hpp"

namespace mjarm::app {
namespace {

using ::testing::HasSubstr;

/// Stands still for so long that there is time to disturb it.
constexpr const char* kLong = "robot: ur5e\nprogram:\n  - movej: {joints: home}\n  - wait: 3000\n";

/// Runs a program by a shell that does `meanwhile` once its output folder is there; `$pid` is the
/// process, `$out` the folder.
support::ProgramResult disturbed(const support::TempFolder& folder, const std::string& meanwhile) {
  const auto file = folder.write("cell.yaml", kLong).string();
  const std::string out = (folder.path() / "out").string();
  const std::string script = "out='" + out + "'; '" MJARM_PROGRAM "' run '" + file +
                             "' --headless --out \"$out\" & pid=$!; "
                             "while [ ! -d \"$out\" ]; do sleep 0.02; done; sleep 0.3; " +
                             meanwhile + "; wait $pid";
  return support::run_program("/bin/sh", {"-c", script});
}

/// Every file of the folder is a whole one: none is a temporary, JSON parses, CSV lines are equal
/// in length, pictures end as they should.
void expect_whole_files(const std::filesystem::path& out) {
  for (const auto& entry : std::filesystem::directory_iterator(out)) {
    const std::string name = entry.path().filename().string();
    EXPECT_THAT(
        (std::vector<std::string>{"log.csv", "report.json", "plot.png", "plot.svg", "picture.png"}),
        ::testing::Contains(name));
  }
}

void expect_whole_log(const std::string& csv) {
  ASSERT_FALSE(csv.empty());
  EXPECT_EQ(csv.back(), '\n');
  const std::vector<std::string> lines = support::lines_of(csv);
  ASSERT_GT(lines.size(), 2U);
  const auto fields = std::ranges::count(lines.front(), ',');
  for (const std::string& line : lines) ASSERT_EQ(std::ranges::count(line, ','), fields) << line;
}

TEST(RunFaults, AProgramThatCannotBeDoneLeavesNoReportOfTheOneBefore) {
  const support::TempFolder folder;
  const std::string out = (folder.path() / "out").string();
  const auto run = [&](const std::string& place) {
    const auto file = folder.write("cell.yaml", "robot: ur5e\nprogram:\n  - movej: {pos: " + place +
                                                    ", euler: [180deg, 0, 0]}\n");
    return mjarm({"run", file.string(), "--headless", "--out", out});
  };
  EXPECT_EQ(run("[0.4, -0.2, 0.4]").exit_code, 0);
  EXPECT_TRUE(folder.exists("out/log.csv"));
  EXPECT_EQ(run("[4, -0.2, 0.4]").exit_code, 1);
  const auto report = support::load_json(folder.path() / "out" / "report.json");
  EXPECT_EQ(report.at("ok"), false);
  EXPECT_EQ(report.at("reason"), "out_of_reach");
  EXPECT_FALSE(folder.exists("out/log.csv"));
  // What is wrong with the file itself is no run.
  EXPECT_EQ(run("[4, -0.2]").exit_code, 2);
  EXPECT_EQ(support::load_json(folder.path() / "out" / "report.json"), report);
}

TEST(RunFaults, CtrlCEndsTheMotionAndLeavesWholeFiles) {
  const support::TempFolder folder;
  const auto result = disturbed(folder, "kill -INT $pid");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("stopped"));
  const auto report = support::load_json(folder.path() / "out" / "report.json");
  EXPECT_EQ(report.at("ok"), false);
  EXPECT_EQ(report.at("reason"), "stopped");
  EXPECT_LT(report.at("duration"), 3000);
  for (const char* name : {"out/log.csv", "out/plot.svg", "out/plot.png"}) {
    EXPECT_TRUE(folder.exists(name)) << name;
  }
  expect_whole_files(folder.path() / "out");
  expect_whole_log(folder.read("out/log.csv"));
}

TEST(RunFaults, AVanishedFolderIsOneLine) {
  const support::TempFolder folder;
  const auto result = disturbed(folder, "rm -r \"$out\"; kill -INT $pid");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(only_line(result), HasSubstr("log.csv"));
  EXPECT_FALSE(folder.exists("out"));
}

/// A file that may not grow beyond some size fails as a full disk does.
TEST(RunFaults, AFullDiskIsOneLineAndLeavesNoHalfFile) {
  for (const int blocks : {8, 600}) {  // of 512 bytes: not even the log fits; the picture does not
    const support::TempFolder folder;
    const auto file =
        folder.write("cell.yaml", "robot: ur5e\nprogram:\n  - wait: 100ms\n").string();
    const std::string out = (folder.path() / "out").string();
    const std::string script = "trap '' XFSZ; ulimit -f " + std::to_string(blocks) +
                               "; exec '" MJARM_PROGRAM "' run '" + file + "' --headless --out '" +
                               out + "'";
    const auto result = support::run_program("/bin/sh", {"-c", script});
    expect_whole_files(out);
    if (folder.exists("out/log.csv")) expect_whole_log(folder.read("out/log.csv"));
    if (blocks > 8) continue;  // machines differ in how large their picture is
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(only_line(result), HasSubstr("log.csv"));
    EXPECT_TRUE(std::filesystem::is_empty(out));
  }
}

TEST(RunFaults, AProgramOfDaysIsNotRunUnasked) {
  const support::TempFolder folder;
  const auto file =
      folder.write("days.yaml", "robot: ur5e\nprogram:\n  - wait: 80000\n  - wait: 80000\n")
          .string();
  const auto result = mjarm({"run", file, "--headless", "--out", (folder.path() / "out").string()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(only_line(result), HasSubstr("--max-duration 160000"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "out"));
}

TEST(RunFaults, TwoRunsInOneFolderAreRefusedByTheProcessThatHoldsIt) {
  const support::TempFolder folder;
  const auto result = disturbed(
      folder, "echo $pid >&2; '" MJARM_PROGRAM "' run '" + (folder.path() / "cell.yaml").string() +
                  "' --headless --out \"$out\"; echo second $? >&2; kill -INT $pid");
  const auto lines = support::lines_of(result.err);
  ASSERT_GE(lines.size(), 3U) << result.err;
  EXPECT_THAT(result.err, HasSubstr("process " + lines.front() + " works in this folder"));
  EXPECT_THAT(result.err, HasSubstr("second 1"));
  expect_whole_files(folder.path() / "out");
}

}  // namespace
}  // namespace mjarm::app
