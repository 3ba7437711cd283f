// Three ways of control on one motion: how far the tool ends from where it should be.
#include <cstdio>
#include <vector>

#include "mjarm/execution/execution.hpp"
#include "mjarm/model/robot.hpp"

int main() {
  const auto robot = mjarm::load_robot("ur5e");
  if (!robot) return std::fprintf(stderr, "%s\n", robot.error().what.c_str()), 1;
  const auto& [model, arm] = *robot;

  const std::vector<double> stretched = {-1.57, -0.5, 0.4, -1.3, -1.57, 0};  // [rad]
  const auto move =
      mjarm::time_joint_move(mjarm::as_span(arm.home), stretched, arm.limits, {.joint_share = 0.5});
  if (!move) return std::fprintf(stderr, "%s\n", move.error().what.c_str()), 1;

  const auto plan = mjarm::MotionPlan::of(arm, *move);
  using enum mjarm::ControlMode;
  for (const mjarm::ControlMode mode : {servo, servo_gravity, computed_torque}) {
    mjarm::Sim sim(model);
    sim.place(arm, mjarm::as_span(arm.home));
    auto execution = mjarm::Execution::create(model, plan, {.control = mode, .rest = 2});
    if (!execution) return std::fprintf(stderr, "%s\n", execution.error().what.c_str()), 1;
    const auto outcome = execution->run_to_end(sim);
    if (!outcome) return std::fprintf(stderr, "%s\n", outcome.error().what.c_str()), 1;
    std::printf("%-16s static error %8.4f mm, torque used %3.0f %%\n",
                std::string(mjarm::name(mode)).c_str(), 1e3 * outcome->final_tool_error,
                100 * outcome->torque_use);
  }
}
