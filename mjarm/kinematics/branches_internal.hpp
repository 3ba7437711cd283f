#pragma once

#include <limits>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/pose.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/kinematics/reach.hpp"

/// How closed forms (SixAxis, SevenAxis) plug into IkSolver. A closed form is a value class without
/// heap memory, so that IkSolver can hold it by value; what it is asked here is not for users. The
/// front of IkSolver does for both: checking the input, Reach, winding each branch to the seed,
/// limits, FK check and polish by Newton's steps, the order by nearness, the predicate, the typed
/// answer. Without a form, or where a form that is no proof finds nothing, the numeric search runs.
namespace mjarm::detail {

/// What is asked of a closed form.
struct BranchQuery {
  const Pose& X_WT;  ///< orthonormal to rounding
  const double*
      near;        ///< [rad] shape (dof,): the seed, within the limits; free joints stay near it
  double pos_tol;  ///< [m]   a branch missed by no more than this is worth appending
  double rot_tol;  ///< [rad] likewise
  /// False: the form may stop as soon as it has what it takes for the nearest answer. True: every
  /// branch (six axes), or samples of the whole range (seven); asked for by solve_all() and when
  /// the predicate has refused what came first.
  bool all = false;
};

/// Answers of a closed form, in the order they were found. Left uninitialised on purpose: only the
/// first `count` rows are read.
struct Branches {
  static constexpr int kCapacity = 128;
  static constexpr int kMaxJoints = 7;

  int count = 0;
  double q[kCapacity][kMaxJoints];  ///< [rad] any winding; may be beyond the limits (six axes)

  /// True where the form knows that no configuration besides those listed reaches the pose, limits
  /// left aside. False: the numeric search goes on when none of them will do.
  bool complete = false;

  /// Of the branches that do not exist, the one that misses least: why, by how much, and the
  /// configuration that comes nearest.
  IkErrc why = IkErrc::no_convergence;
  ReachShape shape = ReachShape::none;
  double amount = std::numeric_limits<double>::infinity();  ///< [m]
  double bound = 0;                                         ///< [m] radius that is broken
  bool has_best = false;
  double best[kMaxJoints];  ///< [rad]

  /// A row to write to, null where the list is full.
  double* add() noexcept { return count < kCapacity ? q[count++] : nullptr; }
};

/// What users of the closed forms do not see.
struct ClosedForm {
  /// Appends the branches that reach the pose. Never allocates.
  template <class Form>
  static void branches(const Form& form, const BranchQuery& query, Branches& out) noexcept {
    form.branches(query, out);
  }
  template <class Form>
  static const auto& geometry(const Form& form) noexcept {
    return form.geometry_;
  }
};

}  // namespace mjarm::detail
