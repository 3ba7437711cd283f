#include <iterator>
#include <numbers>
#include <optional>

#include "apps/mjarm/demos/comparison.hpp"
#include "apps/mjarm/demos/demo_stage.hpp"
#include "apps/mjarm/demos/demos.hpp"
#include "apps/mjarm/demos/naive.hpp"
#include "apps/mjarm/messages/demo.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/core/units.hpp"
#include "mjarm/path/path_fix.hpp"
#include "mjarm/path/solve_curve.hpp"
#include "mjarm/render/fonts.hpp"

namespace mjarm::app {
namespace {

constexpr double kSpeed = 0.25;  // [m/s]
constexpr double kShare = 0.9;   // of the joint limits: a margin for the controller

/// The tool points along the line, 2 degrees below it: half way its axis all but meets that of the
/// wrist's first joint.
Pose pose_at(double x) {
  return {{x, -0.45, 0.45}, rotation_exp({0, std::numbers::pi / 2 + 2 * kRadPerDeg, 0})};
}

Result<Curve> line_with(const PathChange& change) {
  return Curve::line(change(pose_at(-0.25)), change(pose_at(0.35)));
}

Result<ToolMotion, MotionFailure> plan(const IkSolver& ik, const Curve& line,
                                       std::span<const double> q_start) {
  return plan_tool_motion(ik, line, q_start,
                          {.timing = {.tool_speed = kSpeed, .joint_share = kShare}});
}

/// Asks for the speed all along the line, and tells why it cannot be had and what mends that.
/// @return the turn of the tool that does, if one was found.
std::optional<PathFix> ask_for_speed(const IkSolver& ik, const Curve& line,
                                     std::span<const double> q_start, Report& report) {
  const CurveOptions asked{.path = {.tool_speed = kSpeed, .stop = interrupted}};
  const auto path = solve_curve(ik, line, q_start, asked);
  if (path) return std::nullopt;
  const PathFailure& failure = path.error();
  log_info(text(msg::demo_singularity_asked, kSpeed, describe(failure, ik.arm())));
  report.facts.push_back({"asked_reason", std::string(name(failure.code))});
  std::optional<PathFix> tilt;
  for (const PathFix& fix : find_fixes(ik, line, q_start, asked, failure, 2)) {
    log_info(text(msg::demo_singularity_mends, describe(fix)));
    if (fix.kind == FixKind::slower) report.facts.push_back({"slower", fix.tool_speed});
    if (fix.kind == FixKind::tilt) tilt = fix;
  }
  return tilt;
}

/// The same line with the tool turned, in a world apart.
Result<std::optional<MeasuredRun>> run_tilted(session::Stage& stage, const IkSolver& ik,
                                              const Curve& line, const PathFix& tilt,
                                              std::span<const double> q_start, ControlMode mode,
                                              Report& report) {
  const Result<Curve> turned = line_with(tilt.change);
  if (!turned) return fail(turned.error());
  const Result<ToolMotion, MotionFailure> motion = plan(ik, *turned, q_start);
  if (!motion) return std::optional<MeasuredRun>();
  Result<MeasuredRun> run = stage.rehearse(motion->trajectory, mode, line);
  if (!run) return fail(std::move(run.error()));
  const double angle = tilt.change.tilt.norm(), peak = peak_speed(*run).speed;
  report.facts.push_back({"tilt", angle});
  report.facts.push_back({"tilted_peak_joint_speed", peak});
  log_info(
      text(msg::demo_singularity_tilted, angle / kRadPerDeg, peak, motion->trajectory.duration()));
  return std::optional(std::move(*run));
}

/// What both did, for people and for the report. @return the note of the page.
std::string tell(const session::Stage& stage, const MeasuredRun& naive, const MeasuredRun& ours,
                 Report& report) {
  const PeakSpeed whip = peak_speed(naive), calm = peak_speed(ours);
  const std::string& joint = stage.arm().joints[static_cast<std::size_t>(whip.joint)].name;
  const double off = largest_distance(naive);
  const double limit = stage.arm().limits.velocity[whip.joint];
  const Fact facts[] = {{"peak_joint_speed", calm.speed},
                        {"naive_peak_joint_speed", whip.speed},
                        {"naive_peak_joint", joint},
                        {"naive_path_error_max", off}};
  report.facts.insert(report.facts.end(), std::begin(facts), std::end(facts));
  log_info(text(msg::demo_singularity_naive, joint, whip.speed, limit, 1e3 * off));
  return render::picture_text(msg::demo_singularity_note, joint, whip.speed, limit, 1e3 * off,
                              calm.speed, 1e3 * largest_distance(ours));
}

}  // namespace

Result<Report> run_singularity(const DemoOptions& options) {
  Result<std::unique_ptr<session::Stage>> opened = open_stage("singularity", options, 6);
  if (!opened) return fail(std::move(opened.error()));
  session::Stage& stage = **opened;
  const IkSolver ik = free_solver(stage.robot());
  const Result<Curve> line = line_with({});
  if (!line) return fail(line.error());
  stage.show().add_line(std::vector<Pose>{line->at(0), line->at(line->end())});
  const Result<ToolMotion, MotionFailure> motion = plan(ik, *line, as_span(stage.arm().home));
  if (!motion) return stage.refuse(motion.error());
  // The same answers from the same start, so that the timing alone makes the difference.
  const JointVec& q_start = motion->path.q.front();
  const Result<NaiveMotion> naive =
      naive_motion(reach_solver(stage.robot()), *line, as_span(q_start), kSpeed);
  if (!naive) return fail(naive.error());

  Report report;
  const ControlMode mode = stage.control(ControlMode::computed_torque);
  const Result<MeasuredRun> naive_run = stage.rehearse(naive->trajectory, mode, *line);
  if (!naive_run) return fail(naive_run.error());
  std::vector<ComparedRun> compared{{render::picture_text(msg::demo_naive), *naive_run}};
  stage.run().start_at(as_span(q_start));
  const Result<void> done =
      stage.move([&](MotionRun& run) { return run.follow(motion->trajectory, mode, 0.3, &*line); });
  if (!done) return fail(done.error());
  stage.tell(*motion, report);
  const std::vector<MeasuredRun> runs = stage.run().measured_runs();
  compared.push_back({render::picture_text(msg::demo_slows), runs.back()});
  const std::string note = tell(stage, *naive_run, runs.back(), report);
  log_info(text(msg::demo_singularity_ours, peak_speed(runs.back()).speed,
                motion->trajectory.duration(), naive->trajectory.duration()));
  if (const auto tilt = ask_for_speed(ik, *line, as_span(q_start), report)) {
    auto tilted = run_tilted(stage, ik, *line, *tilt, as_span(q_start), mode, report);
    if (!tilted) return fail(std::move(tilted.error()));
    if (*tilted) compared.push_back({render::picture_text(msg::demo_tilts), std::move(**tilted)});
  }

  constexpr Chart kCharts[] = {Chart::joint_speeds, Chart::tool_speed, Chart::error};
  auto saved = stage.save_comparison(comparison_plot(
      {render::picture_text(msg::demo_singularity_title), note}, stage.arm(), compared, kCharts));
  if (!saved) return fail(std::move(saved.error()));
  return stage.finish(std::move(report));
}

}  // namespace mjarm::app
