#pragma once

#include <vector>

#include "mjarm/path/solve_curve.hpp"

namespace mjarm::detail {

/// A place between two waypoints where the path cannot be had as it is.
struct Lost {
  double s = 0;
  int joint = -1;     ///< too fast there; none where the branch is lost
  double amount = 0;  ///< [rad/s or m/s] too fast by so much
};

/// A path refined, and where that failed.
struct Refined {
  JointPath path;
  std::vector<Lost> lost;  ///< ascending; empty where the path holds
};

/// Halves the stretches of `path` along `curve` until straight joint motion keeps the tolerance;
/// no joint may then be faster than its limit at the speed asked for.
[[nodiscard]] Refined refine(const IkSolver& ik, const Curve& curve, const JointPath& path,
                             const CurveOptions& options);

}  // namespace mjarm::detail
