#pragma once

#include <cstddef>
#include <span>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/trajectory/trajectory.hpp"

namespace mjarm {

/// Where the arm shall be on the grid of time steps around the step that comes, each (dof,) [rad or
/// m]. Three positions are all a time-stepping simulation can follow: with velocities and
/// accelerations of the continuous motion it would miss the grid by terms of the time step.
struct StepReference {
  JointVec before;  ///< one step ago
  JointVec now;     ///< at the start of the step
  JointVec next;    ///< at its end

  /// Mean velocity of the step just done, which semi-implicit Euler has as its velocity now.
  [[nodiscard]] JointVec velocity(double timestep) const { return (now - before) / timestep; }
  /// Acceleration that leads from `before` and `now` to `next`: v+ = v + h a, q+ = q + h v+.
  [[nodiscard]] JointVec acceleration(double timestep) const {
    return ((next - now) - (now - before)) / (timestep * timestep);
  }
};

/// Stand still at `q`; also the reference for a jump to `q`.
[[nodiscard]] StepReference hold(std::span<const double> q);

/// The reference of the step that begins at time `t` [s] of `trajectory`.
[[nodiscard]] StepReference reference_at(const Trajectory& trajectory, double t, double timestep);

/// The reference of step `i` along positions at every step, those before q[0] as there; i + 1 <
/// q.size().
[[nodiscard]] StepReference reference_at(std::span<const JointVec> q, std::size_t i);

}  // namespace mjarm
