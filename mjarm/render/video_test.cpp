#include "mjarm/render/video.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "mjarm/core/os.hpp"
#include "mjarm/core/os_child_input.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::render {
namespace {

using ::testing::HasSubstr;

constexpr VideoOptions kSmall = {.width = 64, .height = 48, .fps = 10};

/// Left half red, right half blue, with a white bar that moves to the right.
Image bar_frame(int number, int width = kSmall.width, int height = kSmall.height) {
  Image image{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const bool bar = y < height / 4 && x / 4 == number;
      const bool left = x < width / 2;
      image.rgb.push_back(bar || left ? 230 : 20);
      image.rgb.push_back(bar ? 230 : 20);
      image.rgb.push_back(bar || !left ? 230 : 20);
    }
  }
  return image;
}

/// PATH as long as this object lives.
class Path {
 public:
  explicit Path(const std::string& value) : before_(environment("PATH").value_or("")) {
    ::setenv("PATH", value.c_str(), 1);
  }
  ~Path() { ::setenv("PATH", before_.c_str(), 1); }
  Path(const Path&) = delete;
  Path& operator=(const Path&) = delete;

 private:
  std::string before_;
};

std::size_t files_in(const support::TempFolder& folder) {
  std::size_t count = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    ++count;
  }
  return count;
}

/// What ffprobe says of the only stream of a file; every frame is decoded for it.
nlohmann::json probe(const std::filesystem::path& file) {
  const auto result = support::run_program(
      find_program("ffprobe"), {"-v", "error", "-count_frames", "-show_streams", "-show_format",
                                "-of", "json", file.string()});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return nlohmann::json::parse(result.out);
}

/// The first frame of a file, as its decoder sees it.
Image first_frame(const std::filesystem::path& file) {
  const auto result = support::run_program(
      find_program("ffmpeg"), {"-v", "error", "-nostdin", "-i", file.string(), "-frames:v", "1",
                               "-f", "rawvideo", "-pix_fmt", "rgb24", "-"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return {kSmall.width, kSmall.height, {result.out.begin(), result.out.end()}};
}

class Video : public ::testing::Test {
 protected:
  void SetUp() override {
    if (find_program("ffmpeg").empty() || find_program("ffprobe").empty()) {
      GTEST_SKIP() << "no ffmpeg on this machine (apt-get install ffmpeg)";
    }
  }
  /// Writes 20 frames.
  void write(const std::filesystem::path& file) {
    Result<VideoWriter> video = VideoWriter::create(file, kSmall);
    ASSERT_TRUE(video) << video.error().what;
    for (int i = 0; i < 20; ++i) {
      const Result<void> added = video->add(bar_frame(i));
      ASSERT_TRUE(added) << added.error().what;
      EXPECT_FALSE(std::filesystem::exists(file));
    }
    EXPECT_EQ(video->frames(), 20);
    const Result<void> finished = video->finish();
    ASSERT_TRUE(finished) << finished.error().what;
    EXPECT_FALSE(video->finish()) << "twice";
    EXPECT_FALSE(video->add(bar_frame(0))) << "after the end";
  }
  void expect_colors(const std::filesystem::path& file) {
    const Image seen = first_frame(file);
    ASSERT_EQ(seen.rgb.size(), bar_frame(0).rgb.size());
    for (const int x : {10, 50}) {
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(seen.pixel(x, 40)[c], bar_frame(0).pixel(x, 40)[c], 8) << x << " " << c;
      }
    }
  }
  support::TempFolder folder_;
};

TEST_F(Video, Mp4HoldsEveryFrame) {
  const auto file = folder_.path() / "a: b.MP4";
  write(file);
  EXPECT_EQ(files_in(folder_), 1U);
  const nlohmann::json found = probe(file);
  const nlohmann::json& stream = found.at("streams").at(0);
  EXPECT_EQ(stream.at("codec_name"), "h264");
  EXPECT_EQ(stream.at("pix_fmt"), "yuv420p");
  EXPECT_EQ(stream.at("color_space"), "bt709");
  EXPECT_EQ(stream.at("width"), kSmall.width);
  EXPECT_EQ(stream.at("height"), kSmall.height);
  EXPECT_EQ(stream.at("nb_read_frames"), "20");
  EXPECT_EQ(stream.at("r_frame_rate"), "10/1");
  EXPECT_NEAR(std::stod(found.at("format").at("duration").get<std::string>()), 2, 1e-3);
  expect_colors(file);
  // Browsers begin to play before all is there: the table of contents stands first.
  const std::string bytes = folder_.read("a: b.MP4");
  EXPECT_LT(bytes.find("moov"), bytes.find("mdat"));
}

TEST_F(Video, GifHoldsEveryFrame) {
  const auto file = folder_.path() / "a.gif";
  write(file);
  EXPECT_EQ(files_in(folder_), 1U);
  const nlohmann::json found = probe(file);
  const nlohmann::json& stream = found.at("streams").at(0);
  EXPECT_EQ(stream.at("codec_name"), "gif");
  EXPECT_EQ(stream.at("nb_read_frames"), "20");
  EXPECT_NEAR(std::stod(found.at("format").at("duration").get<std::string>()), 2, 0.05);
  expect_colors(file);
}

TEST_F(Video, OneThatIsNotFinishedLeavesNothing) {
  folder_.write("a.mp4", "what was here");
  {
    Result<VideoWriter> video = VideoWriter::create(folder_.path() / "a.mp4", kSmall);
    ASSERT_TRUE(video);
    EXPECT_TRUE(video->add(bar_frame(0)));
    EXPECT_EQ(files_in(folder_), 2U);
  }
  EXPECT_EQ(files_in(folder_), 1U);
  EXPECT_EQ(folder_.read("a.mp4"), "what was here");
}

TEST_F(Video, AFullDiskIsTold) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  const auto file = folder_.path() / "full.gif";
  std::filesystem::create_symlink("/dev/full", file);
  Result<VideoWriter> video = VideoWriter::create(file, kSmall);
  ASSERT_TRUE(video) << video.error().what;
  Result<void> done = video->add(bar_frame(0));
  if (done) done = video->finish();
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, Errc::system);
  EXPECT_THAT(done.error().what,
              ::testing::AllOf(HasSubstr("full.gif: ffmpeg failed: "), HasSubstr("No space left")));
}

TEST_F(Video, RefusesWhatIsNoFrame) {
  Result<VideoWriter> video = VideoWriter::create(folder_.path() / "a.gif", kSmall);
  ASSERT_TRUE(video);
  EXPECT_EQ(video->add(bar_frame(0, 62, 48)).error().code, Errc::bad_input);
  EXPECT_EQ(video->add({64, 48, {1, 2, 3}}).error().code, Errc::bad_input);
  const Result<void> finished = video->finish();
  ASSERT_FALSE(finished);
  EXPECT_EQ(finished.error().code, Errc::bad_input) << "no frames";
}

// What follows needs no ffmpeg.

TEST(VideoOptions, AreChecked) {
  const support::TempFolder folder;
  const auto code = [&](const char* name, const VideoOptions& options) {
    const Result<VideoWriter> video = VideoWriter::create(folder.path() / name, options);
    return video ? Errc::usage : video.error().code;
  };
  EXPECT_EQ(code("a.avi", kSmall), Errc::bad_input);
  EXPECT_EQ(code("a.mp4", {.width = 63, .height = 48}), Errc::bad_input);
  EXPECT_EQ(code("a.mp4", {.width = 64, .height = 47}), Errc::bad_input);
  EXPECT_EQ(code("a.gif", {.width = 0, .height = 47}), Errc::bad_input);
  EXPECT_EQ(code("a.gif", {.width = 63, .height = 47, .fps = 101}), Errc::bad_input);
  EXPECT_EQ(code("a.mp4", {.width = 64, .height = 48, .fps = 0}), Errc::bad_input);
  EXPECT_EQ(code("none/a.mp4", kSmall), Errc::system);
  EXPECT_EQ(files_in(folder), 0U);
  const auto odd = VideoWriter::create(folder.path() / "a.mp4", {.width = 63, .height = 48});
  EXPECT_THAT(odd.error().what, HasSubstr("64 x 48"));
}

TEST(VideoFormat, FollowsTheEnding) {
  EXPECT_EQ(video_format("x/a.mp4"), VideoFormat::mp4);
  EXPECT_EQ(video_format("A.GIF"), VideoFormat::gif);
  EXPECT_EQ(video_format("a.png"), std::nullopt);
  EXPECT_EQ(video_format("mp4"), std::nullopt);
}

TEST(VideoWithoutFfmpeg, NamesThePackage) {
  const support::TempFolder folder;
  const Path none("/nowhere");
  const Result<VideoWriter> video = VideoWriter::create(folder.path() / "a.mp4", kSmall);
  ASSERT_FALSE(video);
  EXPECT_EQ(video.error().code, Errc::not_available);
  EXPECT_THAT(video.error().what, HasSubstr("apt-get install ffmpeg"));
  EXPECT_EQ(files_in(folder), 0U);
}

/// A folder with a script in the place of ffmpeg.
void put_ffmpeg(const support::TempFolder& folder, const std::string& script) {
  const auto file = folder.write("ffmpeg", "#!/bin/sh\n" + script);
  std::filesystem::permissions(file, std::filesystem::perms::owner_all);
}

TEST(VideoWithBadFfmpeg, SaysWhatItSaysAndLeavesNothing) {
  const support::TempFolder tools;
  const support::TempFolder folder;
  const Path path(tools.path().string() + ":/usr/bin:/bin");
  put_ffmpeg(tools, "cat > /dev/null\necho 'No space left on device' >&2\necho last >&2\nexit 1\n");
  {
    Result<VideoWriter> video = VideoWriter::create(folder.path() / "a.mp4", kSmall);
    ASSERT_TRUE(video) << video.error().what;
    EXPECT_TRUE(video->add(bar_frame(0)));
    const Result<void> finished = video->finish();
    ASSERT_FALSE(finished);
    EXPECT_THAT(finished.error().what, HasSubstr("a.mp4: ffmpeg failed: No space left on device"));
  }
  EXPECT_EQ(files_in(folder), 0U);
  put_ffmpeg(tools, "echo \"Unknown encoder 'libx264'\" >&2\nexit 1\n");
  {
    Result<VideoWriter> video = VideoWriter::create(folder.path() / "a.mp4", kSmall);
    ASSERT_TRUE(video) << video.error().what;
    Result<void> added = {};
    for (int i = 0; i < 100'000 && added; ++i) added = video->add(bar_frame(0));
    ASSERT_FALSE(added);
    EXPECT_THAT(added.error().what, HasSubstr("Unknown encoder 'libx264'"));
    EXPECT_FALSE(video->add(bar_frame(0)));
    EXPECT_FALSE(video->finish());
  }
  EXPECT_EQ(files_in(folder), 0U);
}

}  // namespace
}  // namespace mjarm::render
