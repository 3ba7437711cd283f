#include "apps/mjarm/cli/version.hpp"

#include "mjarm/core/cpu.hpp"
#include "mjarm/model/mujoco_library.hpp"

namespace mjarm::app {

std::string compiler() {
#if defined(__clang__)
  return "clang " __clang_version__;
#else
  return "g++ " __VERSION__;
#endif
}

std::string version_line() {
  return "mjarm " MJARM_VERSION " (MuJoCo " + mujoco_library().version + ", " + compiler() + ", " +
         std::string(name(simd_level())) + ")";
}

}  // namespace mjarm::app
