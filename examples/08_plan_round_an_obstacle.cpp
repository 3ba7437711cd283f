// A path round a wall, every edge of it proved free, timed and run in MuJoCo.
#include <cstdio>
#include <numbers>

#include "mjarm/core/rotation.hpp"
#include "mjarm/execution/execution.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/path/joint_polyline.hpp"
#include "mjarm/planning/planning_world.hpp"
#include "mjarm/trajectory/path_timing.hpp"

int main() {
  const auto robot = mjarm::load_robot("universal_robots_ur5e/wall.xml");
  if (!robot) return std::fprintf(stderr, "%s\n", robot.error().what.c_str()), 1;
  const auto& [model, arm] = *robot;

  // 20 mm are kept to everything, which leaves room to round the corners off.
  auto world = mjarm::PlanningWorld::create(*robot, {.margin = 0.02});
  if (!world) return std::fprintf(stderr, "%s\n", world.error().what.c_str()), 1;
  const Eigen::Matrix3d down = mjarm::from_euler({std::numbers::pi, 0, 0});
  const mjarm::Pose behind{{-0.3, -0.45, 0.2}, down};
  const auto path = world->plan(mjarm::as_span(arm.home), behind);
  if (!path) return std::fprintf(stderr, "%s\n", path.error().what.c_str()), 1;

  const auto line = mjarm::joint_polyline(path->q, {.blend = 0.01});
  if (!line) return std::fprintf(stderr, "%s\n", line.error().what.c_str()), 1;
  const auto motion = mjarm::time_waypoint_path(line->path.q, arm.limits);
  if (!motion) return std::fprintf(stderr, "%s\n", motion.error().what.c_str()), 1;

  const mjarm::MotionPlan plan = mjarm::MotionPlan::of(arm, *motion);
  mjarm::Sim sim(model);
  sim.place(arm, mjarm::as_span(arm.home));
  auto execution = mjarm::Execution::create(model, plan);
  if (!execution) return std::fprintf(stderr, "%s\n", execution.error().what.c_str()), 1;
  const auto done = execution->run_to_end(sim);
  if (!done) return std::fprintf(stderr, "%s\n", done.error().what.c_str()), 1;
  std::printf("%zu edges of %.2f rad in %.2f s, %s\n", path->proof.size(), path->cost,
              motion->duration(), done->first_contact ? "with a contact" : "without a contact");
  return done->first_contact ? 1 : 0;
}
