#include <windows.h>
// After windows.h.
#include <psapi.h>

#include <array>
#include <string>

#include "mjarm/core/os.hpp"
#include "mjarm/core/os_libraries.hpp"
#include "mjarm/core/os_text_internal.hpp"

namespace mjarm {

std::filesystem::path loaded_library(std::string_view stem) {
  std::array<HMODULE, 1024> modules{};
  DWORD bytes = 0;
  if (K32EnumProcessModules(GetCurrentProcess(), modules.data(), sizeof(modules), &bytes) ==
      FALSE) {
    return {};
  }
  const std::size_t count = std::min(modules.size(), bytes / sizeof(HMODULE));
  for (std::size_t i = 0; i < count; ++i) {
    const std::filesystem::path file = library_of(reinterpret_cast<const void*>(modules[i]));
    if (utf8(file.filename().wstring()).starts_with(stem)) return file;
  }
  return {};
}

}  // namespace mjarm
