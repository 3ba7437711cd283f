#include <numbers>

#include "apps/mjarm/demos/comparison.hpp"
#include "apps/mjarm/demos/demos.hpp"
#include "apps/mjarm/demos/naive.hpp"
#include "apps/mjarm/demos/stage.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/demo.hpp"
#include "mjarm/core/rotation.hpp"

namespace mjarm::app {
namespace {

constexpr double kSpeed = 0.25;  // [m/s]
constexpr double kDip = 2 * std::numbers::pi / 180;

/// The tool points along the line, 2 degrees below it: half way its axis all but meets that of the
/// wrist's first joint.
Pose pose_at(double x) {
  return {{x, -0.45, 0.45}, rotation_exp({0, std::numbers::pi / 2 + kDip, 0})};
}

}  // namespace

Result<Report> run_singularity(const DemoOptions& options) {
  Result<std::unique_ptr<Stage>> opened = Stage::open("singularity", options, 6);
  if (!opened) return fail(std::move(opened.error()));
  Stage& stage = **opened;
  const Result<Curve> line = Curve::line(pose_at(-0.25), pose_at(0.35));
  if (!line) return fail(line.error());
  stage.show().add_line(std::vector<Pose>{line->at(0), line->at(line->end())});
  const Result<ToolMotion, MotionFailure> motion = plan_tool_motion(
      stage.ik(), *line, view(stage.arm().home), {.timing = {.tool_speed = kSpeed}});
  if (!motion) return stage.refuse(motion.error());
  // The same answers from the same start, so that the timing alone makes the difference.
  const JointVec& q_start = motion->path.q.front();
  const Result<NaiveMotion> naive = naive_motion(stage.reach(), *line, view(q_start), kSpeed);
  if (!naive) return fail(naive.error());

  const ControlMode mode = stage.control(ControlMode::computed_torque);
  const Result<MeasuredRun> naive_run = stage.rehearse(naive->trajectory, mode, *line);
  if (!naive_run) return fail(naive_run.error());
  stage.start_at(view(q_start));
  if (auto done = stage.run(motion->trajectory, mode, 0.3, &*line); !done) {
    return fail(std::move(done.error()));
  }

  Report report;
  report.max_joint_step = motion->path.max_step();
  const std::vector<MeasuredRun> runs = stage.measured_runs();
  const MeasuredRun& ours = runs.back();
  const PeakSpeed whip = peak_speed(*naive_run), calm = peak_speed(ours);
  const std::string& joint = stage.arm().joints[static_cast<std::size_t>(whip.joint)].name;
  const double off = largest_distance(*naive_run);
  report.facts = {{"peak_joint_speed", calm.speed},
                  {"naive_peak_joint_speed", whip.speed},
                  {"naive_peak_joint", joint},
                  {"naive_path_error_max", off}};
  const double limit = stage.arm().limits.velocity[whip.joint];
  log_info(text(msg::demo_singularity_naive, joint, whip.speed, limit, 1e3 * off));
  log_info(text(msg::demo_singularity_ours, calm.speed, motion->trajectory.duration(),
                naive->trajectory.duration()));
  const std::string note = text(msg::demo_singularity_note, joint, whip.speed, limit, 1e3 * off,
                                calm.speed, 1e3 * largest_distance(ours));
  constexpr Chart kCharts[] = {Chart::joint_speeds, Chart::tool_speed, Chart::error};
  auto saved = stage.save_comparison(comparison_plot({text(msg::demo_singularity_title), note},
                                                     stage.arm(), *naive_run, ours, kCharts));
  if (!saved) return fail(std::move(saved.error()));
  return stage.finish(std::move(report));
}

}  // namespace mjarm::app
