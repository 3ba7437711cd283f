#include "mjarm/core/messages/render.hpp"
#include "mjarm/render/gl_context_internal.hpp"

namespace mjarm::render {

std::vector<GlKind> gl_kinds() { return {GlKind::egl, GlKind::osmesa}; }

const char* name_of(GlKind kind) { return kind == GlKind::egl ? "EGL" : "OSMesa"; }

std::string gl_advice(GlKind kind, const std::string& reason) {
  return text(kind == GlKind::egl ? msg::render_no_egl : msg::render_no_osmesa, reason);
}

}  // namespace mjarm::render
