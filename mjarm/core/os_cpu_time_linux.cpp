#include <sys/resource.h>

#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <system_error>

#include "mjarm/core/os_cpu_time.hpp"

namespace mjarm {

double cpu_seconds() noexcept {
  double sum = 0;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage used{};
    if (::getrusage(who, &used) != 0) continue;
    for (const timeval& time : {used.ru_utime, used.ru_stime}) {
      sum += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    }
  }
  return sum;
}

double busy_seconds() noexcept {
  double sum = cpu_seconds();
  try {
    std::error_code code;
    for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task", code)) {
      double running = 0, ready = 0;  // [ns]
      if (std::ifstream(thread.path() / "schedstat") >> running >> ready) sum += 1e-9 * ready;
    }
  } catch (...) {  // no memory, or the list of threads cannot be read to its end
  }
  return sum;
}

}  // namespace mjarm
