#pragma once

#include <string>
#include <type_traits>
#include <vector>

#include "mjarm/core/result.hpp"

namespace mjarm {

/// Takes over MuJoCo's messages for the whole process: nothing is written to MUJOCO_LOG.TXT or to
/// the console by MuJoCo itself. Warnings go to the log, or to the `call_mujoco` they arise in.
/// Model::load calls this first; calling it again does nothing.
void install_mujoco_handler() noexcept;

/// What MuJoCo said during a guarded call.
struct MujocoOutcome {
  bool failed = false;
  std::string error;                  ///< MuJoCo's own English text, empty where nothing failed
  std::vector<std::string> warnings;  ///< in the order of their arrival
};

namespace detail {
MujocoOutcome call_mujoco(void (*work)(void*), void* context);
}  // namespace detail

/// Runs `work()`, which may call MuJoCo; a fatal error in MuJoCo ends `work` and not the process.
/// The error is that of the calling thread alone. On an error `work` is left by a jump: objects
/// made inside it are not destroyed, so it should hold plain values and references only.
template <class Work>
MujocoOutcome call_mujoco(Work&& work) {
  using Plain = std::remove_reference_t<Work>;
  return detail::call_mujoco([](void* context) { (*static_cast<Plain*>(context))(); },
                             const_cast<std::remove_const_t<Plain>*>(&work));
}

}  // namespace mjarm
