#include "mjarm/model/mujoco_library.hpp"

#include <mujoco/mujoco.h>

#include <string_view>

#include "mjarm/core/os.hpp"

namespace mjarm {
namespace {

/// "4.0.1" from the number of mjVERSION_HEADER (4000001).
std::string version_text(int number) {
  return std::to_string(number / 1000000) + "." + std::to_string(number / 1000 % 1000) + "." +
         std::to_string(number % 1000);
}

/// "4.0" of "4.0.1": all that structures and behaviour depend on.
std::string_view series(std::string_view version) { return version.substr(0, version.rfind('.')); }

}  // namespace

bool MujocoLibrary::fits() const { return series(version) == series(built_against); }

MujocoLibrary mujoco_library() {
  return {mj_versionString(), version_text(mjVERSION_HEADER),
          library_of(reinterpret_cast<const void*>(&mj_versionString))};
}

}  // namespace mjarm
