#pragma once

#include <functional>
#include <span>
#include <vector>

#include "mjarm/core/joint_state.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/path/joint_path.hpp"

namespace mjarm {

/// A motion in time: q(t), v(t), a(t) for t in [0, duration]; q is twice continuously
/// differentiable and at rest at both ends unless made otherwise. A plain value; an empty one has
/// no joints.
class Trajectory {
 public:
  /// Piecewise quintic through knots; one knot alone is a rest of no duration.
  /// @param times  [s] strictly ascending from 0, at least one.
  /// @param knots  as many states of equal size, all finite.
  [[nodiscard]] static Result<Trajectory> through(const std::vector<double>& times,
                                                  const std::vector<JointState>& knots);
  /// A knot where the acceleration may jump.
  struct Knot {
    JointState state;  ///< with the acceleration before it
    JointVec a_after;  ///< [rad/s^2 or m/s^2]
  };
  /// The same by a function that gives each knot in turn, asked once for each.
  [[nodiscard]] static Result<Trajectory> from_knots(const std::vector<double>& times,
                                                     const std::function<Knot(std::size_t)>& knot);
  /// Phases of constant jerk from `start`, exact however short they are.
  /// @param durations  [s] >= 0; phases of no duration are left out.
  /// @param jerks      [rad/s^3 or m/s^3] one vector a phase.
  /// @param end        the state held from the end on, which the phases reach to rounding.
  [[nodiscard]] static Result<Trajectory> from_jerks(const JointState& start,
                                                     std::span<const double> durations,
                                                     std::span<const JointVec> jerks,
                                                     const JointState& end);

  /// One after another.
  /// @param legs  at least one; each starts, to 1e-9, where the one before ends, at rest.
  [[nodiscard]] static Result<Trajectory> chain(std::span<const Trajectory> legs);

  [[nodiscard]] double duration() const noexcept;  ///< [s]
  [[nodiscard]] int dof() const noexcept;
  /// State at time `t` [s]; before 0 and after the duration the first and the last q, at rest.
  [[nodiscard]] JointState at(double t) const;

  /// The same way in `factor` (> 0, finite) times the time.
  [[nodiscard]] Trajectory stretched(double factor) const& {
    return Trajectory(*this).stretched(factor);
  }
  [[nodiscard]] Trajectory stretched(double factor) &&;

  /// One polynomial of the motion: q(t) = sum over k of c.col(k) (t - start)^k.
  struct Piece {
    double start;                                                  ///< [s]
    double duration;                                               ///< [s] > 0
    Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 6>> c;  ///< shape (dof, 6)
  };
  [[nodiscard]] std::size_t pieces() const noexcept { return starts_.size(); }
  [[nodiscard]] Piece piece(std::size_t i) const;

 private:
  std::vector<double> starts_;  // of the pieces [s]
  std::vector<double> c_;       // of all pieces, dof * 6 each
  JointState first_;
  JointState last_;
  double duration_ = 0;
};

/// A tool speed that holds from a place of the path on.
struct SpeedFrom {
  double s = 0;      ///< parameter of the path
  double speed = 0;  ///< [m/s] > 0
};

/// Speeds asked for. Joint limits always hold and lower them where needed.
struct TimingOptions {
  double tool_speed = 0.25;  ///< [m/s] along a tool path ([rad/s] for turns on the spot), > 0
  double joint_share = 1.0;  ///< share of the joints' velocity and acceleration limits, (0, 1]
  double tool_accel = 1.0;   ///< [m/s^2] along a tool path ([rad/s^2] for turns), > 0
  double tool_ramp = 0.1;    ///< [s] in which the tool's acceleration builds up at least, > 0
  /// Other speeds than `tool_speed` from these places on, ascending.
  std::vector<SpeedFrom> tool_speeds = {};

  /// The tool speed that is asked for at parameter `s`.
  [[nodiscard]] double speed_at(double s) const noexcept;
};

/// Point to point on the straight line in joint space, at rest at both ends, within velocity,
/// acceleration and jerk limits: the fastest such move. Seven phases of constant jerk (fewer for
/// short moves), the same time law for all joints. Equal ends give a rest of no duration.
/// @return an error for sizes that differ, numbers that are not finite, limits that are not
///         positive.
[[nodiscard]] Result<Trajectory> time_joint_move(std::span<const double> q0,
                                                 std::span<const double> q1,
                                                 const JointLimits& limits,
                                                 const TimingOptions& options = {});

/// A joint path whose parameter is the tool's arc length, walked at `tool_speed` where the joint
/// limits allow, slower elsewhere; at rest at both ends and at `stops`. Between stops the joints
/// follow the cubic spline through the waypoints exactly; velocities, accelerations and jerks keep
/// their limits at every moment.
/// @param path   s strictly ascending (parameters of turns on the spot are angles [rad]).
/// @param stops  parameters of waypoints where the tool must rest: the corners of the curve.
/// @return an error for bad sizes or numbers, or a stop that is no waypoint.
[[nodiscard]] Result<Trajectory> time_tool_path(const JointPath& path,
                                                std::span<const double> stops,
                                                const JointLimits& limits,
                                                const TimingOptions& options = {});

/// Worst use of each limit over a trajectory, as a share of the limit (1 = at the limit).
struct LimitUse {
  JointVec velocity;
  JointVec acceleration;
  JointVec jerk;                       ///< from differences of the acceleration over one sample
  JointVec position;                   ///< 0 inside, else how far beyond [rad or m]
  [[nodiscard]] double worst() const;  ///< largest share of velocity and acceleration
};
/// Samples `trajectory` every `dt` [s] (> 0) and at its end; shares no code with the timers.
/// `limits` has the trajectory's number of joints.
[[nodiscard]] LimitUse check_limits(const Trajectory& trajectory, const JointLimits& limits,
                                    double dt = 0.001);

}  // namespace mjarm
