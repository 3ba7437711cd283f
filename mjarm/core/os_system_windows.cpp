#include <windows.h>

#include "mjarm/core/os_system.hpp"

namespace mjarm {

/// GetVersionEx tells programs what they want to hear; this call does not.
OperatingSystem operating_system() {
  RTL_OSVERSIONINFOW info{};
  info.dwOSVersionInfoSize = sizeof(info);
  using GetVersion = LONG(WINAPI*)(RTL_OSVERSIONINFOW*);
  const auto get_version = reinterpret_cast<GetVersion>(
      reinterpret_cast<void*>(GetProcAddress(GetModuleHandleW(L"ntdll.dll"), "RtlGetVersion")));
  if (get_version == nullptr || get_version(&info) < 0) return {"Windows"};
  return {"Windows " + std::to_string(info.dwMajorVersion) + "." +
          std::to_string(info.dwMinorVersion) + "." + std::to_string(info.dwBuildNumber) +
          " x86_64"};
}

}  // namespace mjarm
