#include "mjarm/core/os.hpp"

#include <system_error>
#include <thread>

namespace mjarm {

std::filesystem::path temp_directory() {
  std::error_code error;
  std::filesystem::path path = std::filesystem::temp_directory_path(error);
  return error ? std::filesystem::path("/tmp") : path;
}

int core_count() noexcept {
  const unsigned count = std::thread::hardware_concurrency();
  return count == 0 ? 1 : static_cast<int>(count);
}

std::string system_message(int code) { return std::generic_category().message(code); }

}  // namespace mjarm
