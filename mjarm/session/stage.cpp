#include "mjarm/session/stage.hpp"

#include <algorithm>
#include <utility>

#include "mjarm/core/file.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/show.hpp"
#include "mjarm/execution/beyond_servo.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/session/picture.hpp"
#include "mjarm/session/program_scene.hpp"
#include "mjarm/session/run_charts.hpp"
#include "mjarm/session/run_output.hpp"

namespace mjarm::session {
namespace {

/// What stands still beside the arm.
void tell_held(const Sim& sim) {
  const std::vector<HeldState> held = sim.held();
  if (held.empty()) return;
  const auto driven = std::ranges::count_if(
      held, [](const HeldState& one) { return one.joint.actuator.has_value(); });
  const auto all = static_cast<std::ptrdiff_t>(held.size());
  log_info(text(msg::show_held, all, driven, all - driven));
}

/// What did not.
void tell_moved(const std::vector<HeldState>& held) {
  constexpr double kStill = 1e-3;  // [rad or m]
  for (const HeldState& one : held) {
    if (one.moved > kStill) log_warning(text(msg::show_held_moved, one.joint.name, one.moved));
  }
}

}  // namespace

Stage::Stage(std::string name, const StageOptions& options, const Robot& robot, RunShow show)
    : name_(std::move(name)),
      options_(options),
      robot_(robot),
      run_(robot.model, robot.arm),
      show_(std::move(show)) {
  run_.set_after_step([this](const Sim& sim, MotionPart part) {
    show_.set_pen(pen_of(part));
    return show_step(sim);
  });
  run_.start_at(as_span(robot_.arm.home));
  show_.let_push(run_.sim());
}

Result<std::unique_ptr<Stage>> Stage::open(const std::string& name, const StageOptions& options,
                                           const Robot& robot) {
  for (const std::string& warning : robot.model.warnings()) log_info(warning);
  if (task_for(robot.arm) == IkTask::position) {
    log_info(text(msg::show_position_only, robot.arm.dof()));
  }
  Result<OutputFolder> folder = OutputFolder::open(options.out, options.replace);
  if (!folder) return fail(std::move(folder.error()));
  Result<RunShow> show = RunShow::open(robot.model, "mjarm " + name, options.headless);
  if (!show) return fail(std::move(show.error()));
  std::unique_ptr<Stage> stage(new Stage(name, options, robot, std::move(*show)));
  stage->folder_ = std::move(*folder);
  tell_held(stage->run_.sim());
  return stage;
}

ControlMode Stage::control(ControlMode fallback) {
  const ControlMode mode = options_.control.value_or(fallback);
  control_ = mjarm::name(mode);
  return mode;
}

bool Stage::show_step(const Sim& sim) {
  if (options_.seconds > 0 && sim.time() >= options_.seconds) return false;
  if (tick_) tick_();
  return show_.step(sim, sim.tool(robot_.arm).p);
}

Result<void> Stage::begin_film() {
  if (options_.record && !show_.is_recording()) show_.record(run_.sim(), &robot_.arm);
  if (!options_.video || show_.is_filming()) return {};
  return show_.film(robot_.model, options_.out / kVideoFile, camera());
}

/// Of what will be done, else of what was.
render::Camera Stage::camera() const {
  if (!outline_ && run_.recorder().size() == 0) return default_camera(robot_.model);
  const MotionOutline outline = outline_ ? *outline_ : outline_of(run_.recorder());
  return {.view = motion_view(robot_.model, robot_.arm, outline, options_.video)};
}

Result<MeasuredRun> Stage::rehearse(const Trajectory& trajectory, ControlMode mode,
                                    const Curve& curve) {
  constexpr double kRest = 0.3;  // [s]
  show_.set_pen(render::Pen::up);
  show_.set_filming(false);
  MotionRun apart(robot_.model, robot_.arm);
  apart.set_after_step([this](const Sim& sim, MotionPart) { return show_step(sim); });
  apart.start_at(as_span(trajectory.at(0).q));
  Result<void> done = apart.follow(trajectory, mode, kRest);
  show_.set_filming(true);
  if (!done) return fail(std::move(done.error()));
  MeasuredRun run{.rows = {}, .curve = &curve};
  for (std::size_t i = 0; i < apart.recorder().size(); ++i) {
    run.rows.push_back(apart.recorder().row(i));
  }
  return run;
}

void Stage::tell_servos(const Trajectory& motion) const {
  const std::optional<BeyondServo> beyond = beyond_servo(robot_.arm, motion);
  if (beyond) log_warning(describe(*beyond, robot_.arm));
}

void Stage::tell(const ToolMotion& motion, Report& report) const {
  tell_servos(motion.trajectory);
  add_motion(motion, robot_.arm, report);
  for (const SpeedDip& dip : motion.dips) log_info(describe(dip, robot_.arm));
}

Result<void> Stage::save_comparison(const render::Plot& page) const {
  const std::filesystem::path stem = options_.out / "comparison";
  log_info(text(msg::show_compared, stem.string() + ".png"));
  return render::save_plot(page, stem);
}

Result<Report> Stage::finish(Report begun, double tolerance) {
  const std::vector<MeasuredRun> runs = run_.measured_runs();
  return finish(run_.report(runs, tolerance, std::move(begun)), tolerance, runs);
}

Result<Report> Stage::finish(Report report, double tolerance, std::span<const MeasuredRun> runs) {
  render::Plot plot = run_plot(name_, control_, report, robot_.arm, {runs, run_.ink()}, tolerance);
  return write(std::move(report), std::move(plot));
}

Result<Report> Stage::write(Report report, render::Plot plot) {
  report.name = name_;
  tell_moved(report.held);
  if (report.control.empty()) report.control = control_;
  if (options_.timing && !show_.has_window() && !show_.is_filming() && wall_seconds_ > 0) {
    report.rtf = run_.outcome().duration / wall_seconds_;
  }
  const RunOutput output{report, std::move(plot), show_.overlay(), camera(), show_.is_filming()};
  auto written = run_.recorder().write_csv(options_.out / "log.csv").and_then([&] {
    return write_output(options_.out, robot_.model, run_.sim().snapshot(), output);
  });
  if (written)
    written = show_.end_record(robot_.model, run_.sim().snapshot(), output, options_.record);
  if (written) written = show_.end_film();
  if (!written) return fail(std::move(written.error()));
  // Before a window it is the user who takes the time.
  if (!show_.has_window()) folder_->made();
  show_.linger(run_.sim());
  return report;
}

Result<Report> Stage::refuse(std::string_view reason, const std::string& detail, Report report) {
  report.model = robot_.model.name();
  report.ok = false;
  report.reason = reason;
  report.detail = detail;
  return write(std::move(report), {});
}

Result<Report> Stage::refuse(const MotionFailure& failure) {
  return refuse(failure.path ? mjarm::name(failure.path->code) : "timing",
                describe(failure, robot_.arm));
}

}  // namespace mjarm::session
