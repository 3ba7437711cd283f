#include "mjarm/core/os_file.hpp"

namespace mjarm {

std::FILE* open_file(const std::filesystem::path& path, const char* mode) noexcept {
  return std::fopen(path.c_str(), mode);
}

}  // namespace mjarm
