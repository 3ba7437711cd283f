#pragma once

#include <span>
#include <vector>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm {

/// Joint waypoints with the parameter at which each is met: that of the tool's curve (arc length
/// [m]) for Cartesian paths, joint-space length [rad] for joint moves; ascending.
struct JointPath {
  std::vector<double> s;
  std::vector<JointVec> q;
  /// Largest |q[i+1] - q[i]| of any joint [rad or m]; 0 for fewer than two waypoints.
  [[nodiscard]] double max_step() const;
};

/// `n` joint waypoints from `q0` to `q1`, linear, both ends included exactly.
/// @return an error for n < 2, sizes that differ or numbers that are not finite.
[[nodiscard]] Result<JointPath> joint_line(std::span<const double> q0, std::span<const double> q1,
                                           int n);

}  // namespace mjarm
