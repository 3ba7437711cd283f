#include <sys/utsname.h>

#include "mjarm/core/os_system.hpp"

namespace mjarm {

OperatingSystem operating_system() {
  utsname names{};
  if (::uname(&names) != 0) return {"Linux"};
  const std::string release(static_cast<const char*>(names.release));
  return {std::string(static_cast<const char*>(names.sysname)) + " " + release + " " +
              static_cast<const char*>(names.machine),
          is_wsl_release(release)};
}

}  // namespace mjarm
