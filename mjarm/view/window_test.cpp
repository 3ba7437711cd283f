#include "mjarm/view/window.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <iostream>

#include "mjarm/core/os.hpp"
#include "mjarm/render/offscreen.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

constexpr const char* kScene = R"(
<mujoco>
  <visual><headlight ambient="1 1 1" diffuse="0 0 0" specular="0 0 0"/></visual>
  <statistic center="0 0 0" extent="2"/>
  <worldbody>
    <camera name="front" pos="0 -3 0" xyaxes="1 0 0 0 0 1"/>
    <geom type="sphere" size="0.4" rgba="1 0 0 1"/>
  </worldbody>
</mujoco>)";
constexpr const char* kTitle = "mjarm window test";
constexpr const char* kXdotool = "/usr/bin/xdotool";

Model load_scene() {
  const support::TempFolder folder;
  return Model::load(folder.write("scene.xml", kScene)).value();
}

/// All tests share one display with one mouse, so they take turns, also those of other processes.
class Turn {
 public:
  Turn()
      : file_(open((temp_directory() / "mjarm_window_test.lock").c_str(), O_RDWR | O_CREAT, 0666)) {
    flock(file_, LOCK_EX);
  }
  ~Turn() { close(file_); }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  int file_;
};

/// A window that a stand-in for the user drives.
class RealWindow : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "DISPLAY is not set";
    if (access(kXdotool, X_OK) != 0) GTEST_SKIP() << "xdotool is not installed";
    Result<Window> opened =
        Window::open(model_, kTitle, {.width = 400, .height = 300, .camera = {.name = "front"}});
    ASSERT_TRUE(opened) << opened.error().what;
    window_ = std::make_unique<Window>(std::move(*opened));
    ASSERT_TRUE(frames_until([this] { return id() != ""; })) << "the window does not appear";
    xdotool({"windowmove", "--sync", id(), "0", "0", "windowfocus", "--sync", id()});
    frames_until([] { return false; }, 0.2);
  }

  /// Draws until something holds, at most so many seconds; returns whether it came to hold.
  bool frames_until(const std::function<bool()>& holds, double seconds = 20) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (std::chrono::steady_clock::now() < end) {
      const Result<void> drawn = window_->draw({});
      if (!drawn) ADD_FAILURE() << drawn.error().what;
      if (holds()) return true;
    }
    return holds();
  }
  /// Lets the stand-in do something until it shows: on a busy machine a click may get lost between
  /// the programs, and a user clicks again.
  bool act_until(const std::vector<std::string>& input, const std::function<bool()>& holds) {
    for (int attempt = 0; attempt < 4; ++attempt) {
      xdotool(input);
      if (frames_until(holds, 5)) return true;
    }
    return false;
  }
  static support::ProgramResult xdotool(const std::vector<std::string>& arguments) {
    support::ProgramResult result = support::run_program(kXdotool, arguments);
    if (result.exit_code != 0) std::cerr << "xdotool " << arguments[0] << ": " << result.err;
    return result;
  }
  static std::string id() {
    const auto found = support::lines_of(xdotool({"search", "--name", kTitle}).out);
    return found.empty() ? std::string() : found.back();
  }
  static std::vector<std::string> drag(const std::string& button, int dx, int dy) {
    return {"mousemove",
            "200",
            "150",
            "mousedown",
            button,
            "mousemove_relative",
            "--",
            std::to_string(dx),
            std::to_string(dy),
            "mouseup",
            button};
  }

  Turn turn_;
  Model model_ = load_scene();
  std::unique_ptr<Window> window_;
};

TEST_F(RealWindow, ShowsTheModelTheOverlayAndPlots) {
  Overlay overlay;
  overlay.spheres.push_back({{-0.7, 0, 0.6}, 0.2, {0, 0, 1, 1}});
  ASSERT_TRUE(window_->draw({}, overlay));
  const auto color_at = [this](double x, double y) {
    const Image image = window_->picture().value();
    return image.pixel(static_cast<int>(x * image.width), static_cast<int>(y * image.height));
  };
  EXPECT_GT(color_at(0.5, 0.5)[0], 150);
  EXPECT_LT(color_at(0.5, 0.5)[2], 100);
  EXPECT_LT(color_at(0.85, 0.2)[0], 100);
  const std::vector<std::uint8_t> plain = window_->picture().value().rgb;
  const LivePlot plot = {.title = "path", .series = {{.x = {0, 1}, .y = {0, 1}}}};
  ASSERT_TRUE(frames_until([&] {
    EXPECT_TRUE(window_->draw({}, overlay, {&plot, 1}));
    return window_->picture().value().rgb != plain;
  }));
}

TEST_F(RealWindow, LeftDragTurns) {
  const CameraView before = window_->view();
  ASSERT_TRUE(
      act_until(drag("1", 60, 30), [&] { return window_->view().elevation != before.elevation; }));
  const CameraView after = window_->view();
  // To the right and down by 60 and 30 of 300 pixels, half a turn over the height.
  EXPECT_NEAR(after.azimuth - before.azimuth, -0.2 * 3.14159, 0.02);
  EXPECT_NEAR(after.elevation - before.elevation, -0.1 * 3.14159, 0.02);
  EXPECT_EQ(after.lookat_W, before.lookat_W);
  EXPECT_EQ(after.distance, before.distance);
}

TEST_F(RealWindow, WheelZooms) {
  const CameraView before = window_->view();
  ASSERT_TRUE(act_until({"mousemove", "200", "150", "click", "4"},
                        [&] { return window_->view().distance != before.distance; }));
  EXPECT_LT(window_->view().distance, before.distance);
  const CameraView near = window_->view();
  ASSERT_TRUE(act_until({"mousemove", "200", "150", "click", "--repeat", "2", "5"},
                        [&] { return window_->view().distance > before.distance; }));
  EXPECT_EQ(window_->view().azimuth, near.azimuth);
}

TEST_F(RealWindow, RightAndMiddleDragPan) {
  for (const char* button : {"3", "2"}) {
    const CameraView before = window_->view();
    ASSERT_TRUE(act_until(drag(button, 60, 0),
                          [&] { return window_->view().lookat_W != before.lookat_W; }));
    // The world follows the hand to the right, so the camera goes to the left: -x here.
    EXPECT_LT(window_->view().lookat_W.x(), before.lookat_W.x() - 0.1);
    EXPECT_EQ(window_->view().azimuth, before.azimuth);
  }
}

TEST_F(RealWindow, MovingWithoutAButtonDoesNothing) {
  const CameraView before = window_->view();
  xdotool({"mousemove", "50", "50", "mousemove", "300", "200"});
  frames_until([] { return false; }, 0.3);
  EXPECT_EQ(window_->view().azimuth, before.azimuth);
  EXPECT_EQ(window_->view().lookat_W, before.lookat_W);
}

TEST_F(RealWindow, SpacePausesAndBackspaceGoesBack) {
  EXPECT_FALSE(window_->paused());
  EXPECT_TRUE(act_until({"key", "space"}, [&] { return window_->paused(); }));
  EXPECT_TRUE(act_until({"key", "space"}, [&] { return !window_->paused(); }));
  window_->set_paused(true);
  EXPECT_TRUE(window_->paused());
  const CameraView before = window_->view();
  ASSERT_TRUE(
      act_until(drag("1", 60, 30), [&] { return window_->view().azimuth != before.azimuth; }));
  EXPECT_TRUE(
      act_until({"key", "BackSpace"}, [&] { return window_->view().azimuth == before.azimuth; }));
}

TEST_F(RealWindow, EscapeCloses) {
  EXPECT_TRUE(window_->is_open());
  EXPECT_TRUE(act_until({"key", "Escape"}, [&] { return !window_->is_open(); }));
}

TEST_F(RealWindow, PicturesCanBeDrawnBesideIt) {
  Result<OffscreenRenderer> renderer =
      OffscreenRenderer::create(model_, {.width = 60, .height = 40});
  if (!renderer) GTEST_SKIP() << renderer.error().what;
  const Result<Image> image = renderer->draw({}, {.name = "front"});
  ASSERT_TRUE(image) << image.error().what;
  EXPECT_GT(image->pixel(30, 20)[0], 150);
  EXPECT_TRUE(window_->draw({}));
}

TEST_F(RealWindow, RefusesASnapshotOfAnotherModel) {
  Snapshot other;
  other.state.resize(500);
  ASSERT_TRUE(frames_until([&] { return !window_->draw(other); }));
  EXPECT_TRUE(window_->is_open());
}

/// In a process of its own each: the connection to a display belongs to the process.
class WindowDeathTest : public ::testing::Test {
 protected:
  void SetUp() override { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};

/// Ends with code 0 where opening a window fails with a text that contains `part`.
[[noreturn]] void expect_refusal(const Model& model, const WindowOptions& options,
                                 const std::string& part) {
  const Result<Window> opened = Window::open(model, kTitle, options);
  if (!opened) std::fputs(opened.error().what.c_str(), stderr);
  const bool as_expected = !opened && opened.error().what.find(part) != std::string::npos &&
                           opened.error().what.find('\n') == std::string::npos;
  std::_Exit(as_expected ? 0 : 1);
}

TEST_F(WindowDeathTest, WithoutADisplaySaysWhatToDo) {
  const auto run = [] {
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
    expect_refusal(load_scene(), {}, "no display: use --headless");
  };
  EXPECT_EXIT(run(), ::testing::ExitedWithCode(0), "");
}

TEST_F(WindowDeathTest, ADisplayThatIsNotThereIsAnError) {
  const auto run = [] {
    setenv("DISPLAY", ":987", 1);
    unsetenv("WAYLAND_DISPLAY");
    expect_refusal(load_scene(), {}, "--headless");
  };
  EXPECT_EXIT(run(), ::testing::ExitedWithCode(0), "");
}

TEST_F(WindowDeathTest, AnUnknownCameraIsAnErrorBeforeAnythingOpens) {
  EXPECT_EXIT(expect_refusal(load_scene(), {.camera = {.name = "nose"}}, "front"),
              ::testing::ExitedWithCode(0), "");
  EXPECT_EXIT(expect_refusal(load_scene(), {.width = 0}, "0 x 800"), ::testing::ExitedWithCode(0),
              "");
}

/// A display that the test may switch off; its number comes from the server itself.
struct OwnDisplay {
  pid_t server = -1;
  std::string name;
};

OwnDisplay start_display() {
  int ends[2];
  if (pipe(ends) != 0) return {};
  const pid_t server = fork();
  if (server == 0) {
    dup2(open("/dev/null", O_WRONLY), STDERR_FILENO);
    const std::string number = std::to_string(ends[1]);
    execlp("Xvfb", "Xvfb", "-displayfd", number.c_str(), "-screen", "0", "640x480x24", nullptr);
    _exit(127);
  }
  close(ends[1]);
  std::string name = ":";
  for (char c = 0; read(ends[0], &c, 1) == 1 && c != '\n';) name += c;
  close(ends[0]);
  return {server, name};
}

/// Ends with code 0 where a window that loses its display says so and nothing else happens.
[[noreturn]] void lose_display() {
  const OwnDisplay display = start_display();
  if (display.name == ":") std::_Exit(77);
  setenv("DISPLAY", display.name.c_str(), 1);
  unsetenv("WAYLAND_DISPLAY");
  bool reported = false;
  {
    Result<Window> window = Window::open(load_scene(), kTitle, {.width = 300, .height = 200});
    if (window && window->draw({})) {
      kill(display.server, SIGKILL);
      waitpid(display.server, nullptr, 0);
      for (int i = 0; i < 2000 && !reported; ++i) {
        const Result<void> drawn = window->draw({});
        reported = !drawn && drawn.error().code == Errc::system;
      }
      reported = reported && !window->is_open() && !window->draw({}) && !window->picture();
    }
  }
  std::_Exit(reported ? 0 : 1);
}

TEST_F(WindowDeathTest, LosingTheDisplayIsAnErrorAndNoCrash) {
  if (std::system("command -v Xvfb >/dev/null") != 0) GTEST_SKIP() << "Xvfb is not installed";
  EXPECT_EXIT(lose_display(), ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace mjarm
