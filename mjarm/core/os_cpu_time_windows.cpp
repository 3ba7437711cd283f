#include <windows.h>

#include "mjarm/core/os_cpu_time.hpp"

namespace mjarm {

/// Windows does not add up what children that have ended have used.
double cpu_seconds() noexcept {
  FILETIME created, ended, kernel, user;
  if (GetProcessTimes(GetCurrentProcess(), &created, &ended, &kernel, &user) == FALSE) return 0;
  const auto seconds = [](const FILETIME& time) {
    return 1e-7 * (4294967296.0 * time.dwHighDateTime + time.dwLowDateTime);
  };
  return seconds(kernel) + seconds(user);
}

double busy_seconds() noexcept { return cpu_seconds(); }

}  // namespace mjarm
