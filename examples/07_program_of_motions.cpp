// A motion program as calls: joint and straight moves, blended, planned as one and run in MuJoCo.
#include <cstdio>

#include "mjarm/core/rotation.hpp"
#include "mjarm/execution/execution.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/program/program_plan.hpp"

namespace motions = mjarm::program;

int main() {
  const auto robot = mjarm::load_robot("ur5e");
  if (!robot) return std::fprintf(stderr, "%s\n", robot.error().what.c_str()), 1;
  const auto& [model, arm] = *robot;

  const Eigen::Matrix3d down = mjarm::from_euler({3.14, 0, 0});
  const auto pose = [&](double x, double y, double z) { return mjarm::Pose{{x, y, z}, down}; };
  motions::Program program;
  program.instructions = {
      motions::move_j(pose(0.2, -0.45, 0.4)),
      motions::repeat(2, {motions::move_l(pose(-0.2, -0.45, 0.4), 0.3, 0.02),  // 20 mm of blend
                          motions::move_l(pose(-0.2, -0.45, 0.25), 0.1), motions::wait(0.2),
                          motions::move_c(pose(0, -0.35, 0.35), pose(0.2, -0.45, 0.4))})};
  const motions::ProgramPlan plan = motions::plan_program(model, arm, program);
  for (const auto& fault : plan.faults) std::fprintf(stderr, "%s\n", fault.what.c_str());
  if (!plan.ok()) return 1;

  mjarm::Sim sim(model);
  sim.place(arm, mjarm::as_span(plan.q_start));
  auto execution = mjarm::Execution::create(model, plan);
  if (!execution) return std::fprintf(stderr, "%s\n", execution.error().what.c_str()), 1;
  const auto outcome = execution->run_to_end(sim);
  if (!outcome) return std::fprintf(stderr, "%s\n", outcome.error().what.c_str()), 1;
  std::printf("%zu motions in %.2f s, joints within %.1g rad of the plan\n", plan.moves.size(),
              plan.duration(), outcome->worst_error);
}
