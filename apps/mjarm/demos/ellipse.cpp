#include <cmath>

#include "demos/demos.hpp"
#include "demos/stage.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/path/joint_path.hpp"
#include "mjarm/program/motion.hpp"

namespace mjarm::app {
namespace {

constexpr int kPoints = 200;

Ellipse the_ellipse(bool guide) {
  Ellipse ellipse;
  ellipse.center = {0, guide ? -0.2 : -0.3, 0.5};
  ellipse.a = 0.3;
  ellipse.b = 0.15;
  ellipse.R = from_euler({3.14, 0, 0});
  return ellipse;
}

/// Says which points cannot be reached, why, and which shift of the whole curve mends it.
Report refuse(const Stage& stage, std::span<const Pose> points,
              std::span<const UnreachableRange> ranges) {
  Report report;
  for (const UnreachableRange& range : ranges) {
    const std::string why = describe(range.worst, stage.arm());
    log_info(text(Msg::app_points_unreachable, range.first, range.last, points.size(), why));
    report.reason = name(range.worst.code);
    report.detail = why;
    for (std::size_t i = range.first; i <= range.last; ++i) report.unreachable.push_back(i);
  }
  report.coverage = 0;
  if (const auto shift = find_shift(stage.ik(), points, view(stage.arm().home))) {
    report.shift = *shift;
    log_info(text(Msg::app_shift_mends, shift->x(), shift->y(), shift->z()));
  } else {
    log_info(text(Msg::app_no_shift_mends));
  }
  return report;
}

}  // namespace

Result<Report> run_ellipse(const DemoOptions& options) {
  Result<std::unique_ptr<Stage>> opened = Stage::open("ellipse", options);
  if (!opened) return fail(std::move(opened.error()));
  Stage& stage = **opened;

  const Ellipse ellipse = the_ellipse(options.guide);
  const std::vector<Pose> points = ellipse_points(ellipse, kPoints);
  stage.show_points(points, 2);
  const std::vector<UnreachableRange> ranges =
      unreachable_ranges(stage.ik(), points, view(stage.arm().home));
  if (!ranges.empty()) return stage.finish(refuse(stage, points, ranges), {});

  const Result<Curve> curve = Curve::ellipse(ellipse);
  if (!curve) return fail(curve.error());
  const Result<ToolMotion, MotionFailure> motion =
      plan_tool_motion(stage.ik(), *curve, view(stage.arm().home), {});
  if (!motion) return stage.finish(stage.refusal(motion.error()), {});
  Report report;
  report.max_joint_step = step_between(motion->path, *curve, kPoints);

  const ControlMode mode = options.control.value_or(ControlMode::computed_torque);
  if (auto done = stage.approach(view(motion->path.q.front()), mode); !done) {
    return fail(std::move(done.error()));
  }
  if (auto done = stage.draw(*motion, mode); !done) return fail(std::move(done.error()));
  return stage.finish(report, {.curve = *curve});
}

}  // namespace mjarm::app
