#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/path/curve.hpp"
#include "mjarm/path/solve_path.hpp"
#include "mjarm/trajectory/tool_speed.hpp"
#include "mjarm/trajectory/trajectory.hpp"

namespace mjarm {

/// How a tool motion is made from a curve.
struct MotionOptions {
  PathOptions path = {};
  TimingOptions timing = {};
  /// So far would the tool leave the curve if the joints moved straight between the waypoints. They
  /// follow a spline through them, whose error falls with the square of this: at 2e-7 m the tool
  /// stays within 1e-8 m of the curve, far below what any controller makes of it.
  double pos_tol = 2e-7;  ///< [m]   > 0
  double rot_tol = 2e-6;  ///< [rad] > 0
  /// True: a motion on which the tool cannot keep `timing.tool_speed` is a failure; the branch is
  /// chosen so that it can. False: it slows down where it must, and `dips` tells where.
  bool keep_speed = false;
  /// The tool is on its way already and begins at its speed (time_tool_path_at_speed()).
  bool at_speed = false;
};

/// A curve, the joint values along it, and when each is met.
struct ToolMotion {
  Curve curve;
  JointPath path;
  Trajectory trajectory;
  std::vector<SpeedDip> dips;  ///< where the tool is slower than asked
};

/// Why a motion has no answer: `path` where the geometry fails (`joint_speed` where the tool
/// cannot keep its speed), `timing` where only the timing does.
struct MotionFailure {
  std::optional<PathFailure> path;
  std::optional<Error> timing;
};

/// One line for people.
[[nodiscard]] std::string describe(const MotionFailure& failure, const Arm& arm);

/// MoveL, MoveC, ellipse: the tool along `curve`, from a branch near `q_start`, within the arm's
/// limits. The trajectory starts at `path.q.front()`, which may differ from `q_start`.
[[nodiscard]] Result<ToolMotion, MotionFailure> plan_tool_motion(const IkSolver& ik,
                                                                 const Curve& curve,
                                                                 std::span<const double> q_start,
                                                                 const MotionOptions& options = {});

/// The two halves of plan_tool_motion(), for those who plan the path of what follows while the
/// timing of one motion is worked out on another thread: the path,
[[nodiscard]] Result<JointPath, PathFailure> plan_tool_path(const IkSolver& ik, const Curve& curve,
                                                            std::span<const double> q_start,
                                                            const MotionOptions& options = {});
/// and its timing.
[[nodiscard]] Result<ToolMotion, MotionFailure> time_tool_motion(const IkSolver& ik,
                                                                 const Curve& curve, JointPath path,
                                                                 const MotionOptions& options = {});

}  // namespace mjarm
