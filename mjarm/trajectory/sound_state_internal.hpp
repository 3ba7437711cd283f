#pragma once

#include "mjarm/core/joint_state.hpp"

namespace mjarm {

/// True for a state of `dof` > 0 joints, all of it finite.
[[nodiscard]] inline bool is_sound(const JointState& state, Eigen::Index dof) noexcept {
  return dof > 0 && state.q.size() == dof && state.v.size() == dof && state.a.size() == dof &&
         state.q.allFinite() && state.v.allFinite() && state.a.allFinite();
}

}  // namespace mjarm
