// Static error of a servo is gravity / gain: worked out for each joint, compared with MuJoCo, and
// cured.
#include <cmath>
#include <cstdio>
#include <vector>

#include "mjarm/core/rotation.hpp"
#include "mjarm/execution/execution.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/model/dynamics.hpp"
#include "mjarm/model/robot.hpp"

int main() {
  const auto robot = mjarm::load_robot("ur5e");
  if (!robot) return std::fprintf(stderr, "%s\n", robot.error().what.c_str()), 1;
  const auto& [model, arm] = *robot;
  const std::vector<double> start = {-1.57, -1.34, 2.65, -1.3, 1.55, 0};
  const auto goal =
      mjarm::IkSolver(arm).solve({{-0.13, 0.6, 0.1}, mjarm::from_euler({3.14, 0, 1.57})}, start);
  if (!goal) return std::fprintf(stderr, "%s\n", describe(goal.error(), arm).c_str()), 1;
  const auto move = mjarm::time_joint_move(start, mjarm::as_span(goal->q), arm.limits);
  if (!move) return std::fprintf(stderr, "%s\n", move.error().what.c_str()), 1;
  const auto plan = mjarm::MotionPlan::of(arm, *move);

  mjarm::Dynamics dynamics(model);  // this model has no joints but the arm's
  const Eigen::VectorXd& gravity = dynamics.gravity(mjarm::as_span(goal->q));
  bool good = true;
  using enum mjarm::ControlMode;
  for (const mjarm::ControlMode mode : {servo, servo_gravity, computed_torque}) {
    mjarm::Sim sim(model);
    sim.place(arm, start);
    auto execution = mjarm::Execution::create(model, plan, {.control = mode, .rest = 3});
    if (!execution) return std::fprintf(stderr, "%s\n", execution.error().what.c_str()), 1;
    const auto outcome = execution->run_to_end(sim);
    if (!outcome) return std::fprintf(stderr, "%s\n", outcome.error().what.c_str()), 1;
    for (std::size_t i = 0; mode == servo && i < arm.joints.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const double gain = arm.joints[i].actuator->gain, expected = gravity[row] / gain;
      const double sag = goal->q[row] - sim.qpos()[i];
      good = good && std::abs(sag - expected) < 1e-4 + 0.03 * std::abs(expected);
      if (std::abs(gravity[row]) < 0.1) continue;
      std::printf("%s: %.2f N m / %.0f N m/rad = %.2f mrad, measured %.2f mrad\n",
                  arm.joints[i].name.c_str(), gravity[row], gain, 1e3 * expected, 1e3 * sag);
    }
    std::printf("%s: the tool is %.2f mm off\n", std::string(mjarm::name(mode)).c_str(),
                1e3 * outcome->final_tool_error);
    good = good && (mode == servo) == (outcome->final_tool_error > 1e-5);
  }
  return good ? 0 : 1;
}
