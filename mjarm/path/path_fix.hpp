#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/path/path_change.hpp"
#include "mjarm/path/solve_curve.hpp"
#include "mjarm/path/solve_path.hpp"

namespace mjarm {

/// What mends a path.
enum class FixKind {
  start,     ///< another answer to the first pose
  shift,     ///< the whole path elsewhere
  tilt,      ///< the tool turned, all along
  max_step,  ///< a longer joint step allowed
  slower,    ///< a lower speed of the tool
};

/// The word used in files: "start", "shift", "tilt", "max_step", "slower".
[[nodiscard]] std::string_view name(FixKind kind) noexcept;

/// A change with which the path was solved from end to end.
struct PathFix {
  FixKind kind = FixKind::shift;
  PathChange change = {};  ///< shift, tilt
  JointVec start = {};     ///< [rad or m] start
  double max_step = 0;     ///< [rad or m] max_step
  double tool_speed = 0;   ///< [m/s] slower
};

/// One line for people.
[[nodiscard]] std::string describe(const PathFix& fix);

/// Changes that mend a path, at most one of each kind and `max` in all, what suits the cause
/// first, the least change of each kind. Each was verified by solving the changed path. Shifts are
/// multiples of 0.05 m along the world's axes up to 0.6 m, tilts multiples of 5 degrees about one
/// axis of the tool up to 60 (about z up to 180). Bounded tries; empty where none was found, or
/// where PathOptions::stop ended the work.
[[nodiscard]] std::vector<PathFix> find_fixes(const IkSolver& ik, std::span<const Pose> poses,
                                              std::span<const double> q_start,
                                              const PathOptions& options,
                                              const PathFailure& failure, std::size_t max = 3);
/// The same for a curve.
[[nodiscard]] std::vector<PathFix> find_fixes(const IkSolver& ik, const Curve& curve,
                                              std::span<const double> q_start,
                                              const CurveOptions& options,
                                              const PathFailure& failure, std::size_t max = 3);

/// The shift alone, zero where the path needs none.
/// @param reach  [m] longest shift tried, >= 0 (at most 1 is used).
/// @return impossible where none was found within `reach` and a bounded number of tries.
[[nodiscard]] Result<Eigen::Vector3d> find_shift(const IkSolver& ik, std::span<const Pose> poses,
                                                 std::span<const double> q_seed,
                                                 const PathOptions& options = {},
                                                 double reach = 0.4);

}  // namespace mjarm
