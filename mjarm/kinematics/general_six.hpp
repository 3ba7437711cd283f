#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "mjarm/kinematics/chain.hpp"

namespace mjarm {
namespace detail {
struct BranchQuery;
struct Branches;
struct ClosedForm;

/// Equations that are linear in the flag of axis 1 seen from the last link (general_six_form.cpp):
/// six without the joints 1 to 3, then four that give cos and sin of the joints 2 and 3.
struct GeneralRows {
  static constexpr int kCount = 10;
  static constexpr int kFlag = 15;  ///< size of a flag
  static constexpr int kSize = 96;  ///< kCount * 9, padded
  /// What a unit of each part of the flag adds to equation r, at the factors k4 and k5 of 1, cos,
  /// sin of the joints 4 and 5: entry 9 r + 3 k4 + k5.
  double part[kFlag][kSize] = {};
};

/// What GeneralSix reads of an arm, or of the same arm seen from its tool.
struct GeneralGeometry {
  static constexpr int kMostLacking = 3;

  explicit GeneralGeometry(const Chain& of) : chain(of) {}

  Chain chain;
  double length = 1;  ///< [m] unit of the lengths in the equations
  /// The rank that the matrix of the equations lacks at every pose; 0 without special angles.
  int lacking = 0;
  /// Places of the matrix's columns, those that are lacking last; two orders, as near some poses
  /// the columns before them are dependent, too.
  int column[2][12] = {};
  /// The arm's; where rank is lacking, also how they change while the arm becomes another one.
  std::vector<GeneralRows> rows;
};

}  // namespace detail

/// All branches of an arm of six hinges, whatever its geometry: up to 16.
///
/// Five joints alone can close the chain at a few values of joint 4 only. The equations are the 14
/// of M. Raghavan and B. Roth ("Inverse kinematics of the general 6R manipulator and related
/// linkages", ASME J. Mech. Des. 115 (1993) 502), where the arm lies between the two frames of the
/// pose, so that joints 1 to 3 are eliminated once for the arm: six equations in joints 4 to 6 are
/// left. As polynomials of joints 5 and 6 they make a 12 x 12 matrix (D. Manocha and J. F. Canny,
/// IEEE Trans. Robot. Autom. 10 (1994) 648), singular at every answer. Its determinant is a
/// trigonometric series of degree 8 in q4 itself, which 24 values determine; its roots are isolated
/// on the circle (trig_series_internal.hpp), the other joints follow from the null space, and
/// Newton's steps make them exact. Where the determinant is 0 at every pose (parallel or square
/// axes next to each other: most arms that are built), its first term that is not takes its place,
/// with respect to a small change of the arm: the answers are among its roots as well.
class GeneralSix {
 public:
  /// The form of `chain`; none for slides, another number of joints, or where neither seen from the
  /// base nor from the tool the equations tell the answers apart (all axes parallel, and the like).
  static std::optional<GeneralSix> recognise(const Chain& chain);

 private:
  friend struct detail::ClosedForm;

  explicit GeneralSix(detail::GeneralGeometry geometry, bool reversed)
      : geometry_(std::move(geometry)), reversed_(reversed) {}

  /// Appends the branches that reach the pose, limits left aside. `out.complete` is false where
  /// three or more have nearly the same value of joint 4, so that one may be missing. Of answers
  /// that form a continuous family (a joint is free) it finds few or none. Never allocates.
  void branches(const detail::BranchQuery& query, detail::Branches& out) const noexcept;

  detail::GeneralGeometry geometry_;
  bool reversed_;  // seen from the tool: joint values are in reverse and negative
};

}  // namespace mjarm
