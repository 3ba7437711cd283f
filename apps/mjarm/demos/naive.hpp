#pragma once

#include <optional>
#include <span>

#include "mjarm/kinematics/ik.hpp"
#include "mjarm/path/curve.hpp"
#include "mjarm/trajectory/trajectory.hpp"

namespace mjarm::app {

/// A line as many programs follow it, to compare with: every pose solved for itself from the answer
/// before, one pose after another in equal time, whatever the joints must do for it.
struct NaiveMotion {
  Trajectory trajectory;  ///< up to the first pose without an answer
  double fraction = 1;    ///< share of the poses answered, 0 to 1
  double peak_speed = 0;  ///< [rad/s or m/s] largest mean speed asked of a joint between two poses
  int peak_joint = 0;     ///< index of that joint
  /// The first change of branch: no path leads from one answer to the next.
  struct Flip {
    double fraction = 0;  ///< share of the poses before it
    int joint = 0;        ///< index of the joint that jumps farthest
    double jump = 0;      ///< [rad or m]
  };
  std::optional<Flip> flip;
};

/// Poses of `curve` every `period` [s] at `tool_speed` [m/s], both > 0; starts at the answer
/// nearest to `q_start`. A joint step over `flip_step` [rad or m] counts as a change of branch.
/// @return an error where the first two poses have no answer.
[[nodiscard]] Result<NaiveMotion> naive_motion(const IkSolver& ik, const Curve& curve,
                                               std::span<const double> q_start, double tool_speed,
                                               double period = 0.008, double flip_step = 0.5);

}  // namespace mjarm::app
