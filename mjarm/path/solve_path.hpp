#pragma once

#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/path/clearance.hpp"
#include "mjarm/path/joint_path.hpp"
#include "mjarm/path/path_failure.hpp"

namespace mjarm {

/// [rad or m] A hinge that may turn by more between two poses can arrive both ways round, so
/// nothing follows from the poses for what lies between them.
inline constexpr double kMaxJointStep = std::numbers::pi;
/// Whether PathOptions::max_step may be that.
[[nodiscard]] constexpr bool is_sound_step(double step) {
  return step > 0 && step <= kMaxJointStep;
}

/// How joint values are chosen along a sequence of poses. Every default is usable as is.
struct PathOptions {
  double max_step =
      0.5;  ///< [rad or m] largest joint step between neighbours, > 0, <= kMaxJointStep
  bool keep_start = false;  ///< true: the arm stands at q_start; no other answer to pose 0 will do
                            ///< than the one nearest to it
  /// [1] Tracks no tighter than this count as equally good, and the one that starts nearest to
  /// q_start is taken; 0 to 1. 0: the one with most room, wherever it starts.
  double comfort = 0.5;
  /// True: of tracks that count as equally good the one whose postures are best (posture.hpp) is
  /// taken, and only of equals the one that starts nearest to q_start.
  bool best_posture = false;
  /// [rad] The tool may stand so much aside of the given orientations, >= 0 and < pi/2: lets it
  /// pass a wrist singularity. Where there is room enough without, it does not turn at all; else it
  /// does so little by little along the path.
  double orientation_tol = 0;
  /// [m/s] The tool is to keep this speed, without regard to accelerations (turns on the spot:
  /// [rad/s]), >= 0: no joint may be faster than its limit for it. 0: it may go as slowly as need
  /// be.
  double tool_speed = 0;
  ClearanceCheck clearance = {};  ///< refuses overlap, prefers distance; empty: looks at neither
  StopCheck stop = {};            ///< ends the work with PathErrc::stopped
};

/// Joint values along `poses`, chosen for the whole path at once: all answers to pose 0 (every
/// branch in every winding; samples of a redundant arm) are carried along, each pose's answers
/// joined to those of the pose before by steps of at most `max_step` (and as `tool_speed` allows),
/// and of all tracks that reach the last pose the least tight is taken. Tightness is the worst of
/// the largest joint step (as a share of max_step), the nearness to limits, the smallest singular
/// value and the clearance, in levels of 0.02; of equally tight tracks that which starts nearest to
/// q_start is taken (see best_posture), then the shortest. Answers that `ik.options().valid`
/// refuses are left out. An arm of six axes in closed form misses no track; any other is followed
/// from the answers found for pose 0, a redundant one moving aside within itself where it gets
/// tight, and evenly along the whole path. Same input, same answer.
///
/// Memory: 512 answers a pose at most, kept for 512 poses at a time, so that any number of poses
/// needs under 100 MB besides its own input and output.
/// @param s        parameter of each pose, ascending, as many as poses (at least 1).
/// @param q_start  [rad or m] shape (dof,); where the arm is before.
/// @return why the track that gets farthest stops; bad_input where the sizes do not fit.
[[nodiscard]] Result<JointPath, PathFailure> solve_path(const IkSolver& ik,
                                                        std::span<const Pose> poses,
                                                        std::span<const double> s,
                                                        std::span<const double> q_start,
                                                        const PathOptions& options = {});

/// The same where poses have no parameter but their number: s = 0, 1, 2, ...
[[nodiscard]] Result<JointPath, PathFailure> solve_path(const IkSolver& ik,
                                                        std::span<const Pose> poses,
                                                        std::span<const double> q_start,
                                                        const PathOptions& options = {});

/// A run of neighbouring poses that cannot be reached, with the worst reason.
struct UnreachableRange {
  std::size_t first = 0;
  std::size_t last = 0;  ///< inclusive
  IkFailure worst;       ///< of the largest `amount`
};
/// Which poses have no answer at all, as index ranges; empty when all are reachable.
/// @param stop  ends the work: the ranges are then those of the poses looked at so far.
[[nodiscard]] std::vector<UnreachableRange> unreachable_ranges(const IkSolver& ik,
                                                               std::span<const Pose> poses,
                                                               std::span<const double> q_seed,
                                                               const StopCheck& stop = {});

}  // namespace mjarm
