#pragma once

#include <optional>
#include <span>
#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/path/curve.hpp"
#include "mjarm/path/solve_path.hpp"
#include "mjarm/trajectory/trajectory.hpp"

namespace mjarm {

/// How a tool motion is made from a curve.
struct MotionOptions {
  PathOptions path = {};
  TimingOptions timing = {};
  double station_step = 0.001;  ///< [m]   IK every so far along the curve, > 0
  double station_angle = 0.01;  ///< [rad] and every so much turn, > 0
};

/// A curve, the joint values along it, and when each is met.
struct ToolMotion {
  Curve curve;
  JointPath path;
  Trajectory trajectory;
};

/// Why a motion has no answer: `path` where the geometry fails, `timing` where only the timing
/// does.
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

}  // namespace mjarm
