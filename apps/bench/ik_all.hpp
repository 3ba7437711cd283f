#pragma once

#include <string>
#include <vector>

#include "apps/bench/ik.hpp"
#include "apps/bench/suite.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm::app {

/// What one contestant of `mjarm bench ik --all` found: all answers to each pose.
struct BranchRun : BenchEntry {
  std::vector<std::vector<std::vector<double>>> q = {};  ///< [rad or m] answers to each pose
};

/// What a contestant found of the branches that anybody knows.
struct BranchCount {
  int found = 0;
  int known = 0;     ///< at the poses that it did
  int false_ok = 0;  ///< answers that do not reach their pose, or break a limit
};

/// Counts for each of the runs: a branch is known where some run has an answer that reaches the
/// pose by MuJoCo's own forward kinematics inside the limits; answers nearer to each other than
/// 1e-3 rad or m in every joint, but for whole turns, are one branch.
[[nodiscard]] Result<std::vector<BranchCount>> count_branches(const Robot& robot,
                                                              const std::vector<IkCase>& poses,
                                                              const std::vector<BranchRun>& runs);

/// `mjarm bench ik --all`: all branches at the first 300 poses of the reachable set, as
/// `solve_all()` finds them, beside its own search from random starts, 10,000 such starts, and the
/// peers that give all branches.
[[nodiscard]] BenchVariant ik_all_variant();

}  // namespace mjarm::app
