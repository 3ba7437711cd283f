#include "mjarm/core/os_system.hpp"

#include <algorithm>
#include <cctype>

namespace mjarm {

bool is_wsl_release(std::string release) {
  std::ranges::transform(release, release.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return release.find("microsoft") != std::string::npos;
}

}  // namespace mjarm
