#pragma once

#include <string>

namespace mjarm {

/// What this process runs on.
struct OperatingSystem {
  std::string name;     ///< `Linux 6.1.0-18-amd64 x86_64`: kernel, its release, machine
  bool is_wsl = false;  ///< the Linux that Windows brings along
};
[[nodiscard]] OperatingSystem operating_system();

/// Whether a kernel with that release is one of WSL.
[[nodiscard]] bool is_wsl_release(std::string release);

}  // namespace mjarm
