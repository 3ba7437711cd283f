#include <variant>

#include "apps/mjarm/demos/demo_stage.hpp"
#include "apps/mjarm/demos/demos.hpp"
#include "apps/mjarm/demos/program_demo.hpp"
#include "apps/mjarm/demos/tutorial.hpp"
#include "apps/mjarm/messages/demo.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/path/joint_path.hpp"

namespace mjarm::app {
namespace {

/// 100 joint waypoints, each waited for until all joints are within 0.02 rad, as the tutorial does.
Result<Report> run_waypoints(const DemoOptions& options) {
  const DemoValues& values = options.values;
  const Result<Robot> robot = load_demo_robot("movej", options, tutorial_dof(values));
  if (!robot) return fail(robot.error());
  const auto read = tutorial_seed(values, robot->arm);
  if (!read) return fail(read.error());
  const std::vector<double>& seed = *read;
  Result<std::unique_ptr<session::Stage>> opened = session::Stage::open("movej", options, *robot);
  if (!opened) return fail(std::move(opened.error()));
  session::Stage& stage = **opened;
  const Pose goal = changed(tutorial_goal(), values.to, values);
  const Result<IkSolution, IkFailure> solution = free_solver(stage.robot()).solve(goal, seed);
  if (!solution) {
    return stage.refuse(name(solution.error().code), describe(solution.error(), stage.arm()));
  }
  stage.run().start_at(seed);
  stage.show().set_balls(true);
  stage.show().plot_tool();

  constexpr int kWaypoints = 100;
  constexpr double kTolerance = 0.02;  // [m] a servo alone sags by nearly that
  const Result<JointPath> path = joint_line(seed, as_span(solution->q), kWaypoints);
  if (!path) return fail(path.error());
  const ControlMode mode = stage.control(ControlMode::servo);
  std::size_t reached = 0;
  const Result<void> done = stage.move([&](MotionRun& run) {
    return run.wait_through(path->q, {}, mode).and_then([&] {
      reached = run.outcome().reached;
      return run.jump(solution->q, mode, 0.5);
    });
  });
  if (!done) return fail(done.error());

  Report report;
  report.max_joint_step = path->max_step();
  report.done = static_cast<double>(reached) / kWaypoints;
  report.static_error = pose_error(goal, stage.run().sim().tool(stage.arm()));
  log_info(text(msg::demo_waypoints, reached, kWaypoints, 1e3 * report.static_error->position));
  return stage.finish(std::move(report), kTolerance);
}

/// The goal of the program's first move as the user wants it.
Result<void> change_goal(program::Program& program, const DemoValues& values, const Arm& arm) {
  auto* move = std::get_if<program::MoveJ>(&program.instructions.front().what);
  if (move == nullptr) return {};
  if (!values.joints.empty()) {
    Result<std::vector<double>> q = read_posture("--joints", values.joints, arm);
    if (!q) return fail(std::move(q.error()));
    move->goal = program::JointValues{.values = std::move(*q)};
  } else if (auto* goal = std::get_if<program::ProgramPose>(&move->goal)) {
    goal->X_FT = changed(goal->X_FT, values.to, values);
  }
  return {};
}

}  // namespace

Result<Report> run_movej(const DemoOptions& options) {
  if (options.guide) return run_waypoints(options);
  return run_program_demo("movej", options,
                          [&values = options.values](program::Program& program, const Arm& arm) {
                            return change_goal(program, values, arm);
                          });
}

}  // namespace mjarm::app
