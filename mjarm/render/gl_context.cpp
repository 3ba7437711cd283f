#include "mjarm/render/gl_context.hpp"

#include <atomic>
#include <cstdlib>
#include <optional>
#include <utility>

#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/render.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/render/gl_context_internal.hpp"

namespace mjarm::render {
namespace {

constexpr unsigned kGlRenderer = 0x1F01;    // GL_RENDERER
constexpr unsigned kGlVersion = 0x1F02;     // GL_VERSION
constexpr unsigned kGlExtensions = 0x1F03;  // GL_EXTENSIONS

constexpr int kNone = -1;
std::atomic<int> claimed_kind{kNone};
std::atomic<long> drawing_process{0};  // its number; in a copy of it (fork) drivers wait for ever

std::optional<GlKind> claimed() {
  const int kind = claimed_kind.load();
  if (kind == kNone) return std::nullopt;
  return static_cast<GlKind>(kind);
}

/// Makes a context and reads what it says about itself.
Result<std::unique_ptr<GlContext::Impl>> attempt(GlKind kind) {
  Result<std::unique_ptr<GlContext::Impl>> made =
      kind == GlKind::egl ? make_egl_context() : make_osmesa_context();
  if (!made) return made;
  GlContext::Impl& context = **made;
  using GetString = const unsigned char* (*)(unsigned);
  const auto get_string = reinterpret_cast<GetString>(context.function("glGetString"));
  if (get_string == nullptr) {
    return fail(Errc::not_available, text(msg::render_missing_function, "glGetString"));
  }
  const auto read = [get_string](unsigned name) {
    const unsigned char* value = get_string(name);
    return value == nullptr ? std::string() : std::string(reinterpret_cast<const char*>(value));
  };
  context.renderer = read(kGlRenderer);
  context.version = read(kGlVersion);
  // MuJoCo would end the process without them.
  if (read(kGlExtensions).find("GL_ARB_framebuffer_object") == std::string::npos) {
    return fail(Errc::not_available, text(msg::render_gl_too_old, context.version));
  }
  return made;
}

/// The kinds to try, in order.
std::vector<GlKind> wanted_kinds(GlChoice choice) {
  if (choice == GlChoice::egl) return {GlKind::egl};
  if (choice == GlChoice::osmesa) return {GlKind::osmesa};
  if (const std::optional<GlKind> kind = claimed()) return {*kind};
  if (environment("MUJOCO_GL") == "osmesa") return {GlKind::osmesa};
  if (environment("MUJOCO_GL") == "egl") return {GlKind::egl};
  return gl_kinds();
}

}  // namespace

Result<void> claim_gl(GlKind kind) {
  int expected = kNone;
  if (claimed_kind.compare_exchange_strong(expected, static_cast<int>(kind))) return {};
  if (expected == static_cast<int>(kind)) return {};
  return fail(Errc::not_available, text(msg::render_gl_other_kind,
                                        name_of(static_cast<GlKind>(expected)), name_of(kind)));
}

Result<GlContext> GlContext::create(GlChoice choice) {
  const long process = process_id(), drawing = drawing_process.load();
  if (drawing != 0 && drawing != process) {
    return fail(Errc::not_available, text(msg::render_gl_forked, drawing));
  }
  const std::vector<GlKind> kinds = wanted_kinds(choice);
  std::vector<std::string> reasons;
  for (const GlKind kind : kinds) {
    Result<std::unique_ptr<Impl>> context = attempt(kind);
    if (!context) {
      reasons.push_back(gl_advice(kind, context.error().what));
      continue;
    }
    if (Result<void> claim = claim_gl(kind); !claim) return fail(std::move(claim.error()));
    drawing_process = process;
    (*context)->publish();
    return GlContext(std::move(*context));
  }
  if (kinds.size() == 2) {
    return fail(Errc::not_available, text(msg::render_no_gl, reasons[0], reasons[1]));
  }
  return fail(Errc::not_available, text(msg::core_at_place, name_of(kinds[0]), reasons[0]));
}

GlContext::GlContext(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
GlContext::~GlContext() = default;
GlContext::GlContext(GlContext&&) noexcept = default;
GlContext& GlContext::operator=(GlContext&&) noexcept = default;

Result<void> GlContext::make_current() { return impl_->make_current(); }
void GlContext::release() noexcept { impl_->release(); }
GlKind GlContext::kind() const noexcept { return impl_->kind; }
const std::string& GlContext::renderer() const noexcept { return impl_->renderer; }
const std::string& GlContext::version() const noexcept { return impl_->version; }

bool GlContext::is_software() const noexcept {
  for (const char* name : {"llvmpipe", "softpipe", "swrast", "Software Rasterizer"}) {
    if (impl_->renderer.find(name) != std::string::npos) return true;
  }
  return impl_->kind == GlKind::osmesa;
}

std::vector<GlBackend> probe_gl_backends() {
  std::vector<GlBackend> found;
  for (const GlKind kind : gl_kinds()) {
    GlBackend backend{.kind = kind, .name = name_of(kind)};
    const Result<std::unique_ptr<GlContext::Impl>> context = attempt(kind);
    backend.works = context.has_value();
    if (context) {
      backend.renderer = (*context)->renderer;
      backend.version = (*context)->version;
    } else {
      backend.reason = gl_advice(kind, context.error().what);
    }
    found.push_back(std::move(backend));
  }
  return found;
}

}  // namespace mjarm::render
