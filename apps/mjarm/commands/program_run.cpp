#include "apps/mjarm/commands/program_run.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "apps/mjarm/messages/motion_program.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/progress.hpp"
#include "mjarm/session/program_scene.hpp"
#include "mjarm/session/show_program.hpp"

namespace mjarm::app {
namespace {

/// What a user should know of them; the same motion again says nothing new.
void tell_motions(const session::Stage& stage, const program::ProgramPlan& plan) {
  std::vector<std::string> told;
  for (const PlannedMove& move : plan.moves) {
    stage.tell_servos(move.trajectory);
    for (const SpeedDip& dip : move.dips) {
      std::string line = describe(dip, plan.arms[move.tool]);
      if (move.place.line > 0) line = text(msg::motion_program_dip, move.place.line, line);
      if (std::ranges::find(told, line) != told.end()) continue;
      log_info(line);
      told.push_back(std::move(line));
    }
  }
}

}  // namespace

Result<Report> run_plan(session::Stage& stage, const program::LoadedProgram& loaded,
                        double tolerance, Report begun) {
  const program::ProgramPlan& plan = loaded.plan;
  // How long a tool that presses looks for the surface is not known.
  const double steps =
      plan.presses() ? 0 : (plan.duration() + kRestAtEnd) / loaded.robot.model.timestep();
  Progress progress(text(msg::motion_program_running), static_cast<std::uint64_t>(steps));
  stage.set_tick([&progress] { progress.advance(); });
  tell_motions(stage, plan);
  render::Overlay paths;
  session::add_planned_paths(paths, plan);
  stage.show().add(paths);
  stage.set_outline(session::outline_of(plan));
  const ControlMode mode = stage.control(loaded.control());
  stage.run().set_contact(loaded.contact());
  auto done = stage.move([&](MotionRun& run) { return run.execute(plan, mode); });
  if (!done) return fail(std::move(done.error()));
  stage.set_tick({});
  render::Overlay ink;
  session::add_ink(ink, stage.run().ink());
  stage.show().add(ink);
  const std::vector<MeasuredRun> runs = stage.run().measured_runs();
  return stage.finish(stage.run().report(plan, runs, tolerance, std::move(begun)), tolerance, runs);
}

session::StageOptions out_of_sight(session::StageOptions options) {
  options.headless = true;
  return options;
}

Result<Report> run_and_show(const program::LoadedProgram& loaded,
                            const session::StageOptions& options, double tolerance) {
  const Result<std::unique_ptr<session::Stage>> stage =
      session::Stage::open(loaded.program.name, out_of_sight(options), loaded.robot);
  if (!stage) return fail(stage.error());
  Result<Report> report = run_plan(**stage, loaded, tolerance);
  if (!report || options.headless) return report;
  if (auto shown = session::show_program(loaded, options.seconds); !shown)
    return fail(shown.error());
  return report;
}

}  // namespace mjarm::app
