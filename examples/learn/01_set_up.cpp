// Is everything here? One robot loaded, one pose reached, one motion simulated.
#include <cstdio>
#include <string>

#include "mjarm/core/rotation.hpp"
#include "mjarm/execution/execution.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/model/robot.hpp"

namespace {

int fail(const std::string& why) { return std::fprintf(stderr, "%s\n", why.c_str()), 1; }

}  // namespace

int main() {
  std::printf("models:");
  for (const mjarm::ShippedModel& shipped : mjarm::shipped_models()) {
    std::printf(" %s", shipped.name.c_str());
  }
  const auto robot = mjarm::load_robot("ur5e");
  if (!robot) return fail(robot.error().what);
  const auto& [model, arm] = *robot;

  const mjarm::Pose down = {{-0.13, 0.6, 0.1}, mjarm::from_euler({3.14, 0, 1.57})};  // m and rad
  const auto answer = mjarm::IkSolver(arm).solve(down, mjarm::as_span(arm.home));
  if (!answer) return fail(describe(answer.error(), arm));
  const auto move =
      mjarm::time_joint_move(mjarm::as_span(arm.home), mjarm::as_span(answer->q), arm.limits, {});
  if (!move) return fail(move.error().what);

  const auto plan = mjarm::MotionPlan::of(arm, *move);
  mjarm::Sim sim(model);
  sim.place(arm, mjarm::as_span(arm.home));
  auto execution = mjarm::Execution::create(model, plan);
  if (!execution) return fail(execution.error().what);
  if (const auto outcome = execution->run_to_end(sim); !outcome) return fail(outcome.error().what);

  const double off = (sim.tool(arm).p - down.p).norm();
  const double turned = mjarm::angle_between(sim.tool(arm).R, down.R);
  std::printf("\n%.2f s of motion, at its end the tool is %.4f mm and %.4f rad from the goal\n",
              move->duration(), 1e3 * off, turned);
  return off < 1e-4 ? 0 : 1;
}
