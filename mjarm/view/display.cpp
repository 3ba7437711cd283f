#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <atomic>
#include <string_view>

#include "mjarm/core/messages/view.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/view/display_internal.hpp"

#if defined(__linux__)
/// From GLFW/glfw3native.h, which would bring in all of X11: the X11 display, or null on others.
extern "C" void* glfwGetX11Display(void);
#endif

namespace mjarm::view {
namespace {

constexpr unsigned kGlRenderer = 0x1F01;  // GL_RENDERER
constexpr unsigned kGlVersion = 0x1F02;   // GL_VERSION

std::atomic<bool> lost{false};

std::string last_glfw_error() {
  const char* description = nullptr;
  glfwGetError(&description);
  return description == nullptr ? std::string() : std::string(description);
}

#if !defined(__linux__)
void survive_loss_of_x11() {}
#else
/// Xlib ends the process when its connection breaks, unless it is told what to do instead.
void survive_loss_of_x11() {
  void* display = glfwGetX11Display();
  if (display == nullptr) return;
  using IoHandler = int (*)(void*);
  using ExitHandler = void (*)(void*, void*);
  const Result<void*> library = open_library("libX11.so.6");
  if (!library) return;
  const auto set_handler =
      reinterpret_cast<void* (*)(IoHandler)>(library_symbol(*library, "XSetIOErrorHandler"));
  const auto set_exit_handler = reinterpret_cast<void (*)(void*, ExitHandler, void*)>(
      library_symbol(*library, "XSetIOErrorExitHandler"));  // since libX11 1.7
  if (set_handler == nullptr || set_exit_handler == nullptr) return;
  set_handler([](void*) { return 0; });  // the default prints
  set_exit_handler(display, [](void*, void*) { lost = true; }, nullptr);
}
#endif

/// What OpenGL says about itself in the current context.
std::string gl_string(unsigned name) {
  using GetString = const unsigned char* (*)(unsigned);
  const auto get_string = reinterpret_cast<GetString>(glfwGetProcAddress("glGetString"));
  const unsigned char* value = get_string == nullptr ? nullptr : get_string(name);
  return value == nullptr ? std::string() : std::string(reinterpret_cast<const char*>(value));
}

bool is_software(std::string_view renderer) {
  for (const char* name : {"llvmpipe", "softpipe", "swrast", "Software Rasterizer"}) {
    if (renderer.find(name) != std::string_view::npos) return true;
  }
  return false;
}

Result<GLFWwindow*> create(int width, int height, const std::string& title, bool smooth) {
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_SAMPLES, smooth ? 4 : 0);
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  GLFWwindow* window = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  if (window == nullptr) {
    return fail(Errc::not_available, text(msg::view_no_window, last_glfw_error()));
  }
  glfwMakeContextCurrent(window);
  return window;
}

}  // namespace

Result<void> open_display() {
  if (!has_display()) return fail(Errc::not_available, text(msg::view_no_display));
  if (lost) return fail(Errc::system, text(msg::view_display_lost));
  if (glfwInit() == GLFW_FALSE) {
    return fail(Errc::not_available, text(msg::view_no_window, last_glfw_error()));
  }
  survive_loss_of_x11();
  return {};
}

void close_display() noexcept {
  if (!lost) glfwTerminate();
}

bool display_lost() noexcept { return lost; }

Result<GlWindow> open_gl_window(int width, int height, const std::string& title,
                                std::optional<render::RenderQuality> quality) {
  // A smoothed window takes long to open without a GPU, so it comes second where nobody asked.
  bool smooth = quality == render::RenderQuality::high;
  Result<GLFWwindow*> window = create(width, height, title, smooth);
  if (!window && smooth) window = create(width, height, title, smooth = false);
  if (!window) return fail(std::move(window.error()));
  const bool slow = is_software(gl_string(kGlRenderer));
  const render::RenderQuality chosen =
      quality.value_or(slow ? render::RenderQuality::low : render::RenderQuality::high);
  if (!quality && chosen == render::RenderQuality::high) {
    glfwDestroyWindow(*window);
    window = create(width, height, title, true);
    if (!window) window = create(width, height, title, false);
    if (!window) return fail(std::move(window.error()));
  }
  if (glfwExtensionSupported("GL_ARB_framebuffer_object") == GLFW_FALSE) {
    Error error{Errc::not_available, text(msg::view_old_gl, gl_string(kGlVersion))};
    glfwDestroyWindow(*window);
    return fail(std::move(error));
  }
  return GlWindow{*window, chosen, slow};
}

}  // namespace mjarm::view
