#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <utility>
#include <vector>

#include "mjarm/core/messages/render.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/render/gl_context_internal.hpp"

namespace mjarm::render {
namespace {

constexpr const char* kLibrary = "libEGL.so.1";

/// The functions of EGL that are needed, found at run time.
struct Egl {
  PFNEGLGETPROCADDRESSPROC get_proc_address = nullptr;
  PFNEGLGETERRORPROC get_error = nullptr;
  PFNEGLINITIALIZEPROC initialize = nullptr;
  PFNEGLBINDAPIPROC bind_api = nullptr;
  PFNEGLCHOOSECONFIGPROC choose_config = nullptr;
  PFNEGLCREATECONTEXTPROC create_context = nullptr;
  PFNEGLDESTROYCONTEXTPROC destroy_context = nullptr;
  PFNEGLMAKECURRENTPROC make_current = nullptr;
  PFNEGLGETCURRENTCONTEXTPROC current_context = nullptr;
  PFNEGLGETPLATFORMDISPLAYEXTPROC platform_display = nullptr;
  PFNEGLQUERYDEVICESEXTPROC query_devices = nullptr;  ///< null where EGL cannot list devices
};

Result<Egl> open_egl() {
  const Result<void*> library = open_library(kLibrary);
  if (!library) return fail(library.error());
  Egl egl;
  const char* missing = nullptr;
  const auto load = [&](auto& target, const char* symbol) {
    target = reinterpret_cast<std::decay_t<decltype(target)>>(library_symbol(*library, symbol));
    if (target == nullptr && missing == nullptr) missing = symbol;
  };
  load(egl.get_proc_address, "eglGetProcAddress");
  load(egl.get_error, "eglGetError");
  load(egl.initialize, "eglInitialize");
  load(egl.bind_api, "eglBindAPI");
  load(egl.choose_config, "eglChooseConfig");
  load(egl.create_context, "eglCreateContext");
  load(egl.destroy_context, "eglDestroyContext");
  load(egl.make_current, "eglMakeCurrent");
  load(egl.current_context, "eglGetCurrentContext");
  if (missing == nullptr) {
    egl.platform_display = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
        egl.get_proc_address("eglGetPlatformDisplayEXT"));
    egl.query_devices =
        reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(egl.get_proc_address("eglQueryDevicesEXT"));
    if (egl.platform_display == nullptr) missing = "eglGetPlatformDisplayEXT";
  }
  if (missing != nullptr) {
    return fail(Errc::not_available, text(msg::render_missing_function, missing));
  }
  return egl;
}

/// Displays that need no window system: one a device, then Mesa's surfaceless one. A plain
/// eglGetDisplay is no use here, for it asks for a running display server.
std::vector<EGLDisplay> displays(const Egl& egl) {
  std::vector<EGLDisplay> found;
  std::array<EGLDeviceEXT, 16> devices{};
  EGLint count = 0;
  if (egl.query_devices != nullptr) {
    egl.query_devices(static_cast<EGLint>(devices.size()), devices.data(), &count);
  }
  for (EGLint i = 0; i < count; ++i) {
    found.push_back(egl.platform_display(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr));
  }
  found.push_back(egl.platform_display(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr));
  std::erase(found, EGL_NO_DISPLAY);
  return found;
}

class EglContext : public GlContext::Impl {
 public:
  EglContext(const Egl& egl, EGLDisplay display, EGLContext context)
      : egl_(egl), display_(display), context_(context) {
    kind = GlKind::egl;
  }
  // The display stays initialised: other contexts of the process may stand on it.
  ~EglContext() override {
    release();
    egl_.destroy_context(display_, context_);
  }
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  Result<void> make_current() override {
    // The interface that is bound belongs to the thread; OpenGL ES is the default.
    egl_.bind_api(EGL_OPENGL_API);
    if (egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_FALSE) {
      return fail(Errc::not_available,
                  text(msg::render_gl_call_failed, "eglMakeCurrent", egl_.get_error()));
    }
    return {};
  }
  void release() noexcept override {
    if (egl_.current_context() != context_) return;
    egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
  void* function(const char* name) override {
    return reinterpret_cast<void*>(egl_.get_proc_address(name));
  }
  void publish() override { publish_library(kLibrary); }

 private:
  Egl egl_;
  EGLDisplay display_;
  EGLContext context_;
};

Result<std::unique_ptr<GlContext::Impl>> context_on(const Egl& egl, EGLDisplay display) {
  const auto failed = [&egl](const char* call) {
    return fail(Errc::not_available, text(msg::render_gl_call_failed, call, egl.get_error()));
  };
  if (egl.initialize(display, nullptr, nullptr) == EGL_FALSE) return failed("eglInitialize");
  if (egl.bind_api(EGL_OPENGL_API) == EGL_FALSE) return failed("eglBindAPI");
  constexpr std::array<EGLint, 15> kWanted = {EGL_RED_SIZE,
                                              8,
                                              EGL_GREEN_SIZE,
                                              8,
                                              EGL_BLUE_SIZE,
                                              8,
                                              EGL_DEPTH_SIZE,
                                              24,
                                              EGL_SURFACE_TYPE,
                                              EGL_PBUFFER_BIT,
                                              EGL_RENDERABLE_TYPE,
                                              EGL_OPENGL_BIT,
                                              EGL_STENCIL_SIZE,
                                              8,
                                              EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (egl.choose_config(display, kWanted.data(), &config, 1, &count) == EGL_FALSE || count < 1) {
    return fail(Errc::not_available, text(msg::render_egl_no_config));
  }
  EGLContext context = egl.create_context(display, config, EGL_NO_CONTEXT, nullptr);
  if (context == EGL_NO_CONTEXT) return failed("eglCreateContext");
  auto made = std::make_unique<EglContext>(egl, display, context);
  if (Result<void> current = made->make_current(); !current) {
    return fail(std::move(current.error()));
  }
  return made;
}

}  // namespace

Result<std::unique_ptr<GlContext::Impl>> make_egl_context() {
  const Result<Egl> egl = open_egl();
  if (!egl) return fail(egl.error());
  Error reason{Errc::not_available, text(msg::render_egl_no_display)};
  for (EGLDisplay display : displays(*egl)) {
    Result<std::unique_ptr<GlContext::Impl>> context = context_on(*egl, display);
    if (context) return context;
    reason = std::move(context.error());
  }
  return fail(std::move(reason));
}

}  // namespace mjarm::render
