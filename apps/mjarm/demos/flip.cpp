#include "apps/mjarm/demos/comparison.hpp"
#include "apps/mjarm/demos/demo_stage.hpp"
#include "apps/mjarm/demos/demos.hpp"
#include "apps/mjarm/demos/naive.hpp"
#include "apps/mjarm/demos/tutorial.hpp"
#include "apps/mjarm/messages/demo.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/units.hpp"
#include "mjarm/render/fonts.hpp"

namespace mjarm::app {
namespace {

constexpr double kFlipSpeed = 0.25;  // [m/s]
constexpr double kFlipStep = 0.5;    // [rad] between poses 2 mm apart

Pose flip_pose(double x) { return {{x, -0.4, 0.5}, tool_down()}; }

/// What the naive choice does to the line, for people and for the report.
void tell_naive(const NaiveMotion& naive, const MeasuredRun& run, const Arm& arm, Report& report) {
  const double off = largest_distance(run);
  if (naive.flip) {
    const std::string& joint = arm.joints[static_cast<std::size_t>(naive.flip->joint)].name;
    report.facts = {{"naive_reason", "branch_flip"},
                    {"naive_fraction", naive.flip->fraction},
                    {"naive_joint", joint},
                    {"naive_joint_step", naive.flip->jump},
                    {"naive_path_error_max", off}};
    log_info(text(msg::demo_flip_naive, 100 * naive.flip->fraction, joint,
                  kDegPerRad * naive.flip->jump, 1e3 * off));
  } else if (naive.fraction < 1) {
    report.facts = {{"naive_reason", "stops"}, {"naive_fraction", naive.fraction}};
    log_info(text(msg::demo_flip_stops, 100 * naive.fraction));
  } else {
    log_info(text(msg::demo_flip_no_flip));
  }
}

}  // namespace

Result<Report> run_flip(const DemoOptions& options) {
  Result<std::unique_ptr<session::Stage>> opened = open_stage("flip", options, 6);
  if (!opened) return fail(std::move(opened.error()));
  session::Stage& stage = **opened;
  const IkSolver ik = free_solver(stage.robot());
  const Result<Curve> line = Curve::line(flip_pose(-0.1), flip_pose(0.6));
  if (!line) return fail(line.error());
  stage.show().add_line(std::vector<Pose>{line->at(0), line->at(line->end())});
  const JointVec home = stage.arm().home;
  const Result<NaiveMotion> naive =
      naive_motion(ik, *line, as_span(home), kFlipSpeed, 0.008, kFlipStep);
  if (!naive) return fail(naive.error());
  const Result<ToolMotion, MotionFailure> motion =
      plan_tool_motion(ik, *line, as_span(home), {.timing = {.tool_speed = kFlipSpeed}});
  if (!motion) return stage.refuse(motion.error());

  const ControlMode mode = stage.control(ControlMode::computed_torque);
  const Result<MeasuredRun> naive_run = stage.rehearse(naive->trajectory, mode, *line);
  if (!naive_run) return fail(naive_run.error());
  stage.run().start_at(as_span(home));
  const Result<void> done = stage.move([&](MotionRun& run) {
    return run.approach(as_span(motion->path.q.front()), mode).and_then([&] {
      return run.follow(motion->trajectory, mode, 0.3, &*line);
    });
  });
  if (!done) return fail(done.error());

  Report report;
  stage.tell(*motion, report);
  const std::vector<MeasuredRun> runs = stage.run().measured_runs();
  if (runs.empty()) return stage.finish(std::move(report));  // stopped on the way to the line
  tell_naive(*naive, *naive_run, stage.arm(), report);
  log_info(text(msg::demo_flip_ours, report.max_joint_step));
  constexpr Chart kCharts[] = {Chart::joints, Chart::front, Chart::error};
  const std::string note =
      naive->flip ? render::picture_text(msg::demo_flip_note, 100 * naive->flip->fraction,
                                         1e3 * largest_distance(*naive_run),
                                         1e3 * largest_distance(runs.back()))
                  : std::string();
  const ComparedRun compared[] = {{render::picture_text(msg::demo_naive), *naive_run},
                                  {render::picture_text(msg::demo_ours), runs.back()}};
  auto saved = stage.save_comparison(comparison_plot(
      {render::picture_text(msg::demo_flip_title), note}, stage.arm(), compared, kCharts));
  if (!saved) return fail(std::move(saved.error()));
  return stage.finish(std::move(report));
}

}  // namespace mjarm::app
