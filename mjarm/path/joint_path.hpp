#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/kinematics/ik.hpp"

namespace mjarm {

/// Joint waypoints with the parameter at which each is met: that of the tool's curve (arc length
/// [m]) for Cartesian paths, joint-space length [rad] for joint moves; ascending.
struct JointPath {
  std::vector<double> s;
  std::vector<JointVec> q;
  /// Largest |q[i+1] - q[i]| of any joint [rad or m]; 0 for fewer than two waypoints.
  [[nodiscard]] double max_step() const;
};

/// How joint values are chosen along a sequence of poses.
struct PathOptions {
  double max_step = 0.5;   ///< [rad or m] largest joint step between neighbours, > 0
  int start_branches = 8;  ///< answers for the first pose tried when the nearest one fails, >= 1
};

/// Why a path has no answer, and what was had before that.
struct PathFailure {
  IkErrc code = IkErrc::no_convergence;  ///< reason at the first bad pose
  bool flip = false;    ///< that pose has an answer, but only with a joint step over max_step
  std::size_t at = 0;   ///< index of the first pose that cannot be had
  double fraction = 0;  ///< share of the poses before it, 0 to 1
  IkFailure ik;         ///< details at that pose
  JointPath partial;    ///< answers before it; never to be executed unasked
};

/// IK along `poses`, each seeded by the answer before. The answer nearest to `q_start` is tried
/// first for pose 0; where it does not lead to the end, the other ones, and of those that do the
/// one of the smallest largest step is taken.
/// @param s        parameter of each pose, ascending, as many as poses (at least 1).
/// @param q_start  [rad or m] shape (dof,); where the arm is before.
/// @return the failure of the branch that gets farthest; bad_input where the sizes do not fit.
[[nodiscard]] Result<JointPath, PathFailure> solve_path(const IkSolver& ik,
                                                        std::span<const Pose> poses,
                                                        std::span<const double> s,
                                                        std::span<const double> q_start,
                                                        const PathOptions& options = {});

/// A run of neighbouring poses that cannot be reached, with the worst reason.
struct UnreachableRange {
  std::size_t first = 0;
  std::size_t last = 0;  ///< inclusive
  IkFailure worst;       ///< of the largest `amount`
};
/// Which poses have no answer at all, as index ranges; empty when all are reachable.
[[nodiscard]] std::vector<UnreachableRange> unreachable_ranges(const IkSolver& ik,
                                                               std::span<const Pose> poses,
                                                               std::span<const double> q_seed);

/// A shift of the whole path [m, world] that makes every pose reachable without a joint step over
/// max_step, verified by solving it. Shifts are multiples of 0.05 m along the world's axes, so that
/// people can read them; the shortest is taken, of equal ones that along the fewest axes. Zero
/// where the path needs none.
/// @param reach  [m] longest shift tried, >= 0 (at most 1 is used).
/// @return impossible where none was found within `reach` and a bounded number of tries.
[[nodiscard]] Result<Eigen::Vector3d> find_shift(const IkSolver& ik, std::span<const Pose> poses,
                                                 std::span<const double> q_seed,
                                                 const PathOptions& options = {},
                                                 double reach = 0.4);

/// `n` joint waypoints from `q0` to `q1`, linear, both ends included exactly.
/// @return an error for n < 2, sizes that differ or numbers that are not finite.
[[nodiscard]] Result<JointPath> joint_line(std::span<const double> q0, std::span<const double> q1,
                                           int n);

}  // namespace mjarm
