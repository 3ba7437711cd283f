#include "apps/mjarm/plan/robot_world.hpp"

#include <utility>

namespace mjarm::app {

Result<RobotWorld> cover_robot(const Robot& robot, double bound) {
  const CoverOptions options{.bound = bound, .whole_stroke = robot.arm.gripper.has_value()};
  Result<ModelCover> cover = cover_model(robot.model, robot.arm, options);
  if (!cover) return fail(std::move(cover.error()));
  const Result<FastRobot> fast = FastRobot::make(robot.arm, cover->spheres);
  if (!fast) return fail(fast.error());
  Result<FastChecker> checker = FastChecker::make(*fast, cover->scene);
  if (!checker) return fail(std::move(checker.error()));
  return RobotWorld{std::move(*cover), std::move(*checker)};
}

ProblemFile as_problems(const Robot& robot, RobotWorld world, std::span<const GivenPath> paths) {
  ProblemFile out{robot.arm, std::move(world.cover.spheres), {}};
  for (const GivenPath& path : paths) {
    PlanProblem problem;
    problem.id = path.id;
    problem.obstacles = world.cover.scene;
    if (!path.rows.empty()) {
      problem.start = path.rows.front();
      problem.goals = path.rows.back();
    }
    out.problems.push_back(std::move(problem));
  }
  return out;
}

}  // namespace mjarm::app
