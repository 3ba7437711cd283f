#include "mjarm/trajectory/tool_motion.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mjarm/path/solve_curve.hpp"
#include "mjarm/trajectory/at_speed.hpp"

namespace mjarm {
namespace {

/// Why the speed is not kept: the dip in which it is missed most.
MotionFailure too_fast(const Arm& arm, const ToolMotion& motion, double joint_share) {
  const SpeedDip& worst =
      *std::min_element(motion.dips.begin(), motion.dips.end(),
                        [](const SpeedDip& a, const SpeedDip& b) { return a.kept < b.kept; });
  const double use = joint_share * worst.use;  // of the whole limit
  if (worst.limit != SpeedLimit::velocity || use <= 1) {
    return {{}, Error{Errc::impossible, describe(worst, arm)}};
  }
  PathFailure failure;
  failure.code = PathErrc::joint_speed;
  failure.joint = worst.joint;
  failure.amount = arm.limits.velocity[worst.joint] * (use - 1);
  failure.s = worst.s_from;
  failure.fraction = worst.s_from / motion.curve.end();
  const auto& s = motion.path.s;
  failure.at =
      static_cast<std::size_t>(std::upper_bound(s.begin(), s.end(), failure.s) - s.begin());
  return {std::move(failure), {}};
}

}  // namespace

std::string describe(const MotionFailure& failure, const Arm& arm) {
  if (failure.timing) return failure.timing->what;
  if (!failure.path) return {};
  return describe(*failure.path, arm);
}

Result<JointPath, PathFailure> plan_tool_path(const IkSolver& ik, const Curve& curve,
                                              std::span<const double> q_start,
                                              const MotionOptions& options) {
  CurveOptions follow{.path = options.path, .pos_tol = options.pos_tol, .rot_tol = options.rot_tol};
  if (options.keep_speed) follow.path.tool_speed = options.timing.tool_speed;
  return solve_curve(ik, curve, q_start, follow);
}

Result<ToolMotion, MotionFailure> time_tool_motion(const IkSolver& ik, const Curve& curve,
                                                   JointPath path, const MotionOptions& options) {
  const StopCheck& stop = options.path.stop;
  const auto ended = [] {
    PathFailure failure;
    failure.code = PathErrc::stopped;
    return fail(MotionFailure{std::move(failure), {}});
  };
  if (is_stopped(stop)) return ended();
  const auto timed = options.at_speed ? time_tool_path_at_speed : time_tool_path;
  Result<Trajectory> trajectory = timed(path, curve.corners(), ik.arm().limits, options.timing);
  if (!trajectory) return fail(MotionFailure{{}, std::move(trajectory.error())});
  ToolMotion motion{curve, std::move(path), std::move(*trajectory), {}};
  if (is_stopped(stop)) return ended();
  motion.dips = find_speed_dips(ik, curve, motion.trajectory, options.timing);
  if (options.keep_speed && !motion.dips.empty())
    return fail(too_fast(ik.arm(), motion, options.timing.joint_share));
  return motion;
}

Result<ToolMotion, MotionFailure> plan_tool_motion(const IkSolver& ik, const Curve& curve,
                                                   std::span<const double> q_start,
                                                   const MotionOptions& options) {
  Result<JointPath, PathFailure> path = plan_tool_path(ik, curve, q_start, options);
  if (!path) return fail(MotionFailure{std::move(path.error()), {}});
  return time_tool_motion(ik, curve, std::move(*path), options);
}

}  // namespace mjarm
