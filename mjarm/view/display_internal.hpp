#pragma once

#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/render/scene.hpp"

struct GLFWwindow;

namespace mjarm::view {

/// Starts the window system. Closed with `close_display`.
[[nodiscard]] Result<void> open_display();
void close_display() noexcept;

/// True once the connection to the display broke: from then on no window function may be called.
[[nodiscard]] bool display_lost() noexcept;

/// A window with a current OpenGL context, and the quality it can afford.
struct GlWindow {
  GLFWwindow* handle = nullptr;
  render::RenderQuality quality = render::RenderQuality::high;
  bool software = false;  ///< the processor draws
};

/// Opens a window; smoothed where the picture is drawn by a GPU or `high` is asked for.
[[nodiscard]] Result<GlWindow> open_gl_window(int width, int height, const std::string& title,
                                              std::optional<render::RenderQuality> quality);

}  // namespace mjarm::view
