// Joint waypoints passed without a stop, as fast as the joints allow, and executed in MuJoCo.
#include <cstdio>
#include <vector>

#include "mjarm/execution/execution.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/trajectory/via_points.hpp"

int main() {
  const auto robot = mjarm::load_robot("ur5e");
  if (!robot) return std::fprintf(stderr, "%s\n", robot.error().what.c_str()), 1;
  const auto& [model, arm] = *robot;

  std::vector<mjarm::JointVec> waypoints(5, arm.home);  // [rad]
  waypoints[1][0] += 0.4;
  waypoints[2][0] += 0.8, waypoints[2][2] -= 0.4;
  waypoints[3][0] += 0.3, waypoints[3][2] -= 0.2;
  const auto motion = mjarm::time_via_points(waypoints, arm.limits);
  if (!motion) return std::fprintf(stderr, "%s\n", motion.error().what.c_str()), 1;
  for (const double t : motion->times) {
    const double speed = motion->trajectory.at(t).v.cwiseAbs().maxCoeff();
    std::printf("waypoint at %.3f s, passed at up to %.2f rad/s\n", t, speed);
  }

  mjarm::Sim sim(model);
  sim.place(arm, mjarm::as_span(waypoints.front()));
  const auto plan = mjarm::MotionPlan::of(arm, motion->trajectory);
  auto execution = mjarm::Execution::create(model, plan);
  if (!execution) return std::fprintf(stderr, "%s\n", execution.error().what.c_str()), 1;
  const auto outcome = execution->run_to_end(sim);
  if (!outcome) return std::fprintf(stderr, "%s\n", outcome.error().what.c_str()), 1;
  std::printf("%.2f s, joints within %.1g rad of it, %.0f %% of the torque used\n", plan.duration(),
              outcome->worst_error, 100 * outcome->torque_use);
}
