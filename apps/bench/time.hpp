#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "apps/bench/suite.hpp"
#include "mjarm/core/joint_state.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/trajectory/time_cases.hpp"

namespace mjarm::app {

/// Motions of one kind to be timed.
struct TimeSet {
  std::string name;  ///< "rest", "state", "range", "path_va", "path_vaj", "via_vaj", "ellipse"
  TimeProblem problem;
  JointLimits limits;
  std::vector<TimeCase> cases;
  /// [s] what durations are compared with, one a case: the shortest known ones (for path_vaj those
  /// without jerk limits; for range those without ranges). Empty where none are known.
  std::vector<double> best = {};
};

/// The sets of one robot. With a folder: `NAME_p2p.json`, and `NAME_paths.json`,
/// `NAME_ellipse.json` and `best_known.json` as far as they are there. Without: the robot's own
/// limits, and cases made at random, the same every time; so is `range` with a folder.
/// @param folder  empty = none.
[[nodiscard]] Result<std::vector<TimeSet>> load_time_sets(const std::string& robot,
                                                          const std::filesystem::path& folder);

/// What became of one case.
struct TimedMotion {
  double duration = 0;      ///< [s]
  double use = 0;           ///< worst use of a limit that counts, as a share of it
  double outside = 0;       ///< [rad or m] farthest beyond the range of a joint
  bool arrives = true;      ///< it starts, ends and passes where it has to
  bool holds = true;        ///< no limit is passed by more than the set allows
  std::string reason = {};  ///< why there is no motion; empty where there is one
};

/// What one contestant did on one set of motions.
struct TimeRun : BenchEntry {
  std::vector<TimedMotion> motions = {};  ///< one a case; slow peers do only the first ones
};

/// Steps into which a motion is cut to be judged.
[[nodiscard]] int samples_of(TimeProblem problem);

/// Judges a motion by `samples_of` + 1 states at equal intervals of time, from its start to its
/// end: by `check_limits`, and by whether it starts and ends in the states given (to 1e-6) and
/// comes within 1e-3 rad (or m) of every waypoint.
[[nodiscard]] TimedMotion judge_motion(const TimeSet& set, const TimeCase& entry, double duration,
                                       std::span<const JointState> states);

/// Runs mjarm on every case of a set, all of them `rounds` times over, one call at a time in this
/// thread, each call with a clock reading before and after; then judges the motions. Stops at
/// Ctrl-C.
[[nodiscard]] TimeRun run_time(const TimeSet& set, int rounds, Progress& progress);

}  // namespace mjarm::app
