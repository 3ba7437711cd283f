#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/render/camera.hpp"
#include "mjarm/render/image.hpp"
#include "mjarm/render/overlay.hpp"
#include "mjarm/render/scene.hpp"
#include "mjarm/sim/sim.hpp"
#include "mjarm/view/live_plot.hpp"

namespace mjarm {

/// How a window opens. Every default is usable as is.
struct WindowOptions {
  int width = 1280;                           ///< [screen units] > 0
  int height = 800;                           ///< [screen units] > 0
  Camera camera = {};                         ///< a named camera is where the free camera starts
  std::optional<RenderQuality> quality = {};  ///< default: high with a GPU, low without
  bool paused = false;                        ///< starts paused
};

/// A window that shows a simulated world. The caller owns the loop and the physics:
///
///     while (window.is_open()) {
///       for (int n = pacer.steps_due(window.paused()); n > 0; --n) { ... sim.step(...) ... }
///       if (auto drawn = window.draw(sim.snapshot(), overlay, plots); !drawn) return fail(...);
///     }
///
/// Left drag turns, wheel zooms, right or middle drag pans, space pauses, backspace goes back to
/// the first view, Esc or closing ends. Used from the main thread only; one at a time.
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
  /// One line at the lower left, ASCII, e.g. the worst error so far; empty = none.
  void set_status(std::string line);

  /// Draws the latest state when the next of 60 frames a second is due; before that it only handles
  /// mouse and keys and rests for a millisecond. Never waits for the screen.
  /// @return system where the display was lost; bad_input where the snapshot does not fit.
  [[nodiscard]] Result<void> draw(const Snapshot& snapshot, const Overlay& overlay = {},
                                  std::span<const LivePlot> plots = {});

  /// The last frame again, as a picture of the size of the window's framebuffer.
  [[nodiscard]] Result<Image> picture();
  /// Where the camera stands now.
  [[nodiscard]] CameraView view() const;

 private:
  struct Impl;
  explicit Window(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace mjarm
