#include "mjarm/render/video.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <utility>

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

/// Stands in the place of ffmpeg: keeps its words and all that it is fed.
class RecordedFfmpeg {
 public:
  explicit RecordedFfmpeg(const std::string& end = "") {
    const std::string folder = tools_.path().string();
    put_ffmpeg(tools_, "printf '%s\\n' \"$@\" > '" + folder + "/words'\ncat > '" + folder +
                           "/fed'\n" + end);
  }
  /// Each word in a line.
  std::vector<std::string> words() const { return support::lines_of(tools_.read("words")); }
  std::string word_after(const std::string& option) const {
    const std::vector<std::string> all = words();
    const auto found = std::ranges::find(all, option);
    return found == all.end() || found + 1 == all.end() ? "" : *(found + 1);
  }
  std::string fed() const { return tools_.read("fed"); }

 private:
  support::TempFolder tools_;
  Path path_{tools_.path().string() + ":/usr/bin:/bin"};
};

TEST(VideoFrames, ArriveByteForByteInTheirOrder) {
  const RecordedFfmpeg ffmpeg;
  const support::TempFolder folder;
  folder.write("a.gif", "what was here");
  // Of odd size, so that rows which are padded would show.
  Result<VideoWriter> video =
      VideoWriter::create(folder.path() / "a.gif", {.width = 37, .height = 11, .fps = 12.5});
  ASSERT_TRUE(video) << video.error().what;
  std::string expected;
  for (int i = 0; i < 7; ++i) {
    const Image frame = bar_frame(i, 37, 11);
    ASSERT_TRUE(video->add(frame));
    expected.append(frame.rgb.begin(), frame.rgb.end());
    EXPECT_FALSE(video->add(bar_frame(i, 11, 37))) << "turned round it has as many bytes";
    EXPECT_EQ(video->frames(), i + 1) << "what is refused does not count";
  }
  EXPECT_EQ(folder.read("a.gif"), "what was here") << "until it is finished";
  ASSERT_TRUE(video->finish());
  EXPECT_EQ(ffmpeg.fed(), expected);
  EXPECT_EQ(ffmpeg.word_after("-video_size"), "37x11");
  EXPECT_EQ(ffmpeg.word_after("-framerate"), "12.5");
  EXPECT_EQ(ffmpeg.word_after("-pix_fmt"), "rgb24");
  const std::filesystem::path grown = ffmpeg.words().back();
  EXPECT_EQ(grown.parent_path(), "file:" + folder.path().string()) << "beside its place";
  EXPECT_EQ(files_in(folder), 1U);
  EXPECT_NE(folder.read("a.gif"), "what was here");
}

TEST(VideoFrames, RatesAreToldAsTheyAreAsked) {
  for (const auto& [name, fps] : {std::pair("a.mp4", 1000.0), std::pair("a.mp4", 30000.0 / 1001),
                                  std::pair("a.gif", 100.0), std::pair("a.gif", 1e-3)}) {
    const RecordedFfmpeg ffmpeg;
    const support::TempFolder folder;
    Result<VideoWriter> video =
        VideoWriter::create(folder.path() / name, {.width = 4, .height = 4, .fps = fps});
    ASSERT_TRUE(video) << video.error().what;
    ASSERT_TRUE(video->add(bar_frame(0, 4, 4)));
    ASSERT_TRUE(video->finish());
    const std::string told = ffmpeg.word_after("-framerate");
    EXPECT_EQ(std::stod(told), fps) << "to the last bit";
    EXPECT_EQ(told.find_first_not_of("0123456789."), std::string::npos) << told;
  }
}

TEST(VideoFrames, AnEndWithoutAWordIsToldByItsCode) {
  const RecordedFfmpeg ffmpeg("exit 3\n");
  const support::TempFolder folder;
  Result<VideoWriter> video = VideoWriter::create(folder.path() / "a.mp4", kSmall);
  ASSERT_TRUE(video) << video.error().what;
  ASSERT_TRUE(video->add(bar_frame(0)));
  const Result<void> finished = video->finish();
  ASSERT_FALSE(finished);
  EXPECT_EQ(finished.error().what,
            (folder.path() / "a.mp4").string() + ": ffmpeg failed: exit code 3");
  EXPECT_FALSE(folder.exists("a.mp4"));
}

TEST(VideoOptions, RefusalsSayWhatWouldDo) {
  const support::TempFolder folder;
  const auto why = [&](const char* name, const VideoOptions& options) {
    const Result<VideoWriter> video = VideoWriter::create(folder.path() / name, options);
    EXPECT_FALSE(video);
    return video ? std::string() : video.error().what;
  };
  const double nan = std::nan("");
  EXPECT_EQ(why("a.gif", {.width = 4, .height = 4, .fps = nan}),
            "nan frames a second cannot be shown (above 0, at most 100)");
  EXPECT_EQ(why("a.mp4", {.width = 4, .height = 4, .fps = 1e9}),
            "1000000000 frames a second cannot be shown (above 0, at most 1000)");
  EXPECT_EQ(why("a.mp4", {.width = 63, .height = 47}),
            "an MP4 needs an even width and height: 63 x 47 cannot be, 64 x 48 can");
  EXPECT_EQ(why("a.mp4", {.width = -2, .height = 48}), "a video of -2 x 48 pixels cannot be made");
  EXPECT_EQ(why("film", {}),
            "\"" + (folder.path() / "film").string() + "\" must end in .mp4 or .gif");
  EXPECT_EQ(files_in(folder), 0U);
}

}  // namespace
}  // namespace mjarm::render
