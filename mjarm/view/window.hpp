#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/render/camera.hpp"
#include "mjarm/render/image.hpp"
#include "mjarm/render/overlay.hpp"
#include "mjarm/render/scene.hpp"
#include "mjarm/sim/sim.hpp"
#include "mjarm/view/controls.hpp"
#include "mjarm/view/device_input.hpp"
#include "mjarm/view/draw_hook.hpp"
#include "mjarm/view/events.hpp"
#include "mjarm/view/live_plot.hpp"
#include "mjarm/view/mouse_input.hpp"
#include "mjarm/view/panel_section.hpp"
#include "mjarm/view/settings.hpp"
#include "mjarm/view/view_stats.hpp"

namespace mjarm::view {

/// How a window opens. Every default is usable as is.
struct WindowOptions {
  int width = 1280;            ///< [screen units] > 0
  int height = 800;            ///< [screen units] > 0
  render::Camera camera = {};  ///< a named camera is where the free camera starts
  std::optional<render::RenderQuality> quality = {};  ///< default: high with a GPU, low without
  bool paused = false;                                ///< starts paused
  bool can_step = true;                               ///< the application follows StepEvent
  bool can_reset = true;                              ///< ... and ResetEvent
  bool can_push = true;                               ///< ... and PushEvent
  bool can_target = false;                            ///< ... and TargetEvent
  bool can_lead = false;                              ///< ... and, of a page, LeadEvent
  std::vector<int> jog_dofs = {};                     ///< ... and JointEvent of these dofs
  std::filesystem::path screenshots = {};  ///< folder of pictures the user takes; empty = none
  bool right_panel = false;                ///< is shown at first
  bool joints_open = true;                 ///< its section of joints is unfolded at first
  std::vector<ControlHelp> help = {};      ///< rows of the help; empty: control_help()
};

/// A window that shows a simulated world. The caller owns the loop and the physics; what the user
/// wants comes back as events:
///
///     while (window.is_open()) {
///       for (const ViewEvent& event : window.take_events()) { ... }
///       for (int n = playback.steps_due(); n > 0; --n) { ... sim.step(...) ... }
///       if (auto drawn = window.draw(sim.snapshot(), overlay, plots); !drawn) return fail(...);
///     }
///
/// With the physics in a thread of its own a slow picture never slows it: see `ViewLink`. What
/// mouse and keys do is listed in `control_help`. Used from the main thread only; one at a time.
class Window {
 public:
  /// @return not_available with a hint at `--headless` where there is no display or no OpenGL,
  ///         bad_input for a camera the model does not have.
  [[nodiscard]] static Result<Window> open(const Model& model, const std::string& title,
                                           const WindowOptions& options = {});
  ~Window();
  Window(Window&&) noexcept;
  Window& operator=(Window&&) noexcept;

  /// False once the user closed the window or the display was lost.
  [[nodiscard]] bool is_open() const noexcept;
  /// True while the user has paused the simulation.
  [[nodiscard]] bool paused() const noexcept;
  void set_paused(bool paused) noexcept;
  /// One line at the lower left, e.g. the worst error so far; empty = none.
  void set_status(std::string line);
  /// What is shown; the user changes it by keys and in the panel.
  [[nodiscard]] const ViewSettings& settings() const noexcept;
  void set_settings(const ViewSettings& settings);
  /// Lets a tool in the scene use the mouse before the camera does.
  void set_mouse_hook(MouseHook hook);
  /// Lets an application use keys before the window does.
  void set_key_hook(KeyHook hook);
  /// Tells an application of a gamepad.
  void set_gamepad_hook(GamepadHook hook);
  /// Lets it add to the overlay of every frame.
  void set_draw_hook(DrawHook hook);

  /// What the user did since the last call, in order.
  [[nodiscard]] std::vector<ViewEvent> take_events();

  /// Draws the latest state when the next of 60 frames a second is due, and lets mouse and keys
  /// act; before that it rests for at most two milliseconds. Never waits for the screen.
  /// @param panels  the application's own sections of the right panel.
  /// @return system where the display was lost; bad_input where the snapshot does not fit.
  [[nodiscard]] Result<void> draw(const Snapshot& snapshot, const render::Overlay& overlay = {},
                                  std::span<const LivePlot> plots = {},
                                  std::span<const PanelSection> panels = {});

  /// The last frame again, as a picture of the size of the window's framebuffer.
  [[nodiscard]] Result<render::Image> picture();
  /// Where the camera stands now.
  [[nodiscard]] render::CameraView view() const;
  /// Name of the model's camera that is looked through; empty for the free camera.
  [[nodiscard]] std::string camera_name() const;
  /// How well it keeps up.
  [[nodiscard]] ViewStats stats() const;

  /// Where an item of a panel is on the window [pixels from its upper left], its middle; none where
  /// it is not shown. `item` = -1 is the title. For tests, which press it.
  struct Spot {
    double x = 0;
    double y = 0;
  };
  [[nodiscard]] std::optional<Spot> item_spot(bool left, int section, int item) const;

 private:
  struct Impl;
  explicit Window(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace mjarm::view
