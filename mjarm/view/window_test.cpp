#include "mjarm/view/window.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>

#include "mjarm/render/offscreen.hpp"
#include "mjarm/view/real_window_test.hpp"

namespace mjarm::view {
namespace {

using testing::kWindowTitle;
using testing::RealWindow;
using testing::window_scene;

TEST_F(RealWindow, ShowsTheModelTheOverlayAndPlots) {
  render::Overlay overlay;
  overlay.spheres.push_back({{-0.7, 0, 0.6}, 0.2, {0, 0, 1, 1}});
  ASSERT_TRUE(window_->draw({}, overlay));
  const auto color_at = [this](double x, double y) {
    const render::Image image = window_->picture().value();
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
  const render::CameraView before = window_->view();
  ASSERT_TRUE(
      act_until(drag("1", 60, 30), [&] { return window_->view().elevation != before.elevation; }));
  const render::CameraView after = window_->view();
  // To the right and down by 60 and 30 of 300 pixels, half a turn over the height.
  EXPECT_NEAR(after.azimuth - before.azimuth, -0.2 * 3.14159, 0.02);
  EXPECT_NEAR(after.elevation - before.elevation, -0.1 * 3.14159, 0.02);
  EXPECT_EQ(after.lookat_W, before.lookat_W);
  EXPECT_EQ(after.distance, before.distance);
}

TEST_F(RealWindow, WheelZooms) {
  const render::CameraView before = window_->view();
  ASSERT_TRUE(act_until({"mousemove", "200", "150", "click", "4"},
                        [&] { return window_->view().distance != before.distance; }));
  EXPECT_LT(window_->view().distance, before.distance);
  const render::CameraView near = window_->view();
  ASSERT_TRUE(act_until({"mousemove", "200", "150", "click", "--repeat", "2", "5"},
                        [&] { return window_->view().distance > before.distance; }));
  EXPECT_EQ(window_->view().azimuth, near.azimuth);
}

TEST_F(RealWindow, RightAndMiddleDragPan) {
  for (const char* button : {"3", "2"}) {
    const render::CameraView before = window_->view();
    ASSERT_TRUE(act_until(drag(button, 60, 0),
                          [&] { return window_->view().lookat_W != before.lookat_W; }));
    // The world follows the hand to the right, so the camera goes to the left: -x here.
    EXPECT_LT(window_->view().lookat_W.x(), before.lookat_W.x() - 0.1);
    EXPECT_EQ(window_->view().azimuth, before.azimuth);
  }
}

TEST_F(RealWindow, MovingWithoutAButtonDoesNothing) {
  const render::CameraView before = window_->view();
  xdotool({"mousemove", "50", "50", "mousemove", "300", "200"});
  frames_until([] { return false; }, 0.3);
  EXPECT_EQ(window_->view().azimuth, before.azimuth);
  EXPECT_EQ(window_->view().lookat_W, before.lookat_W);
}

TEST_F(RealWindow, SpacePausesAndControlAGoesBack) {
  EXPECT_FALSE(window_->paused());
  EXPECT_TRUE(act_until({"key", "space"}, [&] { return window_->paused(); }));
  EXPECT_TRUE(act_until({"key", "space"}, [&] { return !window_->paused(); }));
  window_->set_paused(true);
  EXPECT_TRUE(window_->paused());
  const render::CameraView before = window_->view();
  ASSERT_TRUE(
      act_until(drag("1", 60, 30), [&] { return window_->view().azimuth != before.azimuth; }));
  EXPECT_TRUE(
      act_until({"key", "ctrl+a"}, [&] { return window_->view().azimuth == before.azimuth; }));
}

TEST_F(RealWindow, EscapeCloses) {
  EXPECT_TRUE(window_->is_open());
  EXPECT_TRUE(act_until({"key", "Escape"}, [&] { return !window_->is_open(); }));
}

TEST_F(RealWindow, PicturesCanBeDrawnBesideIt) {
  Result<render::OffscreenRenderer> renderer =
      render::OffscreenRenderer::create(model_, {.width = 60, .height = 40});
  if (!renderer) GTEST_SKIP() << renderer.error().what;
  const Result<render::Image> image = renderer->draw({}, {.name = "front"});
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
  const Result<Window> opened = Window::open(model, kWindowTitle, options);
  if (!opened) std::fputs(opened.error().what.c_str(), stderr);
  const bool as_expected = !opened && opened.error().what.find(part) != std::string::npos &&
                           opened.error().what.find('\n') == std::string::npos;
  std::_Exit(as_expected ? 0 : 1);
}

TEST_F(WindowDeathTest, WithoutADisplaySaysWhatToDo) {
  const auto run = [] {
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
    expect_refusal(window_scene(), {}, "no display: mjarm serve");
  };
  EXPECT_EXIT(run(), ::testing::ExitedWithCode(0), "");
}

TEST_F(WindowDeathTest, ADisplayThatIsNotThereIsAnError) {
  const auto run = [] {
    setenv("DISPLAY", ":987", 1);
    unsetenv("WAYLAND_DISPLAY");
    expect_refusal(window_scene(), {}, "--headless");
  };
  EXPECT_EXIT(run(), ::testing::ExitedWithCode(0), "");
}

TEST_F(WindowDeathTest, AnUnknownCameraIsAnErrorBeforeAnythingOpens) {
  EXPECT_EXIT(expect_refusal(window_scene(), {.camera = {.name = "nose"}}, "front"),
              ::testing::ExitedWithCode(0), "");
  EXPECT_EXIT(expect_refusal(window_scene(), {.width = 0}, "0 x 800"), ::testing::ExitedWithCode(0),
              "");
}

/// A display that the test may switch off; its number comes from the server itself.
struct OwnDisplay {
  pid_t server = -1;
  std::string name;
};

OwnDisplay start_display(const char* option = "-noreset", const char* value = nullptr) {
  int ends[2];
  if (pipe(ends) != 0) return {};
  const pid_t server = fork();
  if (server == 0) {
    dup2(open("/dev/null", O_WRONLY), STDERR_FILENO);
    const std::string number = std::to_string(ends[1]);
    execlp("Xvfb", "Xvfb", "-displayfd", number.c_str(), "-screen", "0", "640x480x24", option,
           value, nullptr);
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
    Result<Window> window =
        Window::open(window_scene(), kWindowTitle, {.width = 300, .height = 200});
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

/// Ends with code 0 where a display without OpenGL gives one line.
[[noreturn]] void open_without_gl() {
  const OwnDisplay display = start_display("-extension", "GLX");
  if (display.name == ":") std::_Exit(77);
  setenv("DISPLAY", display.name.c_str(), 1);
  unsetenv("WAYLAND_DISPLAY");
  const Result<Window> opened = Window::open(window_scene(), kWindowTitle);
  kill(display.server, SIGKILL);
  waitpid(display.server, nullptr, 0);
  const bool as_expected = !opened && opened.error().code == Errc::not_available &&
                           opened.error().what.find('\n') == std::string::npos;
  std::_Exit(as_expected ? 0 : 1);
}

TEST_F(WindowDeathTest, ADisplayWithoutOpenGlIsAnErrorAndNoCrash) {
  if (std::system("command -v Xvfb >/dev/null") != 0) GTEST_SKIP() << "Xvfb is not installed";
  EXPECT_EXIT(open_without_gl(), ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace mjarm::view
