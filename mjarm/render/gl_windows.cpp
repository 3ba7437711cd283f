#include <utility>

#include "mjarm/core/messages/render.hpp"
#include "mjarm/core/os_gl.hpp"
#include "mjarm/render/gl_context_internal.hpp"

namespace mjarm::render {
namespace {

class WglContext : public GlContext::Impl {
 public:
  explicit WglContext(HiddenGl gl) : gl_(std::move(gl)) {}
  Result<void> make_current() override { return gl_.make_current(); }
  void release() noexcept override { gl_.release(); }
  void* function(const char* name) override { return gl_.function(name); }
  void publish() override {}  // MuJoCo asks Windows itself

 private:
  HiddenGl gl_;
};

}  // namespace

std::vector<GlKind> gl_kinds() { return {GlKind::egl}; }

const char* name_of(GlKind kind) { return kind == GlKind::egl ? "WGL" : "OSMesa"; }

Result<std::unique_ptr<GlContext::Impl>> make_egl_context() {
  Result<HiddenGl> gl = HiddenGl::create();
  if (!gl) return fail(std::move(gl.error()));
  return std::make_unique<WglContext>(std::move(*gl));
}

Result<std::unique_ptr<GlContext::Impl>> make_osmesa_context() {
  return fail(Errc::not_available, text(msg::render_no_osmesa_here));
}

std::string gl_advice(GlKind, const std::string& reason) { return reason; }

}  // namespace mjarm::render
