#include "mjarm/program/motion.hpp"

namespace mjarm {

std::string describe(const MotionFailure& failure, const Arm& arm) {
  if (failure.timing) return failure.timing->what;
  if (!failure.path) return {};
  return describe(*failure.path, arm);
}

Result<ToolMotion, MotionFailure> plan_tool_motion(const IkSolver& ik, const Curve& curve,
                                                   std::span<const double> q_start,
                                                   const MotionOptions& options) {
  const std::vector<double> s = curve.stations(options.station_step, options.station_angle);
  std::vector<Pose> poses;
  poses.reserve(s.size());
  for (const double station : s) poses.push_back(curve.at(station));

  Result<JointPath, PathFailure> path = solve_path(ik, poses, s, q_start, options.path);
  if (!path) return fail(MotionFailure{std::move(path.error()), {}});
  Result<Trajectory> trajectory =
      time_tool_path(*path, curve.corners(), ik.arm().limits, options.timing);
  if (!trajectory) return fail(MotionFailure{{}, std::move(trajectory.error())});
  return ToolMotion{curve, std::move(*path), std::move(*trajectory)};
}

}  // namespace mjarm
