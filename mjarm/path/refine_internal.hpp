#pragma once

#include <vector>

#include "mjarm/path/solve_curve.hpp"

namespace mjarm::detail {

/// A path refined, and the parameters at which its branch was lost in between.
struct Refined {
  JointPath path;
  std::vector<double> lost;  ///< ascending; empty where the path holds
};

/// Halves the stretches of `path` along `curve` until straight joint motion keeps the tolerance.
[[nodiscard]] Refined refine(const IkSolver& ik, const Curve& curve, const JointPath& path,
                             const CurveOptions& options);

}  // namespace mjarm::detail
