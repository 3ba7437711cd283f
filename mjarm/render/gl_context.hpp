#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mjarm/core/result.hpp"

namespace mjarm::render {

/// The ways to draw without a window.
enum class GlKind {
  egl,     ///< the GPU or Mesa's llvmpipe, without a display; on Windows WGL by a hidden window
  osmesa,  ///< software only; not on Windows
};

/// Which way to take. MuJoCo binds its OpenGL functions once, so the first kind that was used in a
/// process is the only one from then on (a window counts as `egl`).
enum class GlChoice {
  automatic,  ///< the one named by the environment variable MUJOCO_GL (egl, osmesa), else EGL, then
              ///< OSMesa
  egl,        ///< EGL or an error
  osmesa,     ///< OSMesa or an error
};

/// Notes that MuJoCo draws with `kind` from now on; called before it draws for the first time.
/// @return not_available where it already draws with the other kind.
[[nodiscard]] Result<void> claim_gl(GlKind kind);

/// An OpenGL context without a window. While it is current in a thread, no other thread and no
/// window in that thread can draw.
class GlContext {
 public:
  /// Opens the libraries at run time, makes a context and makes it current.
  /// @return not_available with the reason of each attempt and the packages that help.
  [[nodiscard]] static Result<GlContext> create(GlChoice choice = GlChoice::automatic);
  ~GlContext();
  GlContext(GlContext&&) noexcept;
  GlContext& operator=(GlContext&&) noexcept;

  /// Makes it the context of the calling thread.
  [[nodiscard]] Result<void> make_current();
  /// Leaves the calling thread without a context, so that a window may use it.
  void release() noexcept;

  [[nodiscard]] GlKind kind() const noexcept;
  /// GL_RENDERER, e.g. "llvmpipe (LLVM 15.0.6, 256 bits)".
  [[nodiscard]] const std::string& renderer() const noexcept;
  /// GL_VERSION, e.g. "4.5 (Compatibility Profile) Mesa 22.3.6".
  [[nodiscard]] const std::string& version() const noexcept;
  /// True where pictures are computed by the processor (llvmpipe, softpipe, swrast).
  [[nodiscard]] bool is_software() const noexcept;

  struct Impl;  ///< of this room only

 private:
  explicit GlContext(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// One way to draw without a window, tried out.
struct GlBackend {
  GlKind kind = GlKind::egl;
  std::string name = {};  ///< "EGL", "OSMesa" or "WGL"
  bool works = false;
  std::string renderer = {};  ///< GL_RENDERER where it works
  std::string version = {};   ///< GL_VERSION where it works
  std::string reason = {};    ///< why it does not work, and what helps; empty where it works
};

/// Tries every way, in the order of preference; leaves no context current.
[[nodiscard]] std::vector<GlBackend> probe_gl_backends();

}  // namespace mjarm::render
