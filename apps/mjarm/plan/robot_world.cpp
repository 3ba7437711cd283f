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

}  // namespace mjarm::app
