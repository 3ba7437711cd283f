#include <array>
#include <cstdint>

#include "mjarm/core/messages/render.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/render/gl_context_internal.hpp"

namespace mjarm::render {
namespace {

// From GL/osmesa.h, which need not be installed.
constexpr unsigned kRgba = 0x1908;          // OSMESA_RGBA
constexpr unsigned kUnsignedByte = 0x1401;  // GL_UNSIGNED_BYTE
using Handle = struct OsmesaContext*;
using CreateContextExt = Handle (*)(unsigned, int, int, int, Handle);
using MakeCurrent = unsigned char (*)(Handle, void*, unsigned, int, int);
using DestroyContext = void (*)(Handle);
using GetProcAddress = void* (*)(const char*);

constexpr const char* kOsmesaLibrary = "libOSMesa.so.8";

/// The functions of OSMesa that are needed, found at run time.
struct Library {
  CreateContextExt create = nullptr;
  MakeCurrent make_current = nullptr;
  DestroyContext destroy = nullptr;
  GetProcAddress function = nullptr;
};

Result<Library> open_osmesa() {
  const Result<void*> handle = open_library(kOsmesaLibrary);
  if (!handle) return fail(handle.error());
  Library library;
  const char* missing = nullptr;
  const auto load = [&](auto& target, const char* symbol) {
    target = reinterpret_cast<std::decay_t<decltype(target)>>(library_symbol(*handle, symbol));
    if (target == nullptr) missing = symbol;
  };
  load(library.create, "OSMesaCreateContextExt");
  load(library.make_current, "OSMesaMakeCurrent");
  load(library.destroy, "OSMesaDestroyContext");
  load(library.function, "OSMesaGetProcAddress");
  if (missing != nullptr) {
    return fail(Errc::not_available, text(msg::render_missing_function, missing));
  }
  return library;
}

class Osmesa : public GlContext::Impl {
 public:
  explicit Osmesa(const Library& library) : library_(library) {
    kind = GlKind::osmesa;
    context_ = library_.create(kRgba, 24, 8, 0, nullptr);
  }
  ~Osmesa() override {
    if (context_ == nullptr) return;
    release();
    library_.destroy(context_);
  }
  Osmesa(const Osmesa&) = delete;
  Osmesa& operator=(const Osmesa&) = delete;

  [[nodiscard]] bool created() const { return context_ != nullptr; }
  Result<void> make_current() override {
    // Pictures are drawn into a framebuffer object; the default one only has to exist.
    if (library_.make_current(context_, pixels_.data(), kUnsignedByte, kSize, kSize) == 0) {
      return fail(Errc::not_available, text(msg::render_gl_call_failed, "OSMesaMakeCurrent", 0));
    }
    return {};
  }
  void release() noexcept override { library_.make_current(nullptr, nullptr, kUnsignedByte, 0, 0); }
  void* function(const char* name) override { return library_.function(name); }
  void publish() override { publish_library(kOsmesaLibrary); }

 private:
  static constexpr int kSize = 16;
  Library library_;
  Handle context_ = nullptr;
  std::array<std::uint8_t, 4 * kSize * kSize> pixels_{};
};

}  // namespace

Result<std::unique_ptr<GlContext::Impl>> make_osmesa_context() {
  Result<Library> library = open_osmesa();
  if (!library) return fail(std::move(library.error()));
  auto context = std::make_unique<Osmesa>(*library);
  if (!context->created()) {
    return fail(Errc::not_available, text(msg::render_gl_call_failed, "OSMesaCreateContextExt", 0));
  }
  if (Result<void> current = context->make_current(); !current) {
    return fail(std::move(current.error()));
  }
  return context;
}

}  // namespace mjarm::render
