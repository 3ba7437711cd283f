#include <numbers>

#include "apps/mjarm/demos/demos.hpp"
#include "apps/mjarm/demos/stage.hpp"
#include "apps/mjarm/demos/tutorial.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/demo.hpp"

namespace mjarm::app {
namespace {

constexpr double kSettle = 2;        // [s] at rest before the error is read
constexpr double kTolerance = 1e-4;  // [m] for computed torque

}  // namespace

Result<Report> run_point(const DemoOptions& options) {
  Result<std::unique_ptr<Stage>> opened = Stage::open("point", options, 6);
  if (!opened) return fail(std::move(opened.error()));
  Stage& stage = **opened;
  const Pose goal = tutorial_goal();
  const std::vector<double> seed = tutorial_seed();
  stage.show().add_points({&goal, 1}, 1);
  const Result<IkSolution, IkFailure> solution = stage.ik().solve(goal, seed);
  if (!solution) {
    return stage.refuse(name(solution.error().code), describe(solution.error(), stage.arm()));
  }
  const Result<Trajectory> move = time_joint_move(seed, view(solution->q), stage.arm().limits);
  if (!move) return fail(move.error());

  Report report;
  report.control = "computed_torque";
  report.max_joint_step = (solution->q - joint_vec(seed)).cwiseAbs().maxCoeff();
  for (const ControlMode mode :
       {ControlMode::servo, ControlMode::servo_gravity, ControlMode::computed_torque}) {
    stage.start_at(seed);
    if (auto done = stage.run(*move, mode, kSettle); !done) return fail(std::move(done.error()));
    if (stage.ended_early()) break;
    const PoseError error = pose_error(goal, stage.sim().tool(stage.arm()));
    report.static_errors.push_back({std::string(name(mode)), error});
    report.static_error = error;  // in the end that of computed torque
    report.coverage += 1.0 / 3.0;
    log_info(text(msg::demo_static_error, name(mode), 1e3 * error.position,
                  error.rotation * 180 / std::numbers::pi));
  }
  return stage.finish(std::move(report), kTolerance);
}

}  // namespace mjarm::app
