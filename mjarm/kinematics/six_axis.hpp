#pragma once

#include <Eigen/Core>
#include <optional>

#include "mjarm/core/pose.hpp"
#include "mjarm/kinematics/chain.hpp"

namespace mjarm {

namespace detail {

struct BranchQuery;
struct Branches;
struct ClosedForm;

/// The first joint turns until a point lies at a given height along the axis of the second.
struct ShoulderStep {
  Eigen::Matrix3d
      R_SB;             ///< frame B (z along axis 1) in S (z along axis 2, fixed to link 1), q1 = 0
  double tilt_sin = 1;  ///< of the angle between the axes 1 and 2, > 0
  double tilt_cos = 0;
  double height = 0;  ///< [m] of the point along axis 2, seen from axis 1
};

/// Two parallel joints move the end of a two-link arm in the plane z = 0 of S.
struct ElbowStep {
  Eigen::Vector2d p_shoulder;  ///< [m] axis of the first of them, in S
  double upper = 0;            ///< [m] length of the link between them, > 0
  double lower = 0;            ///< [m] length of the link after them, > 0
  double upper_angle = 0;      ///< [rad] direction of both links in S at q = 0
  double lower_angle = 0;
};

/// Three axes z, h5, h6 turn a frame: E = rot(z, a) rot(h5, q5) rot(h6, q6).
/// With q5 = phase + t, z . rot(h5, q5) h6 = constant + size cos(t).
struct WristStep {
  double constant = 0;
  double size = 1;        ///< > 0
  double excess = 0;      ///< size^2 - constant^2 - 1: 0 where h5 is across both others
  double phase = 0;       ///< [rad]
  Eigen::Vector3d h5;     ///< unit, in a frame F whose z is the first of the axes
  Eigen::Vector3d h6;     ///< unit, turned by `phase` about h5; likewise the next two
  Eigen::Vector3d side;   ///< unit, across h6
  Eigen::Vector3d side2;  ///< h6 x side
};

}  // namespace detail

/// Closed form of an arm of six hinges, recognised by its geometry:
///
/// - parallel: the axes 2, 3 and 4 are parallel and the axes 5 and 6 meet (UR, JAKA, Z1), or
/// - spherical: the axes 4, 5 and 6 meet in one point and 2 and 3 are parallel (most industrial
///   arms).
///
/// Up to eight branches: shoulder, elbow and wrist, two ways each. The steps are the canonical
/// subproblems of B. Paden (thesis, Berkeley 1986) and W. Kahan, in the order of A. J. Elias and
/// J. T. Wen (Mechanism and Machine Theory 209 (2025) 105992, "IK-Geo"); sines and cosines are
/// found by algebra, angles only at the end.
class SixAxis {
 public:
  /// The form of `chain`; none for another geometry. Axes may be off by 0.02 rad and 0.01 m
  /// (calibrated arms): then the branches are starts for Newton's steps, see defect().
  static std::optional<SixAxis> recognise(const Chain& chain);

  /// How far the axes are from those of the form [rad and m].
  [[nodiscard]] double defect() const noexcept { return defect_; }
  /// True where the defect is so small that it moves branches by less than 1e-3 rad even where two
  /// of them meet: none is lost. The rounded figures of a file (1.5708) are not enough.
  [[nodiscard]] bool is_exact() const noexcept { return defect_ <= 1e-8; }
  /// True: parallel. False: spherical.
  [[nodiscard]] bool is_parallel() const noexcept { return parallel_; }

 private:
  friend struct detail::ClosedForm;

  /// Appends the branches that reach the pose, limits left aside. A missing one is told in
  /// `out.why` by how much it misses. Of answers that form a continuous family (a joint is free) it
  /// gives samples, and is not complete. Never allocates.
  void branches(const detail::BranchQuery& query, detail::Branches& out) const noexcept;

  SixAxis() = default;
  class Walk;

  bool parallel_ = true;
  double defect_ = 0;
  double slack_ = 0;        // [m] what the defect can make of a pose
  double sign_[6];          // -1 where an axis runs against that of the form
  Pose X_BW_;               // base frame B: origin on axis 1, z along it
  Eigen::Vector3d p_TC_;    // [m] where the last axes meet, fixed in the tool
  Eigen::Vector3d h6_T_;    // axis 6 in the tool
  Eigen::Vector3d side_T_;  // across it
  Eigen::Matrix3d R_FS_;    // from S, turned by the joints 2 and 3, to the frame F of the wrist
  Eigen::Vector2d p_4C_;    // [m] parallel: from axis 4 to C in S at q = 0
  detail::ShoulderStep shoulder_;
  detail::ElbowStep elbow_;
  detail::WristStep wrist_;
};

}  // namespace mjarm
