#pragma once

#include <memory>
#include <span>
#include <vector>

#include "mjarm/core/joint_state.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/path/joint_path.hpp"

namespace mjarm {

/// A motion in time: q(t), v(t), a(t) for t in [0, duration]; at rest at both ends unless made
/// otherwise. A plain value.
class Trajectory {
 public:
  /// Piecewise quintic through knots (times ascending from 0, states of equal size).
  [[nodiscard]] static Result<Trajectory> through(std::vector<double> times,
                                                  std::vector<JointState> knots);

  [[nodiscard]] double duration() const noexcept;  ///< [s]
  [[nodiscard]] int dof() const noexcept;
  /// State at time `t` [s]; held at the ends outside [0, duration].
  [[nodiscard]] JointState at(double t) const;

 private:
  std::vector<double> times_;
  std::vector<JointState> knots_;
};

/// Speeds asked for. Joint limits always hold and lower them where needed.
struct TimingOptions {
  double tool_speed = 0.25;  ///< [m/s] speed of the tool along a Cartesian path, > 0
  double joint_share = 1.0;  ///< share of the joints' velocity and acceleration limits, (0, 1]
  double tool_accel = 1.0;   ///< [m/s^2] along the path, > 0
};

/// Point to point, all joints start and arrive together, at rest at both ends, within velocity,
/// acceleration and jerk limits.
[[nodiscard]] Result<Trajectory> time_joint_move(std::span<const double> q0,
                                                 std::span<const double> q1,
                                                 const JointLimits& limits,
                                                 const TimingOptions& options = {});

/// A joint path whose parameter is the tool's arc length, walked at `tool_speed` where the joint
/// limits allow, slower elsewhere; at rest at both ends (and at sharp corners of the path).
[[nodiscard]] Result<Trajectory> time_tool_path(const JointPath& path,
                                                std::span<const double> stops,
                                                const JointLimits& limits,
                                                const TimingOptions& options = {});

/// Worst use of each limit over a trajectory, as a share of the limit (1 = at the limit).
struct LimitUse {
  JointVec velocity;
  JointVec acceleration;
  JointVec position;  ///< 0 inside, else how far beyond [rad or m]
  [[nodiscard]] double worst() const;  ///< largest share of velocity and acceleration
};
/// Samples `trajectory` every `dt` [s]; shares no code with the timers.
[[nodiscard]] LimitUse check_limits(const Trajectory& trajectory, const JointLimits& limits,
                                    double dt = 0.001);

}  // namespace mjarm
