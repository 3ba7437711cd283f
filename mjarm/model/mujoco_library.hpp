#pragma once

#include <filesystem>
#include <string>

namespace mjarm {

/// The MuJoCo library this program runs with.
struct MujocoLibrary {
  std::string version;         ///< as the library says, e.g. "4.0.1"
  std::string built_against;   ///< as the headers said when mjarm was built
  std::filesystem::path file;  ///< where it was loaded from; empty where unknown

  /// Whether mjarm can run with it: one of 4.0.0 and 4.0.1 serves for the other.
  [[nodiscard]] bool fits() const;
};
[[nodiscard]] MujocoLibrary mujoco_library();

}  // namespace mjarm
