// `--video` of demos and programs.
#include <gmock/gmock.h>

#include "apps/mjarm/commands/program_test.hpp"
#include "mjarm/core/os_child_input.hpp"

namespace mjarm::app {
namespace {

using ::testing::HasSubstr;

support::ProgramResult film(const support::TempFolder& folder, const std::string& out,
                            std::vector<std::string> words) {
  for (const std::string& word : {std::string("--headless"), std::string("--no-timing"),
                                  std::string("--out"), (folder.path() / out).string()}) {
    words.push_back(word);
  }
  return mjarm(words);
}

TEST(Film, AVideoIsWrittenAndChangesNothingElse) {
  if (find_program("ffmpeg").empty()) GTEST_SKIP() << "no ffmpeg (apt-get install ffmpeg)";
  const support::TempFolder folder;
  const auto filmed = film(folder, "a", {"run", "movel", "--video"});
  ASSERT_EQ(filmed.exit_code, 0) << filmed.err;
  ASSERT_EQ(film(folder, "b", {"run", "movel"}).exit_code, 0);
  EXPECT_EQ(folder.read("a/log.csv"), folder.read("b/log.csv"));
  EXPECT_EQ(folder.read("a/report.json"), folder.read("b/report.json"));
  EXPECT_EQ(folder.read("a/video.mp4").substr(4, 4), "ftyp");
  EXPECT_FALSE(folder.exists("b/video.mp4"));
  const auto report = support::load_json(folder.path() / "a" / "report.json");
  const auto probed = support::run_program(
      "/usr/bin/env", {"ffprobe", "-v", "error", "-show_entries", "format=duration", "-of",
                       "csv=p=0", (folder.path() / "a" / "video.mp4").string()});
  ASSERT_EQ(probed.exit_code, 0) << probed.err;
  EXPECT_NEAR(std::stod(probed.out), report.at("duration").get<double>(), 0.05);
}

TEST(Film, TheCarToo) {
  if (find_program("ffmpeg").empty()) GTEST_SKIP() << "no ffmpeg (apt-get install ffmpeg)";
  const support::TempFolder folder;
  const auto filmed = film(folder, "car", {"demo", "car", "--video", "--seconds", "0.5"});
  EXPECT_EQ(folder.read("car/video.mp4").substr(4, 4), "ftyp") << filmed.err;
}

TEST(Film, WithoutFfmpegNothingMoves) {
  const support::TempFolder folder;
  const auto result =
      mjarm({"run", "movel", "--video", "--headless", "--out", (folder.path() / "out").string()},
            {.environment = {{"PATH", folder.path().string()}}});
  EXPECT_NE(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("apt-get install ffmpeg"));
  EXPECT_FALSE(folder.exists("out/log.csv"));
}

}  // namespace
}  // namespace mjarm::app
