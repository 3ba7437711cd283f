#pragma once

#include "mjarm/core/result.hpp"
#include "mjarm/trajectory/inverse_dynamics.hpp"
#include "mjarm/trajectory/limits_internal.hpp"
#include "mjarm/trajectory/spline_internal.hpp"

namespace mjarm::detail {

/// What torques are made of at one place of a path: by_a s'' + by_u s'^2 + viscous s' + dry +
/// still, where s' > 0; all of shape (dof,).
struct TorqueTerms {
  JointVec by_a;
  JointVec by_u;
  JointVec viscous;
  JointVec dry;    ///< friction against motion along the path, however slow
  JointVec still;  ///< gravity and springs
};

/// The terms at `p`, by five evaluations (J. Bobrow et al., Int. J. Robotics Research 4 (1985) 3).
[[nodiscard]] TorqueTerms torque_terms(const InverseDynamics& dynamics, const SplinePoint& p);

/// An error that names the joint where `torque`, all it takes not to fall or to creep on, leaves
/// nothing of the limit to move with.
/// @param share  [0, 1] of the path's length, for the text.
[[nodiscard]] Result<void> check_still(const JointVec& torque, const JointVec& limit, double share);

/// By which factor (>= 1) the time has to be stretched so that torques keep their limit at samples
/// of every piece; an error where no factor is enough.
[[nodiscard]] Result<double> stretch_for_torque(const Trajectory& motion, const Bounds& bounds);

}  // namespace mjarm::detail
