#pragma once

#include "mjarm/core/joint_vec.hpp"

namespace mjarm {

/// Joint values and their first two derivatives at one time; what a trajectory asks for and what a
/// controller is given as reference. All of shape (dof,).
struct JointState {
  JointVec q;  ///< [rad or m]
  JointVec v;  ///< [rad/s or m/s]
  JointVec a;  ///< [rad/s^2 or m/s^2]

  /// Standing still at `q`.
  [[nodiscard]] static JointState at_rest(const JointVec& q) {
    return {q, JointVec::Zero(q.size()), JointVec::Zero(q.size())};
  }
};

}  // namespace mjarm
