#include "apps/mjarm/demos/demo_stage.hpp"

#include <utility>

#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/messages/demo.hpp"
#include "apps/mjarm/messages/demo_values.hpp"
#include "mjarm/collision/exact.hpp"
#include "mjarm/install/installed.hpp"

namespace mjarm::app {

Result<Robot> load_demo_robot(const std::string& demo, const DemoOptions& options, int dof) {
  RobotChoice chosen = options.robot;
  if (options.meshes) {
    const Result<std::filesystem::path> scene = install::find_mesh_scene(chosen.robot);
    if (!scene) return fail(scene.error());
    chosen.robot = scene->string();
  }
  Result<Robot> robot = load_robot(chosen);
  if (!robot) return robot;
  const int joints = robot->arm.dof();
  if (dof != 0 && joints != dof) {
    return fail(Errc::usage, text(msg::demo_other_joints, demo, dof, joints));
  }
  return robot;
}

Result<std::unique_ptr<session::Stage>> open_stage(const std::string& demo,
                                                   const DemoOptions& options, int dof) {
  const Result<Robot> robot = load_demo_robot(demo, options, dof);
  if (!robot) return fail(robot.error());
  return session::Stage::open(demo, options, *robot);
}

Result<std::vector<double>> read_posture(const std::string& option, const std::string& words,
                                         const Arm& arm) {
  constexpr double kRounding = 1e-6;  // [rad or m]
  Result<std::vector<double>> q = parse_joints(option, words, arm);
  if (!q) return q;
  for (int i = 0; i < arm.dof(); ++i) {
    const double value = (*q)[static_cast<std::size_t>(i)];
    const double lower = arm.limits.lower[i], upper = arm.limits.upper[i];
    if (value >= lower - kRounding && value <= upper + kRounding) continue;
    return fail(Errc::bad_input,
                text(msg::demo_values_limit, option, arm.joints[static_cast<std::size_t>(i)].name,
                     lower, upper, value));
  }
  return q;
}

Pose changed(Pose goal, const std::optional<Eigen::Vector3d>& p, const DemoValues& values) {
  if (p) goal.p = *p;
  if (values.R) goal.R = *values.R;
  return goal;
}

IkSolver reach_solver(const Robot& robot) {
  return IkSolver(robot.arm, {.task = task_for(robot.arm)});
}

IkSolver free_solver(const Robot& robot) {
  return IkSolver(robot.arm, {.task = task_for(robot.arm),
                              .valid = ExactChecker(robot.model, robot.arm).predicate()});
}

}  // namespace mjarm::app
