#include "mjarm/view/window.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

#include "mjarm/core/messages/view.hpp"
#include "mjarm/model/mujoco_guard.hpp"
#include "mjarm/render/gl_context.hpp"
#include "mjarm/view/display_internal.hpp"
#include "mjarm/view/figure_internal.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace mjarm {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr int kMaxSize = 16384;
constexpr double kFramePeriod = 1.0 / 60;  // [s]
constexpr double kDegPerHeight = 180;      // a drag over the height of the window turns this far
constexpr double kZoomPerNotch = 0.1;
constexpr const char* kHelp =
    "left drag: turn   right drag: pan   wheel: zoom   space: pause   backspace: first view   "
    "Esc: close";

/// The font that is as large as `scale` asks for (1 = a plain screen).
int font_scale(float scale) {
  const int steps = static_cast<int>(std::lround(scale * 2));  // halves
  return std::clamp(50 * steps, static_cast<int>(mjFONTSCALE_100),
                    static_cast<int>(mjFONTSCALE_300));
}

void flip_rows(Image& image) {
  const auto row = 3 * static_cast<std::ptrdiff_t>(image.width);
  for (auto top = image.rgb.begin(), bottom = image.rgb.end() - row; top < bottom;
       top += row, bottom -= row) {
    std::swap_ranges(top, top + row, bottom);
  }
}

}  // namespace

struct Window::Impl {
  Impl(GlWindow window, const Model& model, const WindowOptions& options)
      : handle(window.handle), scene(model, window.quality), is_paused(options.paused) {
    glfwSetWindowUserPointer(handle, this);
    glfwSetKeyCallback(handle, on_key);
    glfwSetScrollCallback(handle, on_scroll);
    glfwSetCursorPosCallback(handle, on_move);
    glfwSwapInterval(0);
    mjr_defaultContext(&context);
  }
  // Once the display is lost, all that belongs to it is left to the end of the process.
  ~Impl() {
    if (display_lost()) return;
    glfwMakeContextCurrent(handle);
    mjr_freeContext(&context);
    glfwDestroyWindow(handle);
    close_display();
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  static Impl& self(GLFWwindow* window) {
    return *static_cast<Impl*>(glfwGetWindowUserPointer(window));
  }
  static void on_key(GLFWwindow* window, int key, int, int action, int);
  static void on_scroll(GLFWwindow* window, double, double notches);
  static void on_move(GLFWwindow* window, double x, double y);

  Result<void> upload();
  void set_view(const CameraView& view);
  void turn_or_pan(double dx, double dy);
  void render();
  void render_plots(const mjrRect& viewport);

  GLFWwindow* handle;
  Scene scene;
  mjrContext context{};
  CameraView first_view;
  bool is_paused;
  double cursor_x = 0;
  double cursor_y = 0;
  double time = 0;  ///< [s] of the state shown
  std::string status;
  std::vector<mjvFigure> figures;
  Clock::time_point next_frame = Clock::now();
};

void Window::Impl::on_key(GLFWwindow* window, int key, int, int action, int) {
  if (action != GLFW_PRESS) return;
  Impl& impl = self(window);
  if (key == GLFW_KEY_SPACE) impl.is_paused = !impl.is_paused;
  if (key == GLFW_KEY_BACKSPACE) impl.set_view(impl.first_view);
  if (key == GLFW_KEY_ESCAPE) glfwSetWindowShouldClose(window, GLFW_TRUE);
  impl.next_frame = Clock::now();
}

void Window::Impl::on_scroll(GLFWwindow* window, double, double notches) {
  Impl& impl = self(window);
  double& distance = impl.scene.camera().distance;
  const double extent = impl.scene.model().stat.extent;
  distance = std::clamp(distance * std::exp(-kZoomPerNotch * notches), 0.01 * extent, 100 * extent);
}

void Window::Impl::on_move(GLFWwindow* window, double x, double y) {
  Impl& impl = self(window);
  const double dx = x - std::exchange(impl.cursor_x, x);
  const double dy = y - std::exchange(impl.cursor_y, y);
  int width = 0;
  int height = 0;
  glfwGetWindowSize(window, &width, &height);
  if (height > 0) impl.turn_or_pan(dx / height, dy / height);
}

/// @param dx, dy way of the cursor as a share of the window's height, y down.
void Window::Impl::turn_or_pan(double dx, double dy) {
  const auto pressed = [this](int button) {
    return glfwGetMouseButton(handle, button) == GLFW_PRESS;
  };
  mjvCamera& camera = scene.camera();
  if (pressed(GLFW_MOUSE_BUTTON_LEFT)) {
    camera.azimuth = std::remainder(camera.azimuth - kDegPerHeight * dx, 360);
    camera.elevation = std::clamp(camera.elevation - kDegPerHeight * dy, -89.9, 89.9);
  } else if (pressed(GLFW_MOUSE_BUTTON_RIGHT) || pressed(GLFW_MOUSE_BUTTON_MIDDLE)) {
    mjv_moveCamera(&scene.model(), mjMOUSE_MOVE_V, dx, dy, &camera);
  }
}

/// Hands the model to OpenGL.
Result<void> Window::Impl::upload() {
  float scale = 1;
  glfwGetWindowContentScale(handle, &scale, nullptr);
  const MujocoOutcome outcome =
      call_mujoco([&] { mjr_makeContext(&scene.model(), &context, font_scale(scale)); });
  glfwMakeContextCurrent(nullptr);
  if (!outcome.failed) return {};
  return fail(Errc::not_available, text(msg::view_no_window, outcome.error));
}

void Window::Impl::set_view(const CameraView& view) {
  // A view that was taken from a camera or checked before is never refused.
  (void)scene.set_camera({.view = view});
}

/// Draws what was last set into the back buffer.
void Window::Impl::render() {
  mjrRect viewport = {0, 0, 0, 0};
  glfwGetFramebufferSize(handle, &viewport.width, &viewport.height);
  if (viewport.width < 1 || viewport.height < 1) return;  // minimised
  mjr_setBuffer(mjFB_WINDOW, &context);
  mjr_render(viewport, &scene.raw(), &context);
  render_plots(viewport);
  char clock[64];
  std::snprintf(clock, sizeof(clock), "%s%.2f s", is_paused ? "paused   " : "", time);
  mjr_overlay(mjFONT_NORMAL, mjGRID_TOPLEFT, viewport, clock, nullptr, &context);
  const std::string foot = status.empty() ? std::string(kHelp) : status + "\n" + kHelp;
  mjr_overlay(mjFONT_NORMAL, mjGRID_BOTTOMLEFT, viewport, foot.c_str(), nullptr, &context);
}

/// Figures stand one above the other at the right edge.
void Window::Impl::render_plots(const mjrRect& viewport) {
  const int count = static_cast<int>(figures.size());
  if (count == 0) return;
  const int width = viewport.width * 3 / 10;
  const int height = std::min(viewport.height / std::max(count, 2), width);
  for (int i = 0; i < count; ++i) {
    const mjrRect place = {viewport.width - width, viewport.height - (i + 1) * height, width,
                           height};
    mjr_figure(place, &figures[i], &context);
  }
}

Result<Window> Window::open(const Model& model, const std::string& title,
                            const WindowOptions& options) {
  const auto fits = [](int size) { return size >= 1 && size <= kMaxSize; };
  if (!fits(options.width) || !fits(options.height)) {
    return fail(Errc::bad_input, text(msg::view_bad_size, options.width, options.height, kMaxSize));
  }
  if (Result<void> checked = check_camera(model, options.camera); !checked) {
    return fail(std::move(checked.error()));
  }
  if (Result<void> opened = open_display(); !opened) return fail(std::move(opened.error()));
  Result<void> claimed = claim_gl(GlKind::egl);
  Result<GlWindow> window =
      claimed ? open_gl_window(options.width, options.height, title, options.quality)
              : fail(std::move(claimed.error()));
  if (!window) {
    close_display();
    return fail(std::move(window.error()));
  }
  auto impl = std::make_unique<Impl>(*window, model, options);
  if (Result<void> uploaded = impl->upload(); !uploaded) return fail(std::move(uploaded.error()));
  if (Result<void> set = impl->scene.set_camera(options.camera); !set) {
    return fail(std::move(set.error()));
  }
  impl->first_view = impl->scene.view();
  impl->set_view(impl->first_view);
  glfwShowWindow(impl->handle);
  return Window(std::move(impl));
}

Window::Window(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Window::~Window() = default;
Window::Window(Window&&) noexcept = default;
Window& Window::operator=(Window&&) noexcept = default;

bool Window::is_open() const noexcept {
  return !display_lost() && glfwWindowShouldClose(impl_->handle) == GLFW_FALSE;
}
bool Window::paused() const noexcept { return impl_->is_paused; }
void Window::set_paused(bool paused) noexcept { impl_->is_paused = paused; }
void Window::set_status(std::string line) { impl_->status = std::move(line); }
CameraView Window::view() const { return impl_->scene.view(); }

Result<void> Window::draw(const Snapshot& snapshot, const Overlay& overlay,
                          std::span<const LivePlot> plots) {
  const auto lost = [] { return fail(Errc::system, text(msg::view_display_lost)); };
  if (display_lost()) return lost();
  if (Clock::now() < impl_->next_frame) {
    glfwWaitEventsTimeout(0.001);
    if (display_lost()) return lost();
    return {};
  }
  const Clock::time_point begin = Clock::now();
  if (Result<void> set = impl_->scene.set_state(snapshot); !set) return set;
  impl_->scene.update(overlay);
  impl_->time = snapshot.time;
  impl_->figures.resize(plots.size());
  for (std::size_t i = 0; i < plots.size(); ++i) {
    fill_figure(plots[i], impl_->figures[i]);
  }
  glfwMakeContextCurrent(impl_->handle);
  impl_->render();
  glfwSwapBuffers(impl_->handle);
  glfwMakeContextCurrent(nullptr);  // so that a picture may be drawn in between
  glfwPollEvents();
  if (display_lost()) return lost();
  // Slow drawing takes at most two thirds of the time, so that the physics goes on.
  const Clock::time_point end = Clock::now();
  const double spent = Seconds(end - begin).count();
  const double rest = std::max(kFramePeriod - spent, spent / 2);
  impl_->next_frame = end + std::chrono::duration_cast<Clock::duration>(Seconds(rest));
  return {};
}

Result<Image> Window::picture() {
  if (display_lost()) return fail(Errc::system, text(msg::view_display_lost));
  glfwMakeContextCurrent(impl_->handle);
  impl_->render();
  mjrRect viewport = {0, 0, 0, 0};
  glfwGetFramebufferSize(impl_->handle, &viewport.width, &viewport.height);
  Image image{viewport.width, viewport.height, {}};
  image.rgb.resize(3 * static_cast<std::size_t>(image.width) * image.height);
  mjr_readPixels(image.rgb.data(), nullptr, viewport, &impl_->context);
  glfwMakeContextCurrent(nullptr);
  flip_rows(image);
  return image;
}

}  // namespace mjarm
