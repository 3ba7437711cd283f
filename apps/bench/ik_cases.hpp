#pragma once

#include <filesystem>
#include <string>
#include <vector>

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
[[nodiscard]] Result<IkProblem> load_ik_problem(const RobotChoice& options,
                                                const std::filesystem::path& folder);

}  // namespace mjarm::app
