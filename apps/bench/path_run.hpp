#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/bench/path_sets.hpp"
#include "apps/bench/report.hpp"

namespace mjarm::app {

/// What became of one path.
struct FollowedPath {
  std::vector<std::vector<double>> q = {};  ///< [rad or m] as far as it goes, one row a pose
  std::string cause = {};                   ///< why it stops; empty where not known

  bool complete = false;  ///< every pose is met, in steps of 0.5 rad (or m) at most
  int off = 0;            ///< answers that are not at their pose, or beyond a limit
  double max_step = 0;    ///< [rad or m] largest step between given poses
};

/// What one contestant did on one set of paths.
struct PathRun : BenchEntry {
  std::vector<FollowedPath> paths = {};  ///< one a path; slow peers do only the first ones
};

/// Runs mjarm on every path of a set, all of them `rounds` times over, one call at a time in this
/// thread, each call with a clock reading before and after.
/// @param advance  told after every round; false stops the work.
/// @return nothing where it was stopped.
[[nodiscard]] std::optional<PathRun> run_path(const PathProblem& problem, const PathSet& set,
                                              int rounds, const std::function<bool()>& advance);

/// Runs the peers of a Python environment on the same paths (`bench/peers/following.py`).
/// @return their runs, not judged; a peer that fails has a run that says why. Fails as `run_peers`.
[[nodiscard]] Result<std::vector<PathRun>> run_path_peers(const PathProblem& problem,
                                                          const std::filesystem::path& environment,
                                                          int rounds);

/// Judges every path of `run`, by MuJoCo's own forward kinematics.
[[nodiscard]] Result<void> judge(const PathProblem& problem, const PathSet& set, PathRun& run);

/// The suite's own columns.
[[nodiscard]] std::vector<Msg> path_columns();

/// A judged run with its cells and, for the JSON document, every path that is not complete.
[[nodiscard]] BenchEntry path_entry(const PathSet& set, const PathRun& run);

}  // namespace mjarm::app
