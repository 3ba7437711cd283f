#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mjarm/kinematics/ik.hpp"

namespace mjarm::app {

/// How to look for further answers.
struct BranchOptions {
  int starts = 64;             ///< random starts, >= 0
  int most = 16;               ///< answers kept at most (a redundant arm has no end of them), > 0
  double same = 1e-3;          ///< [rad or m] answers nearer than this in every joint are one
  std::uint64_t rng_seed = 1;  ///< same inputs and seed, same answers
};

/// Distinct configurations that put the tool at `X_WT`: `first`, then what random starts find, in
/// the order they were found. Angles that differ by whole turns count as one. Not a proof of there
/// being no more.
[[nodiscard]] std::vector<JointVec> find_branches(const IkSolver& solver, const Pose& X_WT,
                                                  const JointVec& first,
                                                  const BranchOptions& options);

}  // namespace mjarm::app
