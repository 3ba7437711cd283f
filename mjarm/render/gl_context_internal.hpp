#pragma once

#include <memory>
#include <string>

#include "mjarm/render/gl_context.hpp"

namespace mjarm::render {

/// A context of one kind.
struct GlContext::Impl {
  virtual ~Impl() = default;
  [[nodiscard]] virtual Result<void> make_current() = 0;
  virtual void release() noexcept = 0;
  /// Address of an OpenGL function, or null.
  [[nodiscard]] virtual void* function(const char* name) = 0;
  /// Lets MuJoCo find the library when it looks for OpenGL.
  virtual void publish() = 0;

  GlKind kind = GlKind::egl;
  std::string renderer;
  std::string version;
};

/// A context that is current, its strings not yet read; the error says why, without advice.
[[nodiscard]] Result<std::unique_ptr<GlContext::Impl>> make_egl_context();
[[nodiscard]] Result<std::unique_ptr<GlContext::Impl>> make_osmesa_context();

/// What this system has, in order of preference.
[[nodiscard]] std::vector<GlKind> gl_kinds();
/// What its users call it: EGL, OSMesa, WGL.
[[nodiscard]] const char* name_of(GlKind kind);
/// Why a kind does not work, and what helps.
[[nodiscard]] std::string gl_advice(GlKind kind, const std::string& reason);

}  // namespace mjarm::render
