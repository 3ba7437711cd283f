#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/bench/report.hpp"
#include "apps/bench/time_sets.hpp"
#include "mjarm/core/joint_state.hpp"

namespace mjarm::app {

/// What became of one case.
struct TimedMotion {
  double duration = 0;      ///< [s]
  double use = 0;           ///< worst use of a limit that counts, as a share of it
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
/// thread, each call with a clock reading before and after; then judges the motions.
/// @param advance  told after every round; false stops the work.
/// @return nothing where it was stopped.
[[nodiscard]] std::optional<TimeRun> run_time(const TimeSet& set, int rounds,
                                              const std::function<bool()>& advance);

}  // namespace mjarm::app
