#pragma once

#include <span>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/pose.hpp"
#include "mjarm/kinematics/chain.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm {

/// One link: T(t) Rx(tilt) Rz(q + offset), or T(t) Rx(tilt) Rz(offset) Tz(q) for a slide. Every
/// chain can be written so, since the x axis of each joint frame is free to choose.
struct Link {
  double t[3] = {0, 0, 0};  ///< [m]
  double tilt_cos = 1;
  double tilt_sin = 0;
  double offset = 0;  ///< [rad]
  bool slide = false;
};

/// An arm with nothing left to compute but what changes: for inner loops that want the pose or the
/// Jacobian of one configuration after another. A plain value, no heap.
struct LinkChain {
  explicit LinkChain(const Chain& chain);

  int dof = 0;
  Link links[kMaxDof];
  double base_cos = 1;  ///< a turn about z before the first link
  double base_sin = 0;
  bool hinges = true;      ///< no slide among the links
  double tool[12] = {};    ///< X_JT: position, then the columns of the rotation
  bool tool_turns = true;  ///< false: that rotation is none, a turn about z being in the last link
};

/// fk() and fk_jacobian() of an arm, several times as fast: q shape (dof,) [rad or m].
[[nodiscard]] Pose fk(const LinkChain& chain, std::span<const double> q) noexcept;
[[nodiscard]] FkJacobian fk_jacobian(const LinkChain& chain, std::span<const double> q) noexcept;

}  // namespace mjarm
