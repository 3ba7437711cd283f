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
  bad_states,   ///< sizes that differ, no joint, numbers that are not finite or that overflow
  bad_limits,   ///< a limit that is not above 0, or neither acceleration nor jerk limited
  end_outside,  ///< the end is beyond a limit, or an approach with full jerk would come from there
  start_leaves_range,  ///< full braking from the start takes the joint beyond its range
  end_leaves_range,    ///< the joint must come to the end from beyond its range
  no_room,             ///< neither, but no motion within the range was found: it is too narrow
};
/// The reason, and the first joint (from 0) it holds for.
struct PointToPointFailure {
  PointToPointErrc code;
  int joint;
  double beyond = 0;  ///< [rad or m] that it must leave its range by (`*_leaves_range`)
};

/// The fastest motion of all joints together from one state to another within velocity,
/// acceleration and jerk limits: no such motion is shorter. All joints arrive at the same time;
/// those that need not hurry move as smoothly as the limits let them, at a share of their jerk
/// (from rest to rest with the same limits for all joints: on the straight line in joint space).
///
/// A start beyond a limit, or that cannot but overshoot one, first returns within the limits as
/// fast as the jerk and acceleration limits allow. A state that goes on after the duration is not
/// kept: the motion ends there.
///
/// No joint leaves its range, at no moment. Where the fastest motion does not either, it is the
/// answer; else joints cruise more slowly, touch their limit where they turn, or rest on the way.
/// That answer is short, but not proved to be the shortest. There is none at all for a start from
/// which full braking ends beyond the range, or an end that full braking backwards in time so
/// leaves, unless the fastest motion is over before.
///
/// A plain value with inline storage. Memory: about 20 KB.
class PointToPoint {
 public:
  /// No joints. Leaves its storage as it is: to fill that takes about as long as to solve.
  PointToPoint() noexcept {}  // NOLINT(modernize-use-equals-default): "= default" would fill it

  /// Never throws, never allocates, bounded steps; same input, same bytes.
  /// @param start,end  shape (dof,), 1 <= dof <= kMaxDof, all finite.
  /// @param limits     `velocity`, `acceleration` and `jerk`, > 0. Each may be infinite for a
  /// joint,
  ///                   as long as not both of its acceleration and jerk are; without a jerk limit
  ///                   the acceleration jumps, and those of the two states do not matter. `lower`
  ///                   and `upper`: ranges, widened to hold both ends; infinite or empty = none.
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
  // 3 to return within the limits; then twice the phases of two motions with 7 each, laid over
  // another.
  struct Joint {
    int count = 0;
    std::array<Piece, 29> pieces;
  };
  JointState start_;
  JointState end_;
  double duration_ = 0;
  std::array<Joint, kMaxDof> joints_;
};

/// `PointToPoint` as a trajectory, with errors in words.
/// @param limits  with finite jerk; `lower` and `upper` may be empty for joints without stops.
/// @return an error that names the joint and, where it has to leave its range, by how much.
[[nodiscard]] Result<Trajectory> point_to_point(const JointState& start, const JointState& end,
                                                const JointLimits& limits);

}  // namespace mjarm
