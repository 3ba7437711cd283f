#include <windows.h>

#include "mjarm/core/os_gl.hpp"
#include "mjarm/core/os_text_internal.hpp"

namespace mjarm {
namespace {

tl::unexpected<Error> failed(const char* call) {
  return fail(Errc::not_available, std::string(call) + ": " + windows_message(GetLastError()));
}

/// The kind of pixels that pictures are made of; what is seen of the window does not matter.
PIXELFORMATDESCRIPTOR pixels() {
  PIXELFORMATDESCRIPTOR format{};
  format.nSize = sizeof(format);
  format.nVersion = 1;
  format.dwFlags = PFD_DRAW_TO_WINDOW | PFD_SUPPORT_OPENGL | PFD_DOUBLEBUFFER;
  format.iPixelType = PFD_TYPE_RGBA;
  format.cColorBits = 24;
  format.cAlphaBits = 8;
  format.cDepthBits = 24;
  format.cStencilBits = 8;
  return format;
}

}  // namespace

struct HiddenGl::Impl {
  ~Impl() {
    if (context != nullptr) {
      if (wglGetCurrentContext() == context) wglMakeCurrent(nullptr, nullptr);
      wglDeleteContext(context);
    }
    if (device != nullptr) ReleaseDC(window, device);
    if (window != nullptr) DestroyWindow(window);
  }
  HWND window = nullptr;
  HDC device = nullptr;
  HGLRC context = nullptr;
};

Result<HiddenGl> HiddenGl::create() {
  auto impl = std::make_unique<Impl>();
  impl->window = CreateWindowExW(0, L"STATIC", L"mjarm", WS_POPUP, 0, 0, 16, 16, nullptr, nullptr,
                                 GetModuleHandleW(nullptr), nullptr);
  if (impl->window == nullptr) return failed("CreateWindowEx");
  impl->device = GetDC(impl->window);
  const PIXELFORMATDESCRIPTOR wanted = pixels();
  const int format = ChoosePixelFormat(impl->device, &wanted);
  if (format == 0 || SetPixelFormat(impl->device, format, &wanted) == FALSE) {
    return failed("SetPixelFormat");
  }
  impl->context = wglCreateContext(impl->device);
  if (impl->context == nullptr) return failed("wglCreateContext");
  HiddenGl made(std::move(impl));
  if (Result<void> current = made.make_current(); !current) return fail(current.error());
  return made;
}

HiddenGl::HiddenGl(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
HiddenGl::~HiddenGl() = default;
HiddenGl::HiddenGl(HiddenGl&&) noexcept = default;
HiddenGl& HiddenGl::operator=(HiddenGl&&) noexcept = default;

Result<void> HiddenGl::make_current() {
  if (wglMakeCurrent(impl_->device, impl_->context) == FALSE) return failed("wglMakeCurrent");
  return {};
}

void HiddenGl::release() noexcept {
  if (wglGetCurrentContext() == impl_->context) wglMakeCurrent(nullptr, nullptr);
}

/// Those of OpenGL 1.1 are in the library itself, all others only behind wglGetProcAddress.
void* HiddenGl::function(const char* name) const {
  if (auto* found = reinterpret_cast<void*>(wglGetProcAddress(name))) return found;
  return reinterpret_cast<void*>(GetProcAddress(GetModuleHandleW(L"opengl32.dll"), name));
}

}  // namespace mjarm
