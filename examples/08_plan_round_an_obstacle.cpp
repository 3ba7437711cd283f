// A path round a wall, every edge of it proved free, timed and run in MuJoCo.
#include <cstdio>
#include <numbers>

#include "mjarm/core/rotation.hpp"
#include "mjarm/execution/execution.hpp"
#include "mjarm/execution/path_motion.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/planning/planning_world.hpp"

int main() {
  const auto robot = mjarm::load_robot("universal_robots_ur5e/wall.xml");
  if (!robot) return std::fprintf(stderr, "%s\n", robot.error().what.c_str()), 1;
  const auto& [model, arm] = *robot;

  // From before the wall to behind it, with 20 mm kept to everything.
  const std::vector<double> before{1.9084, -1.2456, 1.9905, -2.3157, -1.5708, 3.4792};
  const mjarm::Pose behind{{-0.3, -0.45, 0.2}, mjarm::from_euler({std::numbers::pi, 0, 0})};
  auto world = mjarm::PlanningWorld::create(*robot);
  if (!world) return std::fprintf(stderr, "%s\n", world.error().what.c_str()), 1;
  const auto path = world->plan(before, behind, {.rounds = 8, .clearance = 0.02});
  if (!path) return std::fprintf(stderr, "%s\n", path.error().what.c_str()), 1;

  // One motion: its corners are cut or swung round as far as that is proved as well.
  const auto prover = world->prover({&*path, 1});
  if (!prover) return std::fprintf(stderr, "%s\n", prover.error().what.c_str()), 1;
  const auto motion = mjarm::time_path(path->q, arm.limits, *prover);
  if (!motion) return std::fprintf(stderr, "%s\n", motion.error().what.c_str()), 1;

  const mjarm::MotionPlan plan = mjarm::MotionPlan::of(arm, motion->trajectory);
  mjarm::Sim sim(model);
  sim.place(arm, before);
  auto execution = mjarm::Execution::create(model, plan);
  if (!execution) return std::fprintf(stderr, "%s\n", execution.error().what.c_str()), 1;
  const auto done = execution->run_to_end(sim);
  if (!done) return std::fprintf(stderr, "%s\n", done.error().what.c_str()), 1;
  std::printf("%zu edges of %.2f rad in %.2f s (%.2f s with a stop at each corner), %s\n",
              path->proof.size(), path->cost, motion->trajectory.duration(), motion->stopping,
              done->first_contact ? "with a contact" : "without a contact");
  return done->first_contact || path->proof.size() < 2 ? 1 : 0;
}
