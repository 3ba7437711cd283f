#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/bench/ik_cases.hpp"
#include "apps/bench/report.hpp"

namespace mjarm::app {

/// What one contestant did on one set of cases: "reachable", "unreachable", ..., "path", "track",
/// "fk_jacobian".
struct IkRun : BenchEntry {
  std::vector<std::vector<double>> q = {};  ///< answer to each case; empty = "no"
  std::vector<std::string> reasons = {};    ///< why not, one a case; empty where not known

  std::size_t cases = 0;                ///< of the whole set; slow peers do only the first ones
  int right = 0;                        ///< cases that were answered right
  std::vector<std::size_t> wrong = {};  ///< the others, from 0
  int false_ok = 0;                     ///< answers that do not reach their pose, or break a limit
  double max_step = 0;                  ///< [rad or m] largest joint step, for "path" and "track"
};

/// Runs mjarm on every set of the problem: all of them `rounds` times over, one call at a time in
/// this thread, each call with a clock reading before and after.
/// @param advance  told after every round of a set; false stops the work.
/// @return nothing where it was stopped.
[[nodiscard]] std::optional<std::vector<IkRun>> run_ik(const IkProblem& problem, int rounds,
                                                       const std::function<bool()>& advance);

/// How often `run_ik` calls `advance`.
[[nodiscard]] int ik_run_steps(const IkProblem& problem, int rounds);

/// Counts what is right in `run`, by MuJoCo's own forward kinematics of the loaded file: an answer
/// within 1e-4 m, 1e-3 rad and the limits for a pose that can be reached, "no" for any other.
[[nodiscard]] Result<void> judge(const IkProblem& problem, IkRun& run);

}  // namespace mjarm::app
