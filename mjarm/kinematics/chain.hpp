#pragma once

#include <array>
#include <span>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/pose.hpp"
#include "mjarm/model/arm.hpp"

namespace mjarm {

/// An arm reduced to what the inner loops read. Every joint frame is turned so that the joint moves
/// about or along its own z axis: X_PJ(q) = X_PJ * Rz(q) or X_PJ * Tz(q). A plain value, no heap.
struct Chain {
  explicit Chain(const Arm& arm);

  int dof = 0;                          ///< 0 for an arm of no joints or of more than kMaxDof
  std::array<Pose, kMaxDof> X_PJ;       ///< frame J in the moved frame before, at q = 0
  std::array<bool, kMaxDof> slide{};    ///< true for a slide
  std::array<double, kMaxDof> lower{};  ///< [rad or m]
  std::array<double, kMaxDof> upper{};  ///< [rad or m]
  /// True for a hinge that may turn a whole revolution: every angle has a winding within its
  /// limits.
  std::array<bool, kMaxDof> full_turn{};
  Pose X_JT;  ///< tool in the frame of the last joint

  /// Pose X_WT of the tool at `q`, shape (dof,) [rad or m].
  [[nodiscard]] Pose fk(const double* q) const noexcept;
};

/// The winding q + 2 pi k of joint `i` that is nearest to `q_near` and within the limits; `q`
/// itself for a slide or a hinge of less than a revolution.
[[nodiscard]] double nearest_winding(const Chain& chain, int i, double q, double q_near) noexcept;

/// The same for every joint; shapes (dof,) [rad or m].
[[nodiscard]] JointVec unwind(const Chain& chain, const JointVec& q,
                              const JointVec& q_near) noexcept;

}  // namespace mjarm
