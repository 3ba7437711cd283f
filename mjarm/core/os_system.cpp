#include "mjarm/core/os_system.hpp"

#include <sys/utsname.h>

#include <algorithm>
#include <cctype>

namespace mjarm {

bool is_wsl_release(std::string release) {
  std::ranges::transform(release, release.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return release.find("microsoft") != std::string::npos;
}

OperatingSystem operating_system() {
  utsname names{};
  if (::uname(&names) != 0) return {"Linux"};
  const std::string release(static_cast<const char*>(names.release));
  return {std::string(static_cast<const char*>(names.sysname)) + " " + release + " " +
              static_cast<const char*>(names.machine),
          is_wsl_release(release)};
}

}  // namespace mjarm
