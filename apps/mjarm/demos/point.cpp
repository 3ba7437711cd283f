#include <numbers>
#include <variant>

#include "apps/mjarm/commands/program_run.hpp"
#include "apps/mjarm/demos/demo_stage.hpp"
#include "apps/mjarm/demos/demos.hpp"
#include "apps/mjarm/demos/program_demo.hpp"
#include "apps/mjarm/messages/demo.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/session/show_program.hpp"

namespace mjarm::app {
namespace {

constexpr double kTolerance = 1e-4;  // [m] for computed torque
constexpr ControlMode kModes[] = {ControlMode::servo, ControlMode::servo_gravity,
                                  ControlMode::computed_torque};

}  // namespace

Result<Report> run_point(const DemoOptions& options) {
  Result<program::Program> program = demo_program("point");
  if (!program) return fail(std::move(program.error()));
  const auto to_goal = [&options](program::Program& changing, const Arm&) -> Result<void> {
    auto* move = std::get_if<program::MoveJ>(&changing.instructions.front().what);
    auto* goal = move == nullptr ? nullptr : std::get_if<program::ProgramPose>(&move->goal);
    if (goal != nullptr) goal->X_FT = changed(goal->X_FT, options.values.to, options.values);
    return {};
  };
  const Result<program::LoadedProgram> loaded = plan_demo(std::move(*program), options, to_goal);
  if (!loaded) return fail(loaded.error());
  if (!loaded->plan.ok()) return run_demo_plan(*loaded, options);
  Result<std::unique_ptr<session::Stage>> opened =
      session::Stage::open("point", out_of_sight(options), loaded->robot);
  if (!opened) return fail(std::move(opened.error()));
  session::Stage& stage = **opened;
  const program::ProgramPlan& plan = loaded->plan;
  const Pose goal = fk(stage.arm(), as_span(plan.q_end()));
  stage.show().add_points({&goal, 1}, 1);

  Report report;
  report.control = "computed_torque";
  for (const PlannedMove& move : plan.moves) add_motion(move, stage.arm(), report);
  for (const ControlMode mode : kModes) {
    stage.show().set_pen(render::Pen::up);  // it begins at the start again, and goes there no way
    auto done = stage.move([&](MotionRun& run) { return run.execute(plan, mode, 0); });
    if (!done) return fail(std::move(done.error()));
    if (stage.run().ended_early()) break;
    const PoseError error = pose_error(goal, stage.run().sim().tool(stage.arm()));
    report.static_errors.push_back({std::string(name(mode)), error});
    report.static_error = error;  // in the end that of computed torque
    report.done += 1.0 / std::size(kModes);
    log_info(text(msg::demo_static_error, name(mode), 1e3 * error.position,
                  error.rotation * 180 / std::numbers::pi));
  }
  Result<Report> finished = stage.finish(std::move(report), kTolerance);
  if (!finished || options.headless) return finished;
  if (auto shown = session::show_program(*loaded, options.seconds); !shown)
    return fail(shown.error());
  return finished;
}

}  // namespace mjarm::app
