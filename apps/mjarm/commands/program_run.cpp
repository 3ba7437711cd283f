#include "apps/mjarm/commands/program_run.hpp"

#include <utility>

#include "apps/mjarm/messages/motion_program.hpp"
#include "apps/mjarm/view/program_scene.hpp"
#include "apps/mjarm/view/view_program.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/progress.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm::app {
namespace {

constexpr double kSettle = 0.5;  // [s] at rest at the end

/// Whether a motion is part of what is measured: something happens, and it was asked for.
bool is_measured(const ProgramPlan& plan, std::size_t i) {
  const PlannedMove& move = plan.moves[i];
  return (i + 1 == plan.moves.size() || move.trajectory.duration() > 0) && !move.is_approach();
}

/// What there is to be told of a plan before it runs.
Report planned_report(const ProgramPlan& plan, Report report) {
  report.facts.push_back({"cycle_time", plan.duration()});
  for (const PlannedMove& move : plan.moves) {
    const Arm& arm = plan.arms[move.tool];
    add_motion(move, arm, report);
    for (const SpeedDip& dip : move.dips) log_info(describe(dip, arm));
  }
  return report;
}

/// The frame of tool `i`, in that of the first.
Pose tool_in_tool(const ProgramPlan& plan, std::size_t i) {
  return plan.arms.front().X_JT.inverse() * plan.arms[i].X_JT;
}

/// What each motion did.
std::vector<ReportedMove> reported_moves(const ProgramPlan& plan,
                                         std::span<const MeasuredRun> runs) {
  std::vector<ReportedMove> out;
  std::size_t k = 0;
  for (std::size_t i = 0; i < plan.moves.size(); ++i) {
    const PlannedMove& move = plan.moves[i];
    ReportedMove& told = out.emplace_back();
    told.line = move.place.line;
    told.word = move.word;
    told.duration = move.trajectory.duration();
    if (is_measured(plan, i) && k < runs.size()) told.path_error = runs[k++].error;
  }
  return out;
}

}  // namespace

Result<void> for_each_motion(
    const ProgramPlan& plan, Sim& sim, double settle,
    const std::function<Result<void>(const PlannedMove& move, double rest)>& drive) {
  for (std::size_t i = 0; i < plan.moves.size(); ++i) {
    const PlannedMove& move = plan.moves[i];
    if (move.close) {
      const Gripper& gripper = *plan.arms.front().gripper;
      sim.set_ctrl(gripper.id, *move.close ? gripper.ctrl_closed : gripper.ctrl_open);
    }
    const bool last = i + 1 == plan.moves.size();
    if (!last && !(move.trajectory.duration() > 0)) continue;
    if (auto done = drive(move, last ? settle : 0); !done) return done;
  }
  return {};
}

Result<void> execute(Stage& stage, const ProgramPlan& plan, ControlMode mode, double settle) {
  stage.start_at(as_span(plan.q_start));
  return for_each_motion(plan, stage.sim(), settle, [&](const PlannedMove& move, double rest) {
    if (move.is_approach()) return stage.approach(move.trajectory, mode, rest);
    return stage.run(move.trajectory, mode, rest, move.curve ? &*move.curve : nullptr,
                     tool_in_tool(plan, move.tool));
  });
}

Result<Report> run_plan(Stage& stage, const LoadedProgram& loaded, double tolerance, Report begun) {
  const ProgramPlan& plan = loaded.plan;
  const double steps = (plan.duration() + kSettle) / loaded.robot.model.timestep();
  Progress progress(text(msg::motion_program_running), static_cast<std::uint64_t>(steps));
  stage.set_tick([&progress] { progress.advance(); });
  for (const PlannedMove& move : plan.moves) {
    if (!move.curve && move.corners.empty()) continue;
    stage.show().add_line(planned_tool_path(move, plan.arms[move.tool]));
  }
  Report report = planned_report(plan, std::move(begun));
  const ControlMode mode =
      stage.control(loaded.program.control.value_or(ControlMode::computed_torque));
  if (auto done = execute(stage, plan, mode, kSettle); !done) return fail(std::move(done.error()));
  stage.set_tick({});
  const std::vector<MeasuredRun> runs = stage.measured_runs();
  report.moves = reported_moves(plan, runs);
  if (!stage.ended_early() && !plan.moves.empty()) {
    const Trajectory& last = plan.moves.back().trajectory;
    report.coverage = 1;
    report.static_error = pose_error(fk(plan.arms.front(), as_span(last.at(last.duration()).q)),
                                     stage.sim().tool(plan.arms.front()));
  }
  return stage.finish(std::move(report), tolerance, runs);
}

DemoOptions out_of_sight(DemoOptions options) {
  options.headless = true;
  return options;
}

Result<Report> run_and_show(const LoadedProgram& loaded, const DemoOptions& options,
                            double tolerance, const std::string& camera) {
  const Result<std::unique_ptr<Stage>> stage = Stage::open(
      loaded.program.name, out_of_sight(options), {loaded.robot.model, loaded.robot.arm});
  if (!stage) return fail(stage.error());
  (*stage)->set_camera(camera);
  Result<Report> report = run_plan(**stage, loaded, tolerance);
  if (!report || options.headless) return report;
  if (auto shown = show_program(loaded, options.seconds); !shown) return fail(shown.error());
  return report;
}

}  // namespace mjarm::app
