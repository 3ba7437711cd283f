#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "apps/mjarm/command.hpp"
#include "apps/mjarm/demos/outcome.hpp"
#include "apps/mjarm/demos/stage.hpp"
#include "apps/mjarm/program_load.hpp"
#include "apps/mjarm/usage.hpp"
#include "apps/mjarm/view_host.hpp"
#include "mjarm/core/messages/app.hpp"
#include "mjarm/core/messages/demo.hpp"
#include "mjarm/core/messages/motion_program.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/progress.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm::app {
namespace {

struct Options {
  std::string file, out, control, tolerance;
  bool headless = false, no_timing = false;
};

constexpr double kSettle = 0.5;  // [s] at rest at the end

/// What there is to be told of a plan before it runs.
Report planned_report(const ProgramPlan& plan) {
  Report report;
  report.facts.push_back({"cycle_time", plan.duration()});
  for (const PlannedMove& move : plan.moves) add_motion(move, plan.arms[move.tool], report);
  return report;
}

/// The frame of tool `i`, in that of the first.
Pose tool_in_tool(const ProgramPlan& plan, std::size_t i) {
  return plan.arms.front().X_JT.inverse() * plan.arms[i].X_JT;
}

Result<void> execute(Stage& stage, const ProgramPlan& plan, ControlMode mode) {
  for (std::size_t i = 0; i < plan.moves.size(); ++i) {
    const PlannedMove& move = plan.moves[i];
    const bool last = i + 1 == plan.moves.size();
    if (move.close) {
      const Gripper& gripper = *plan.arms.front().gripper;
      stage.sim().set_ctrl(gripper.id, *move.close ? gripper.ctrl_closed : gripper.ctrl_open);
    }
    if (!last && !(move.trajectory.duration() > 0)) continue;
    auto done = stage.run(move.trajectory, mode, last ? kSettle : 0,
                          move.curve ? &*move.curve : nullptr, tool_in_tool(plan, move.tool));
    if (!done) return done;
  }
  return {};
}

/// What each motion did; runs of no duration are not among `runs`.
std::vector<ReportedMove> reported_moves(const ProgramPlan& plan,
                                         const std::vector<MeasuredRun>& runs) {
  std::vector<ReportedMove> out;
  std::size_t k = 0;
  for (std::size_t i = 0; i < plan.moves.size(); ++i) {
    const PlannedMove& move = plan.moves[i];
    ReportedMove& told = out.emplace_back();
    told.line = move.place.line;
    told.word = move.word;
    told.duration = move.trajectory.duration();
    const bool ran = i + 1 == plan.moves.size() || told.duration > 0;
    if (!ran || k >= runs.size()) continue;
    const MeasuredRun& run = runs[k++];
    if (run.curve == nullptr) continue;
    std::vector<Eigen::Vector3d> p_W;
    for (const RecordRow& row : run.rows) p_W.push_back(row.X_WT.p);
    told.path_error = measure_path(*run.curve, p_W);
  }
  return out;
}

/// Options of the command as those of a demo, which is shown and kept the same way.
Result<DemoOptions> stage_options(const Options& options, const Program& program) {
  DemoOptions out;
  out.out = options.out.empty() ? std::filesystem::path("mjarm-out") / program.name
                                : std::filesystem::path(options.out);
  out.headless = options.headless;
  out.timing = !options.no_timing;
  out.control = program.control;
  if (options.control.empty()) return out;
  const Result<ControlMode> mode = control_mode(options.control);
  if (!mode) return fail(mode.error());
  out.control = *mode;
  return out;
}

Result<double> tolerance_of(const Options& options) {
  constexpr double kTolerance = 5e-4;  // [m]
  if (options.tolerance.empty()) return kTolerance;
  const Result<double> value = parse_quantity(options.tolerance, Quantity::length);
  if (!value) return fail(in_option("--tolerance", value.error()));
  if (!(*value > 0)) return fail(Errc::usage, text(msg::motion_program_tolerance, *value));
  return value;
}

Result<Report> run_plan(const LoadedProgram& loaded, const DemoOptions& options, double tolerance) {
  const ProgramPlan& plan = loaded.plan;
  Result<std::unique_ptr<Stage>> opened =
      Stage::open(loaded.program.name, options, {loaded.robot.model, loaded.robot.arm});
  if (!opened) return fail(std::move(opened.error()));
  Stage& stage = **opened;
  const double steps = (plan.duration() + kSettle) / loaded.robot.model.timestep();
  Progress progress(text(msg::motion_program_running), static_cast<std::uint64_t>(steps));
  stage.set_tick([&progress] { progress.advance(); });
  for (const PlannedMove& move : plan.moves) {
    if (move.curve) stage.show().add_line(move.curve->poses(move.curve->stations(0.01, 0.1)));
  }
  const ControlMode mode = stage.control(ControlMode::computed_torque);
  if (auto done = execute(stage, plan, mode); !done) return fail(std::move(done.error()));
  Report report = planned_report(plan);
  report.moves = reported_moves(plan, stage.measured_runs());
  if (!stage.ended_early() && !plan.moves.empty()) {
    const Trajectory& last = plan.moves.back().trajectory;
    report.coverage = 1;
    report.static_error = pose_error(fk(plan.arms.front(), view(last.at(last.duration()).q)),
                                     stage.sim().tool(plan.arms.front()));
  }
  return stage.finish(std::move(report), tolerance);
}

Result<int> run(const Options& options) {
  if (options.file.empty()) return fail(Errc::usage, text(msg::motion_program_which_run));
  const Result<double> tolerance = tolerance_of(options);
  if (!tolerance) return fail(tolerance.error());
  catch_interrupts();
  const Result<LoadedProgram> loaded = load_program(options.file);
  if (!loaded) return fail(loaded.error());
  if (!loaded->plan.ok()) return fail(first_fault(*loaded));
  const Result<DemoOptions> stage = stage_options(options, loaded->program);
  if (!stage) return fail(stage.error());
  const Result<Report> report =
      beside_windows(stage->headless, [&] { return run_plan(*loaded, *stage, *tolerance); });
  if (!report) return fail(report.error());
  return conclude(*report, stage->out);
}

Run setup(CLI::App& app) {
  auto options = std::make_shared<Options>();
  add_option(app, "program", options->file, msg::motion_program_file, "PROGRAM.yaml");
  add_option(app, "--out", options->out, msg::demo_option_out, "DIR");
  add_flag(app, "--headless", options->headless, msg::demo_option_headless);
  add_option(app, "--control", options->control, msg::demo_option_control, "MODE");
  add_option(app, "--tolerance", options->tolerance, msg::motion_program_option_tolerance,
             "LENGTH");
  add_flag(app, "--no-timing", options->no_timing, msg::demo_option_no_timing);
  return [options] { return run(*options); };
}

}  // namespace

Command run_command() {
  return {"run", msg::motion_program_run_summary, msg::motion_program_run_examples, setup};
}

}  // namespace mjarm::app
