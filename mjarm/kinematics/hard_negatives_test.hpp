#pragma once

#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/kinematics/numeric_search_internal.hpp"

/// Poses near what an arm can reach and yet out of it, and a search that shares nothing with the
/// closed forms but the description of the arm.
namespace mjarm::testing {

/// True where descents from the home position and 200 random starts all end short of the pose.
inline bool nothing_found(const IkSolver& ik, const Pose& X_WT) {
  IkOptions options;
  options.restarts = 200;
  const detail::IkGoal goal{X_WT, ik.arm().home};
  return !detail::search_numeric(ik.chain(), options, ik.length(), goal).has_value();
}

inline Eigen::Vector3d normal_vector(Rng& rng) {
  return {rng.normal(), rng.normal(), rng.normal()};
}

/// `X` moved by about `place` [m] and turned by about `turn` [rad].
inline Pose moved(Pose X, double place, double turn, Rng& rng) {
  X.p += place * normal_vector(rng);
  X.R = rotation_exp(turn * normal_vector(rng)) * X.R;
  return X;
}

}  // namespace mjarm::testing
