#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/bench/suite.hpp"
#include "apps/mjarm/cli/robot.hpp"
#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm::app {

/// One pose to solve.
struct IkCase {
  Pose X_WT;
  std::vector<double> seed;  ///< [rad or m] shape (dof,), where to start
};

/// Poses of one kind.
struct IkCaseSet {
  std::string name;        ///< "reachable", "unreachable", "hard_negatives"
  bool reachable = false;  ///< whether the right answer is "yes"
  std::vector<IkCase> cases;
};

/// A robot and what is asked of it.
struct IkProblem {
  std::string name;  ///< "ur5e", or the stem of a file
  Robot robot;
  std::vector<IkCaseSet> sets;
  std::vector<std::vector<double>> q;      ///< configurations for forward kinematics
  std::vector<std::vector<IkCase>> paths;  ///< each begins at the seed of its first pose
};

/// Loads a robot and its cases. With a folder: `NAME.urdf` there, and `NAME_reachable.jsonl`,
/// `NAME_unreachable.jsonl`, `NAME_hard_negatives.jsonl` as far as they are there. Without: the
/// shipped URDF or the given file, and cases made from random configurations, the same every time.
/// @param folder  empty = none.
/// @param seed    of the random configurations.
[[nodiscard]] Result<IkProblem> load_ik_problem(const RobotChoice& options,
                                                const std::filesystem::path& folder,
                                                std::uint64_t seed = 1);

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
/// this thread, each call with a clock reading before and after. Stops at Ctrl-C.
[[nodiscard]] std::vector<IkRun> run_ik(const IkProblem& problem, int rounds);

/// Only the sets, and only as `IkSolver` does them by itself.
[[nodiscard]] std::vector<IkRun> run_ik_sets(const IkProblem& problem, int rounds);

/// Runs the peers of a Python environment on the same cases (`bench/peers/ik.py`).
[[nodiscard]] Result<std::vector<IkRun>> run_ik_peers(const IkProblem& problem,
                                                      const std::filesystem::path& environment,
                                                      int rounds);

/// The cases of a set as the peers read them.
[[nodiscard]] std::vector<JsonDoc> cases_json(const IkCaseSet& set);

/// Judges a run, and fills its cell and, for the JSON document, every miss.
/// @return how many answers are wrong.
[[nodiscard]] Result<int> judge_and_describe(const IkProblem& problem, IkRun& run);

/// Counts what is right in `run`, by MuJoCo's own forward kinematics of the loaded file: an answer
/// within 1e-4 m, 1e-3 rad and the limits for a pose that can be reached, "no" for any other.
[[nodiscard]] Result<void> judge(const IkProblem& problem, IkRun& run);

}  // namespace mjarm::app
