#pragma once

#include <optional>

#include "mjarm/kinematics/chain.hpp"

namespace mjarm {
namespace detail {
struct BranchQuery;
struct Branches;
struct ClosedForm;

/// What the closed form of seven axes reads of an arm. Matrices by columns. Frame k is the moved
/// frame of joint k + 1, ku the same before its motion; S is the shoulder, W the wrist.
struct SevenGeometry {
  Pose X_T6;        ///< frame 6 in the tool
  double p_6uW[3];  ///< W seen from the last joint [m]
  double R_56[9];   ///< rotations between neighbours at 0
  double R_45[9];
  double R_34[9];
  double R_23[9];
  double R_12[9];
  double R_01[9];
  double R_W0[9];
  double p_WS[3];    ///< [m]
  double p_3uS[3];   ///< S seen from the elbow before it bends [m]
  double p_3W[3];    ///< W seen from the elbow after it has bent [m]
  double middle[7];  ///< [rad] of each joint's limits; 0 for a full turn
  double middle_cos[7], middle_sin[7];
  double half_cos[7];  ///< of half their width; -2 for a joint of a full turn
};

}  // namespace detail

/// Closed form for arms of seven hinges whose axes 1 to 3 meet in a shoulder S and whose axes 5 and
/// 6 meet in a wrist W, with any offsets at the elbow and before the last joint: Franka's arms,
/// xArm 7, KUKA's iiwa. The last joint is the parameter: at each of its values the pose of link 6
/// is known, the distance SW gives joint 4, the direction of S from link 6 gives joints 6 and 5 and
/// the rotation left over gives joints 1 to 3, with two answers each, eight in all. The idea is
/// that of Y. He and S. Liu, "Analytical inverse kinematics for Franka Emika Panda: a geometrical
/// solver for 7-DOF manipulators with unconventional design" (ICCMA 2021); the equations are
/// rotations about intersecting axes (B. Paden and W. Kahan) for any twists between the axes.
class SevenAxis {
 public:
  /// The form of `chain`, none where its axes do not meet so.
  static std::optional<SevenAxis> recognise(const Chain& chain);

 private:
  friend struct detail::ClosedForm;

  /// Appends answers within the limits, searched over the whole range of the last joint: the one
  /// nearest to the seed first, and all that the sampling met where `query.all` is set. Where none
  /// is within the limits, the sample of a whole turn of the last joint that breaks them least, by
  /// the cosine of the angle beyond. Never allocates.
  void branches(const detail::BranchQuery& query, detail::Branches& out) const noexcept;

  detail::SevenGeometry geometry_;
  Chain chain_;

  explicit SevenAxis(const Chain& chain) : chain_(chain) {}
  bool set_geometry();
};

}  // namespace mjarm
