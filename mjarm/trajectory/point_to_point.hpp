#pragma once

#include <array>
#include <span>

#include "mjarm/core/joint_state.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/trajectory/trajectory.hpp"

namespace mjarm {

/// Why there is no point-to-point motion.
enum class PointToPointErrc {
  bad_states,   ///< sizes that differ, no joint or more than kMaxDof, numbers that are not finite
  bad_limits,   ///< a limit that is not above 0, or neither acceleration nor jerk limited
  end_outside,  ///< no motion within the limits ends like this: too fast, or just coming from there
};
/// The reason, and the first joint (from 0) it holds for.
struct PointToPointFailure {
  PointToPointErrc code;
  int joint;
};

/// The fastest motion of all joints together from one state to another within velocity,
/// acceleration and jerk limits: no such motion is shorter. All joints arrive at the same time;
/// those that need not hurry move as smoothly as the limits let them, at a share of their jerk
/// (from rest to rest with the same limits for all joints: on the straight line in joint space).
///
/// A start beyond a limit, or that cannot but overshoot one, first returns within the limits as
/// fast as the jerk and acceleration limits allow. A state that goes on after the duration is not
/// kept: the motion ends there. Position limits are not looked at (`point_to_point` does).
///
/// A plain value with inline storage. Memory: about 11 KB.
class PointToPoint {
 public:
  /// Never throws, never allocates, bounded steps; same input, same bytes.
  /// @param start,end  shape (dof,), 1 <= dof <= kMaxDof, all finite.
  /// @param limits     `velocity`, `acceleration` and `jerk`, > 0. Each may be infinite for a
  /// joint,
  ///                   as long as not both of its acceleration and jerk are; without a jerk limit
  ///                   the acceleration jumps, and those of the two states do not matter.
  [[nodiscard]] static Result<PointToPoint, PointToPointFailure> solve(
      const JointState& start, const JointState& end, const JointLimits& limits) noexcept;

  /// A stretch of constant jerk of one joint, up to the next or the duration.
  struct Piece {
    double t;     ///< [s] when it begins
    double q;     ///< [rad or m] then
    double v;     ///< [rad/s or m/s] then
    double a;     ///< [rad/s^2 or m/s^2] then
    double jerk;  ///< [rad/s^3 or m/s^3] all the while
  };

  [[nodiscard]] double duration() const noexcept { return duration_; }  ///< [s]
  [[nodiscard]] int dof() const noexcept { return static_cast<int>(end_.q.size()); }
  /// Pieces of joint 0 <= `joint` < dof, in time order; none for a motion of no duration.
  [[nodiscard]] std::span<const Piece> pieces(int joint) const noexcept;
  /// State at time `t` [s], clamped to [0, duration].
  [[nodiscard]] JointState at(double t) const noexcept;

 private:
  // 3 to return within the limits; then the phases of two motions with 7 each, laid over another.
  struct Joint {
    int count;
    std::array<Piece, 16> pieces;
  };
  JointState start_;
  JointState end_;
  double duration_ = 0;
  std::array<Joint, kMaxDof> joints_;
};

/// `PointToPoint` as a trajectory, with errors in words.
/// @param limits  with finite jerk; `lower` and `upper` may be empty for joints without stops.
/// @return an error also when the motion would leave the range between its ends and the position
///         limits: moves from a standstill never do.
[[nodiscard]] Result<Trajectory> point_to_point(const JointState& start, const JointState& end,
                                                const JointLimits& limits);

}  // namespace mjarm
