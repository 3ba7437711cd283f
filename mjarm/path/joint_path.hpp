#pragma once

#include <span>
#include <vector>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/path/curve.hpp"

namespace mjarm {

/// Joint waypoints with the parameter at which each is met: arc length of the tool [m] for Cartesian
/// paths, joint-space length [rad] for joint moves; ascending.
struct JointPath {
  std::vector<double> s;
  std::vector<JointVec> q;
  /// Largest |q[i+1] - q[i]| of any joint [rad or m]; 0 for fewer than two waypoints.
  [[nodiscard]] double max_step() const;
};

/// How joint values are chosen along a sequence of poses.
struct PathOptions {
  double max_step = 0.5;  ///< [rad or m] largest joint step between neighbours, > 0
  int start_branches = 8; ///< arm branches tried for the first pose when the given one fails, >= 1
};

/// Why a path has no answer, and what was had before that.
struct PathFailure {
  IkErrc code = IkErrc::no_convergence;  ///< reason at the first bad pose
  bool flip = false;      ///< every pose has an answer, but only with a joint step over max_step
  std::size_t at = 0;     ///< index of the first pose that cannot be had
  double fraction = 0;    ///< share of the poses before it, 0 to 1
  IkFailure ik;           ///< details at that pose
  JointPath partial;      ///< answers before it; never to be executed unasked
};

/// IK along `poses`, each seeded by the answer before. `s[i]` is the parameter of pose i.
[[nodiscard]] Result<JointPath, PathFailure> solve_path(const IkSolver& ik,
                                                        std::span<const Pose> poses,
                                                        std::span<const double> s,
                                                        std::span<const double> q_start,
                                                        const PathOptions& options = {});

/// A run of neighbouring poses that cannot be reached, with the worst reason.
struct UnreachableRange {
  std::size_t first = 0;
  std::size_t last = 0;  ///< inclusive
  IkFailure worst;
};
/// Which poses have no answer at all, as index ranges; empty when all are reachable.
[[nodiscard]] std::vector<UnreachableRange> unreachable_ranges(const IkSolver& ik,
                                                               std::span<const Pose> poses,
                                                               std::span<const double> q_seed);

/// A shift of the whole path that makes every pose reachable without a step over max_step, verified by
/// solving it; the shortest found on a grid of directions and lengths (at most `reach` [m]).
[[nodiscard]] Result<Eigen::Vector3d> find_shift(const IkSolver& ik, std::span<const Pose> poses,
                                                 std::span<const double> q_seed,
                                                 const PathOptions& options = {},
                                                 double reach = 0.4);

/// `n` joint waypoints from `q0` to `q1`, linear, both ends included (n >= 2).
[[nodiscard]] JointPath joint_line(std::span<const double> q0, std::span<const double> q1, int n);

}  // namespace mjarm
