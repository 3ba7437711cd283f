#include "apps/mjarm/demos/demo_stage.hpp"

#include <utility>

#include "apps/mjarm/messages/demo.hpp"
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

IkSolver reach_solver(const Robot& robot) {
  return IkSolver(robot.arm, {.task = task_for(robot.arm)});
}

IkSolver free_solver(const Robot& robot) {
  return IkSolver(robot.arm, {.task = task_for(robot.arm),
                              .valid = ExactChecker(robot.model, robot.arm).predicate()});
}

}  // namespace mjarm::app
