// A motion program as calls: joint and straight moves, blended, planned as one and run in MuJoCo.
#include <cstdio>

#include "mjarm/core/rotation.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/program/program_plan.hpp"
#include "mjarm/sim/follow.hpp"

int main() {
  const auto robot = mjarm::load_robot("ur5e");
  if (!robot) return std::fprintf(stderr, "%s\n", robot.error().what.c_str()), 1;
  const auto& [model, arm] = *robot;

  const Eigen::Matrix3d down = mjarm::from_euler({3.14, 0, 0});
  const auto pose = [&](double x, double y, double z) { return mjarm::Pose{{x, y, z}, down}; };
  mjarm::Program program;
  program.instructions = {
      mjarm::move_j(pose(0.2, -0.45, 0.4)),
      mjarm::repeat(2, {mjarm::move_l(pose(-0.2, -0.45, 0.4), 0.3, 0.02),  // 20 mm of blend
                        mjarm::move_l(pose(-0.2, -0.45, 0.25), 0.1), mjarm::wait(0.2),
                        mjarm::move_c(pose(0, -0.35, 0.35), pose(0.2, -0.45, 0.4))})};
  const mjarm::ProgramPlan plan = mjarm::plan_program(model, arm, program);
  for (const auto& fault : plan.faults) std::fprintf(stderr, "%s\n", fault.what.c_str());
  if (!plan.ok()) return 1;

  auto controller = mjarm::Controller::make(model, arm, mjarm::ControlMode::computed_torque);
  if (!controller) return std::fprintf(stderr, "%s\n", controller.error().what.c_str()), 1;
  mjarm::Sim sim(model);
  sim.place(arm, mjarm::as_span(plan.q_start));
  double worst = 0;
  for (const mjarm::PlannedMove& move : plan.moves) {
    const auto done = mjarm::follow_time({.sim = sim, .controller = *controller, .arm = arm},
                                         move.trajectory, {.settle = 0});
    if (!done) return std::fprintf(stderr, "%s\n", describe(done.error(), arm).c_str()), 1;
    worst = std::max(worst, done->worst_error);
  }
  std::printf("%zu motions in %.2f s, joints within %.1g rad of the plan\n", plan.moves.size(),
              plan.duration(), worst);
}
