#include "mjarm/view/window.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/messages/view.hpp"
#include "mjarm/model/mujoco_guard.hpp"
#include "mjarm/render/fonts.hpp"
#include "mjarm/render/gl_context.hpp"
#include "mjarm/view/display_internal.hpp"
#include "mjarm/view/figure_internal.hpp"
#include "mjarm/view/glyph_font_internal.hpp"
#include "mjarm/view/hud_internal.hpp"
#include "mjarm/view/interaction_internal.hpp"
#include "mjarm/view/screenshot_internal.hpp"
#include "mjarm/view/settings_internal.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace mjarm::view {
namespace {

constexpr int kMaxSize = 16384;
constexpr double kFramePeriod = 1.0 / 60;  // [s]
constexpr double kLeastRest = 1e-3;        // [s] between two frames, for whoever else works
constexpr double kLongestRest = 2e-3;      // [s] that one call of draw may take for nothing
constexpr double kIconPeriod = 0.05;       // [s] between two looks at a window that is an icon
constexpr double kNoteTime = 4;            // [s] a note stays
constexpr int kPanelEvery = 4;             // frames from one update of the panels to the next

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The font that is as large as `scale` asks for (1 = a plain screen).
int font_scale(float scale) {
  const int steps = static_cast<int>(std::lround(scale * 2));  // halves
  return std::clamp(50 * steps, static_cast<int>(mjFONTSCALE_100),
                    static_cast<int>(mjFONTSCALE_300));
}

void flip_rows(render::Image& image) {
  const auto row = 3 * static_cast<std::ptrdiff_t>(image.width);
  for (auto top = image.rgb.begin(), bottom = image.rgb.end() - row; top < bottom;
       top += row, bottom -= row) {
    std::swap_ranges(top, top + row, bottom);
  }
}

Error display_lost_error() { return {Errc::system, text(msg::view_display_lost)}; }

}  // namespace

struct Window::Impl {
  Impl(GlWindow window, const Model& model, const WindowOptions& chosen, double opened)
      : handle(window.handle),
        options(chosen),
        scene(model, window.quality, window.software),
        panels(scene.model(), chosen.jog_dofs, chosen.can_step, chosen.can_reset),
        user(scene, panels, {chosen.can_step, chosen.can_reset, chosen.can_push, chosen.can_target},
             chosen.paused),
        counter(opened) {
    gather_inputs(handle, inputs);
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

  Result<void> upload();
  [[nodiscard]] bool is_icon() const;
  void fill_figures(std::span<const LivePlot> plots);
  void handle_inputs();
  void prepare(const render::Overlay& overlay, std::span<const PanelSection> sections);
  void render();
  void render_plots(const mjrRect& view, const TextTools& tools);
  [[nodiscard]] HudText hud() const;
  [[nodiscard]] render::Image read_picture();
  void save_picture();

  GLFWwindow* handle;
  WindowOptions options;
  render::Scene scene;
  Panels panels;
  Interaction user;
  FrameCounter counter;
  mjrContext context{};
  std::unique_ptr<GlyphFont> font;
  RawInputs inputs;
  DrawHook draw_hook;
  GamepadHook gamepad_hook;
  double time = 0;  ///< [s] of the state shown
  std::string status;
  std::string note;
  double note_until = 0;  ///< [s]
  std::vector<mjvFigure> figures;
  std::vector<std::optional<LivePlot>> figures_of;  ///< what they show
  long frame = 0;
  bool panels_changed = true;
  double next_frame = 0;  ///< [s]
};

/// Hands the model to OpenGL.
Result<void> Window::Impl::upload() {
  float scale = 1;
  glfwGetWindowContentScale(handle, &scale, nullptr);
  const MujocoOutcome outcome =
      call_mujoco([&] { mjr_makeContext(&scene.model(), &context, font_scale(scale)); });
  if (!outcome.failed) font = std::make_unique<GlyphFont>(context.charHeight, glfwGetProcAddress);
  glfwMakeContextCurrent(nullptr);
  if (!outcome.failed) return {};
  return fail(Errc::not_available, text(msg::view_no_window, outcome.error));
}

bool Window::Impl::is_icon() const {
  int width = 0;
  int height = 0;
  glfwGetFramebufferSize(handle, &width, &height);
  return width < 1 || height < 1 || glfwGetWindowAttrib(handle, GLFW_ICONIFIED) == GLFW_TRUE;
}

void Window::Impl::fill_figures(std::span<const LivePlot> plots) {
  figures.resize(plots.size());
  figures_of.resize(plots.size());
  for (std::size_t i = 0; i < plots.size(); ++i) {
    if (figures_of[i] == plots[i]) continue;
    fill_figure(plots[i], figures[i]);
    figures_of[i] = plots[i];
  }
}

void Window::Impl::handle_inputs() {
  int width = 0;
  int height = 0;
  glfwGetFramebufferSize(handle, &width, &height);
  const mjrRect& whole = panels.state().rect[0];
  if (whole.width != width || whole.height != height) panels.resize(width, height);
  for (const RawInput& input : std::exchange(inputs.all, {})) {
    user.handle(input, context);
    panels_changed = true;
  }
  if (auto said = user.take_said()) {
    note = std::move(*said);
    note_until = seconds_now() + kNoteTime;
  }
  if (user.close_wanted()) glfwSetWindowShouldClose(handle, GLFW_TRUE);
}

void Window::Impl::prepare(const render::Overlay& overlay, std::span<const PanelSection> sections) {
  user.update();
  apply(user.settings, scene);
  scene.set_dynamics(needs_dynamics(user.settings) || user.picker.body() >= 0);
  if (draw_hook) {
    mjv_updateCamera(&scene.model(), &scene.data(), &scene.camera(), &scene.raw());
    render::Overlay with_tools = overlay;
    draw_hook(eye_of(scene), with_tools);
    scene.update(with_tools);
  } else {
    scene.update(overlay);
  }
  if (std::exchange(panels_changed, false) || frame % kPanelEvery == 0) {
    mjr_setBuffer(mjFB_WINDOW, &context);
    panels.show(user.settings, {&scene.data(), user.paused(), user.speed()}, sections, context);
  }
  if (seconds_now() > note_until) note.clear();
}

HudText Window::Impl::hud() const {
  return {.time = time,
          .paused = user.paused(),
          .speed = user.speed(),
          .camera = user.camera.name(),
          .selected = user.picker.describe(),
          .status = status,
          .note = note,
          .help = user.help_shown(),
          .help_rows = options.help,
          .stats = counter.stats()};
}

/// Draws what was last set into the back buffer.
void Window::Impl::render() {
  mjr_setBuffer(mjFB_WINDOW, &context);
  const mjrRect& view = panels.view();
  if (view.width > 0) mjr_render(view, &scene.raw(), &context);
  const mjrRect& whole = panels.state().rect[0];
  const TextTools tools{context, *font, {0, 0, whole.width, whole.height}};
  render_plots(view, tools);
  draw_hud(hud(), view, tools);
  panels.render(context, *font);
}

/// Figures stand one above the other at the right edge.
void Window::Impl::render_plots(const mjrRect& view, const TextTools& tools) {
  const int count = static_cast<int>(figures.size());
  if (count == 0) return;
  const int width = view.width * 3 / 10;
  const int height = std::min(view.height / std::max(count, 2), width);
  for (int i = 0; i < count; ++i) {
    const mjrRect place = {view.left + view.width - width, view.height - (i + 1) * height, width,
                           height};
    const auto k = static_cast<std::size_t>(i);
    draw_figure(*figures_of[k], figures[k], place, tools);
  }
}

render::Image Window::Impl::read_picture() {
  const mjrRect& whole = panels.state().rect[0];
  render::Image image{whole.width, whole.height, {}};
  image.rgb.resize(3 * static_cast<std::size_t>(image.width) * image.height);
  mjr_readPixels(image.rgb.data(), nullptr, whole, &context);
  flip_rows(image);
  return image;
}

void Window::Impl::save_picture() {
  if (options.screenshots.empty()) {
    user.say(text(msg::view_no_folder));
    return;
  }
  ScreenshotEvent event;
  if (auto file = save_screenshot(read_picture(), options.screenshots)) {
    event.file = file->string();
  } else {
    event.error = file.error().what;
  }
  user.say(event.error.empty() ? text(msg::view_written, event.file) : text(msg::view_not_written));
  user.tell(std::move(event));
}

Result<Window> Window::open(const Model& model, const std::string& title,
                            const WindowOptions& options) {
  const double opened = seconds_now();
  const auto fits = [](int size) { return size >= 1 && size <= kMaxSize; };
  if (!fits(options.width) || !fits(options.height)) {
    return fail(Errc::bad_input, text(msg::view_bad_size, options.width, options.height, kMaxSize));
  }
  if (Result<void> checked = render::check_camera(model, options.camera); !checked) {
    return fail(std::move(checked.error()));
  }
  if (Result<void> display = open_display(); !display) return fail(std::move(display.error()));
  Result<void> claimed = render::claim_gl(render::GlKind::egl);
  Result<GlWindow> window =
      claimed ? open_gl_window(options.width, options.height, title, options.quality)
              : fail(std::move(claimed.error()));
  if (!window) {
    close_display();
    return fail(std::move(window.error()));
  }
  auto impl = std::make_unique<Impl>(*window, model, options, opened);
  if (Result<void> uploaded = impl->upload(); !uploaded) return fail(std::move(uploaded.error()));
  if (Result<void> set = impl->scene.set_camera(options.camera); !set) {
    return fail(std::move(set.error()));
  }
  impl->user.camera.begin();
  if (options.right_panel) impl->panels.toggle_right();
  if (!options.joints_open) impl->panels.fold_joints();
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
bool Window::paused() const noexcept { return impl_->user.paused(); }
void Window::set_paused(bool paused) noexcept { impl_->user.set_paused(paused); }
void Window::set_status(std::string line) { impl_->status = std::move(line); }
const ViewSettings& Window::settings() const noexcept { return impl_->user.settings; }
void Window::set_settings(const ViewSettings& settings) { impl_->user.settings = settings; }
void Window::set_mouse_hook(MouseHook hook) { impl_->user.set_hook(std::move(hook)); }
void Window::set_key_hook(KeyHook hook) { impl_->inputs.key_hook = std::move(hook); }
void Window::set_gamepad_hook(GamepadHook hook) { impl_->gamepad_hook = std::move(hook); }
void Window::set_draw_hook(DrawHook hook) { impl_->draw_hook = std::move(hook); }
std::vector<ViewEvent> Window::take_events() { return impl_->user.take_events(); }
render::CameraView Window::view() const { return impl_->scene.view(); }
std::string Window::camera_name() const { return impl_->user.camera.name(); }
ViewStats Window::stats() const { return impl_->counter.stats(); }

std::optional<Window::Spot> Window::item_spot(bool left, int section, int item) const {
  const std::optional<mjrRect> rect = impl_->panels.place(left, section, item);
  if (!rect) return {};
  return Spot{rect->left + 0.5 * rect->width,
              impl_->panels.state().rect[0].height - rect->bottom - 0.5 * rect->height};
}

Result<void> Window::draw(const Snapshot& snapshot, const render::Overlay& overlay,
                          std::span<const LivePlot> plots, std::span<const PanelSection> panels) {
  if (display_lost()) return fail(display_lost_error());
  const double begin = seconds_now();
  if (impl_->gamepad_hook) look_at_gamepads(impl_->gamepad_hook);
  if (begin < impl_->next_frame) {
    glfwWaitEventsTimeout(std::min(impl_->next_frame - begin, kLongestRest));
    if (display_lost()) return fail(display_lost_error());
    return {};
  }
  glfwPollEvents();
  if (display_lost()) return fail(display_lost_error());
  if (Result<void> set = impl_->scene.set_state(snapshot); !set) return set;
  impl_->time = snapshot.time;
  if (impl_->is_icon()) {
    impl_->next_frame = begin + kIconPeriod;
    return {};
  }
  const LanguageScope drawn(render::picture_language());
  impl_->fill_figures(plots);
  glfwMakeContextCurrent(impl_->handle);
  impl_->handle_inputs();
  impl_->prepare(overlay, panels);
  impl_->render();
  if (impl_->user.take_screenshot()) impl_->save_picture();
  glfwSwapBuffers(impl_->handle);
  glfwMakeContextCurrent(nullptr);  // so that a picture may be drawn in between
  if (display_lost()) return fail(display_lost_error());
  const double end = seconds_now();
  ++impl_->frame;
  impl_->counter.add(begin, end, snapshot.time, impl_->user.paused());
  impl_->next_frame = std::max(begin + kFramePeriod, end + kLeastRest);
  return {};
}

Result<render::Image> Window::picture() {
  if (display_lost()) return fail(display_lost_error());
  const LanguageScope drawn(render::picture_language());
  glfwMakeContextCurrent(impl_->handle);
  impl_->render();
  render::Image image = impl_->read_picture();
  glfwMakeContextCurrent(nullptr);
  return image;
}

}  // namespace mjarm::view
