#include "mjarm/model/mujoco_library.hpp"

#include <mujoco/mujoco.h>

#include "mjarm/core/os.hpp"

namespace mjarm {
namespace {

/// "4.0.1" from the number of mjVERSION_HEADER (4000001).
std::string version_text(int number) {
  return std::to_string(number / 1000000) + "." + std::to_string(number / 1000 % 1000) + "." +
         std::to_string(number % 1000);
}

}  // namespace

MujocoLibrary mujoco_library() {
  return {mj_versionString(), version_text(mjVERSION_HEADER),
          library_of(reinterpret_cast<const void*>(&mj_versionString))};
}

}  // namespace mjarm
