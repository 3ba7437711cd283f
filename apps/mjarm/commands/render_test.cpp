// mjarm render, as a user calls it.
#include <gmock/gmock.h>
#include <png.h>

#include <csignal>
#include <filesystem>
#include <set>
#include <thread>

#include "apps/mjarm/commands/program_test.hpp"
#include "mjarm/core/os_child_input.hpp"

namespace mjarm::app {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* kRenderedProgram = R"(robot: ur5e
program:
  - movej: {pos: [0.1, -0.45, 0.4], euler: [180deg, 0, 0]}
  - movel: {pos: [-0.1, -0.45, 0.4], euler: [180deg, 0, 0], speed: 0.4}
)";

struct Picture {
  unsigned width = 0;
  unsigned height = 0;
  std::vector<unsigned char> rgb;
  /// How many different colours there are.
  [[nodiscard]] std::size_t colors() const {
    std::set<int> found;
    for (std::size_t i = 0; i + 2 < rgb.size(); i += 3) {
      found.insert(rgb[i] << 16 | rgb[i + 1] << 8 | rgb[i + 2]);
    }
    return found.size();
  }
  /// Pixels that are nearly of this colour.
  [[nodiscard]] int count(int r, int g, int b) const {
    int found = 0;
    for (std::size_t i = 0; i + 2 < rgb.size(); i += 3) {
      const auto near = [](int a, int c) { return std::abs(a - c) < 40; };
      found += near(rgb[i], r) && near(rgb[i + 1], g) && near(rgb[i + 2], b) ? 1 : 0;
    }
    return found;
  }
};

Picture read_png(const std::filesystem::path& file) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_file(&header, file.c_str()), 0) << header.message;
  header.format = PNG_FORMAT_RGB;
  Picture out{header.width, header.height, {}};
  out.rgb.resize(PNG_IMAGE_SIZE(header));
  EXPECT_NE(png_image_finish_read(&header, nullptr, out.rgb.data(), 0, nullptr), 0);
  return out;
}

class Render : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto doctor = nlohmann::json::parse(mjarm({"doctor", "--json"}).out);
    for (const auto& way : doctor.at("gl")) draws_ = draws_ || way.at("works").get<bool>();
    if (!draws_) GTEST_SKIP() << "no OpenGL on this machine";
  }
  [[nodiscard]] std::string file(const std::string& name) const {
    return (folder_.path() / name).string();
  }
  [[nodiscard]] std::size_t files() const {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      ++count;
    }
    return count;
  }
  /// Calls mjarm render and reads the picture.
  Picture picture(std::vector<std::string> arguments) {
    const std::string out = file("picture.png");
    arguments.insert(arguments.begin(), "render");
    arguments.insert(arguments.end(), {"--out", out});
    const auto result = mjarm(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("picture.png: "));
    return read_png(out);
  }
  nlohmann::json probe(const std::string& name) {
    const auto result = support::run_program(
        find_program("ffprobe"), {"-v", "error", "-count_frames", "-show_streams", "-show_format",
                                  "-of", "json", file(name)});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(result.out);
  }
  support::TempFolder folder_;
  bool draws_ = false;
};

TEST_F(Render, AModelAtHome) {
  const Picture overview = picture({"ur5e", "--size", "320x180"});
  EXPECT_EQ(overview.width, 320U);
  EXPECT_EQ(overview.height, 180U);
  EXPECT_GT(overview.colors(), 200U);
  const Picture top = picture({"ur5e", "--size", "320x180", "--camera", "top"});
  EXPECT_NE(top.rgb, overview.rgb);
  const Picture free =
      picture({"ur5e", "--size", "320x180", "--camera", "90deg,-20deg,2.5,0,0,0.4"});
  EXPECT_NE(free.rgb, overview.rgb);
  // From far away the robot, whose lids are light blue, is small.
  const Picture far = picture({"ur5e", "--size", "320x180", "--camera", "90deg,-20deg,25m"});
  EXPECT_GT(free.count(110, 170, 220), far.count(110, 170, 220));
  std::vector<Picture> qualities;
  for (const char* quality : {"low", "medium", "high"}) {
    qualities.push_back(picture({"ur5e", "--size", "320x180", "--quality", quality}));
  }
  EXPECT_EQ(qualities[2].rgb, overview.rgb) << "high is what a picture gets unasked";
  EXPECT_NE(qualities[0].rgb, qualities[1].rgb);
  EXPECT_NE(qualities[1].rgb, qualities[2].rgb);
}

TEST_F(Render, AProgramInPicturesSideBySide) {
  const auto program = folder_.write("cell.yaml", kRenderedProgram).string();
  const std::vector<std::string> small = {program, "--size", "160x90", "--quality", "low"};
  const Picture end = picture(small);
  std::vector<std::string> words = small;
  words.insert(words.end(), {"--strip", "5"});
  const Picture strip = picture(words);
  ASSERT_EQ(strip.width, 3 * 160U + 2 * 4);
  ASSERT_EQ(strip.height, 2 * 90U + 4);
  const auto part = [&](unsigned column, unsigned row) {
    std::vector<unsigned char> out;
    for (unsigned y = 0; y < 90; ++y) {
      const auto from = strip.rgb.begin() + 3 * ((row * 94 + y) * strip.width + column * 164);
      out.insert(out.end(), from, from + 3 * 160);
    }
    return out;
  };
  EXPECT_EQ(part(1, 1), end.rgb) << "the last one is the end";
  EXPECT_NE(part(0, 0), part(1, 0));
  EXPECT_NE(part(1, 0), part(2, 0));
  EXPECT_NE(part(0, 1), part(1, 1));
  EXPECT_EQ(part(2, 1), std::vector<unsigned char>(3 * 160 * 90, 255)) << "nothing is left";
}

TEST_F(Render, AShippedProgramByItsName) {
  const std::vector<std::string> small = {"--size", "160x90", "--quality", "low"};
  const auto drawn = [&](const char* name) {
    std::vector<std::string> words = small;
    words.insert(words.begin(), name);
    return picture(words);
  };
  const Picture program = drawn("ellipse.yaml");
  EXPECT_EQ(program.rgb, drawn("ellipse").rgb);
  EXPECT_NE(program.rgb, drawn("ur5e").rgb) << "the trail of the tool is there";
}

TEST_F(Render, ModelsOfEveryKind) {
  for (const std::string& model :
       {std::string("car"), std::string("panda"), model_file("universal_robots_ur5e/ur5e.urdf")}) {
    EXPECT_GT(picture({model, "--size", "160x90", "--quality", "low"}).colors(), 50U) << model;
  }
}

TEST_F(Render, TheEndOfAProgramWithPathAndTrail) {
  const auto program = folder_.write("cell.yaml", kRenderedProgram).string();
  const std::vector<std::string> how = {"--size", "320x180", "--camera",
                                        "90deg,-30deg,1.2,0,-0.45,0.4"};
  const auto with = [&how](std::vector<std::string> words) {
    words.insert(words.end(), how.begin(), how.end());
    return words;
  };
  const Picture end = picture(with({program}));
  EXPECT_GT(end.count(60, 140, 230), 30) << "the trail";
  const Picture start = picture(with({program, "--seconds", "0.01"}));
  EXPECT_NE(start.rgb, end.rgb);
  EXPECT_LT(start.count(60, 140, 230), end.count(60, 140, 230));
}

TEST_F(Render, VideosLastAsLongAsWhatTheyShow) {
  if (find_program("ffmpeg").empty()) GTEST_SKIP() << "no ffmpeg (apt-get install ffmpeg)";
  const auto orbit = mjarm({"render", "ur5e", "--out", file("a.mp4"), "--size", "160x90", "--fps",
                            "10", "--seconds", "1.5"});
  ASSERT_EQ(orbit.exit_code, 0) << orbit.err;
  EXPECT_THAT(orbit.out, HasSubstr("15 frames, 1.50 s"));
  const auto found = probe("a.mp4");
  EXPECT_EQ(found.at("streams").at(0).at("width"), 160);
  EXPECT_EQ(found.at("streams").at(0).at("height"), 90);
  EXPECT_EQ(found.at("streams").at(0).at("nb_read_frames"), "15");
  EXPECT_EQ(found.at("streams").at(0).at("r_frame_rate"), "10/1");
  const auto gif =
      mjarm({"render", "ur5e", "--out", file("a.gif"), "--size", "81x45", "--seconds", "500ms"});
  ASSERT_EQ(gif.exit_code, 0) << gif.err;
  EXPECT_EQ(probe("a.gif").at("streams").at(0).at("nb_read_frames"), "10");
  const auto program = folder_.write("cell.yaml", kRenderedProgram).string();
  const auto plan = nlohmann::json::parse(mjarm({"check", program, "--json"}).out);
  const auto run =
      mjarm({"render", program, "--out", file("run.mp4"), "--size", "160x90", "--fps", "10"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const double length = std::stod(probe("run.mp4").at("format").at("duration").get<std::string>());
  EXPECT_NEAR(length, plan.at("cycle_time").get<double>() + 0.5, 0.11);
  EXPECT_EQ(files(), 4U) << "three videos and the program";
}

TEST_F(Render, WithoutFfmpegOnlyVideosFail) {
  const std::vector<std::pair<std::string, std::string>> no_path = {{"PATH", "/nowhere"}};
  const auto video = mjarm({"render", "ur5e", "--out", file("a.mp4")}, {.environment = no_path});
  EXPECT_EQ(video.exit_code, 1);
  EXPECT_THAT(only_line(video), HasSubstr("apt-get install ffmpeg"));
  EXPECT_EQ(files(), 0U);
  const auto picture = mjarm({"render", "ur5e", "--out", file("a.png"), "--size", "32x18"},
                             {.environment = no_path});
  EXPECT_EQ(picture.exit_code, 0) << picture.err;
  const auto doctor = mjarm({"doctor"}, {.environment = no_path});
  EXPECT_THAT(doctor.out, HasSubstr("apt-get install ffmpeg"));
  EXPECT_EQ(
      nlohmann::json::parse(mjarm({"doctor", "--json"}, {.environment = no_path}).out).at("ffmpeg"),
      "");
}

TEST_F(Render, NeedsNoDisplayAndFallsBackToOsmesa) {
  const auto out = file("a.png");
  const std::vector<std::string> call = {"render", "ur5e", "--out", out, "--size", "32x18"};
  for (const char* display : {"", ":4711"}) {
    EXPECT_EQ(mjarm(call, {.environment = {{"DISPLAY", display}}}).exit_code, 0);
  }
  // EGL's loader finds no driver.
  const std::vector<std::pair<std::string, std::string>> no_egl = {
      {"__EGL_VENDOR_LIBRARY_FILENAMES", "/nowhere"}};
  const auto ways =
      nlohmann::json::parse(mjarm({"doctor", "--json"}, {.environment = no_egl}).out).at("gl");
  if (ways.at(0).at("works").get<bool>()) GTEST_SKIP() << "this EGL has no loader";
  const auto result = mjarm(call, {.environment = no_egl});
  if (ways.at(1).at("works").get<bool>()) {
    EXPECT_EQ(result.exit_code, 0) << result.err;
  } else {
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(only_line(result), AllOf(HasSubstr("EGL"), HasSubstr("libosmesa6")));
  }
}

TEST_F(Render, CtrlCLeavesNothing) {
  if (find_program("ffmpeg").empty()) GTEST_SKIP() << "no ffmpeg (apt-get install ffmpeg)";
  // The shell's own number becomes that of mjarm, and another process sends it the signal as soon
  // as the first bytes are there.
  const std::string script = "(while ! ls '" + folder_.path().string() +
                             "' | grep -q tmp; do sleep 0.05; done; sleep 0.5; kill -INT $$) & "
                             "exec '" +
                             std::string(MJARM_PROGRAM) + "' render ur5e --out '" + file("a.mp4") +
                             "' --seconds 3600";
  const auto result = support::run_program("/bin/bash", {"-c", script});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(only_line(result), HasSubstr("a.mp4 was not written"));
  EXPECT_EQ(files(), 0U);
}

TEST(RenderUsage, BadRequestsAreOneLine) {
  const support::TempFolder folder;
  const auto out = [&folder](const char* name) { return (folder.path() / name).string(); };
  const std::string png = out("a.png");
  const struct {
    std::vector<std::string> words;
    const char* says;
  } cases[] = {
      {{}, "which model or program"},
      {{"ur5e"}, "--out"},
      {{"ur5e", "--out", out("a.avi")}, ".png, .mp4 or .gif"},
      {{"ur5e", "--out", png, "--size", "1280"}, "1280x720"},
      {{"ur5e", "--out", png, "--size", "0x10"}, "--size"},
      {{"ur5e", "--out", png, "--size", "10x9000"}, "8192"},
      {{"ur5e", "--out", png, "--size", "10x10x10"}, "--size"},
      {{"ur5e", "--out", png, "--quality", "hihg"}, "\"high\""},
      {{"ur5e", "--out", png, "--fps", "10"}, "--fps needs a video"},
      {{"ur5e", "--out", png, "--seconds", "1us"}, "time step"},
      {{"ur5e", "--out", png, "--turn"}, "--turn needs a video"},
      {{"ur5e", "--out", png, "--ctrl", "elbow=1"}, "--ctrl of a picture needs --seconds"},
      {{"ur5e", "--out", out("a.mp4"), "--turn", "--ctrl", "elbow=1"}, "exclude each other"},
      {{"ellipse", "--out", png, "--ctrl", "elbow=1"}, "--ctrl is for models"},
      {{"ellipse", "--out", out("a.mp4"), "--turn"}, "--turn is for models"},
      {{"ur5e", "--out", out("a.mp4"), "--fps", "0"}, "--fps"},
      {{"ur5e", "--out", out("a.mp4"), "--seconds", "-1"}, "--seconds"},
      {{"ur5e", "--out", out("a.mp4"), "--seconds", "2m"}, "--seconds"},
      {{"ur5e", "--out", png, "--camera", "overveiw"}, "did you mean \"overview\""},
      {{"ur5e", "--out", png, "--camera", "90deg,0"}, "2 values"},
      {{"ur5e", "--out", png, "--camera", "90mm,0,1"}, "--camera"},
      {{"ur5e", "--out", png, "--camera", "0,0,0"}, "distance"},
      {{"ur5e", "--out", png, "--strip", "4"}, "pictures of motion programs"},
      {{"ellipse", "--out", out("a.mp4"), "--strip", "4"}, "pictures of motion programs"},
      {{"ellipse", "--out", png, "--strip", "1"}, "from 2 to 24"},
      {{"ellipse", "--out", png, "--strip", "25"}, "--strip"},
      {{"ur6e", "--out", png}, "ur5e"},
      {{"none.yaml", "--out", png}, "none.yaml"},
  };
  for (const auto& [words, says] : cases) {
    std::vector<std::string> call = {"render"};
    call.insert(call.end(), words.begin(), words.end());
    const auto result = mjarm(call);
    EXPECT_EQ(result.exit_code, 2) << says;
    EXPECT_THAT(only_line(result), HasSubstr(says));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(RenderUsage, TheHelpTellsTheRules) {
  const auto help = mjarm({"render", "--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.out, AllOf(HasSubstr("Without --quality"), HasSubstr("azimuth")));
}

}  // namespace
}  // namespace mjarm::app
