#include "mjarm/path/ellipse.hpp"

#include "apps/mjarm/demos/demos.hpp"
#include "apps/mjarm/demos/stage.hpp"
#include "apps/mjarm/demos/tutorial.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/demo.hpp"
#include "mjarm/path/path_fix.hpp"

namespace mjarm::app {
namespace {

constexpr int kPoints = 200;

Ellipse the_ellipse(bool guide) {
  Ellipse ellipse;
  ellipse.center = {0, guide ? -0.2 : -0.3, 0.5};
  ellipse.a = 0.3;
  ellipse.b = 0.15;
  ellipse.R = tool_down();
  return ellipse;
}

/// Says which points cannot be reached, why, and which shift of the whole curve mends it.
Result<Report> refuse(Stage& stage, std::span<const Pose> points,
                      std::span<const UnreachableRange> ranges) {
  Report report;
  std::string detail;
  for (const UnreachableRange& range : ranges) {
    for (std::size_t i = range.first; i <= range.last; ++i) report.unreachable.push_back(i);
    if (!detail.empty()) detail += "; ";
    detail += text(msg::demo_points_unreachable, range.first, range.last, points.size(),
                   describe(range.worst, stage.arm()));
  }
  const auto shift = find_shift(stage.ik(), points, view(stage.arm().home));
  if (shift) {
    report.shift = *shift;
    detail += "; " + text(msg::demo_shift_mends, shift->x(), shift->y(), shift->z());
  } else {
    detail += "; " + text(msg::demo_no_shift);
  }
  return stage.refuse(name(ranges.front().worst.code), detail, std::move(report));
}

}  // namespace

Result<Report> run_ellipse(const DemoOptions& options) {
  Result<std::unique_ptr<Stage>> opened = Stage::open("ellipse", options);
  if (!opened) return fail(std::move(opened.error()));
  Stage& stage = **opened;

  const Ellipse ellipse = the_ellipse(options.guide);
  const Result<Curve> curve = Curve::ellipse(ellipse);
  if (!curve) return fail(curve.error());
  const std::vector<Pose> points = ellipse_points(ellipse, kPoints);
  stage.show().add_points(points, 2);
  const std::span<const double> home = view(stage.arm().home);
  const std::vector<UnreachableRange> ranges = unreachable_ranges(stage.reach(), points, home);
  if (!ranges.empty()) return refuse(stage, points, ranges);

  const Result<JointPath, PathFailure> path = solve_path(stage.ik(), points, home);
  if (!path) return stage.refuse({.path = path.error(), .timing = {}});
  const Result<ToolMotion, MotionFailure> motion =
      plan_tool_motion(stage.ik(), *curve, view(path->q.front()), {.path = {.keep_start = true}});
  if (!motion) return stage.refuse(motion.error());
  log_info(text(msg::demo_plan, curve->length(), motion->trajectory.duration(), path->max_step()));

  Report report;
  report.max_joint_step = path->max_step();
  stage.tell(*motion, report);
  const ControlMode mode = stage.control(ControlMode::computed_torque);
  if (auto done = stage.approach(view(motion->path.q.front()), mode); !done) {
    return fail(std::move(done.error()));
  }
  if (auto done = stage.run(motion->trajectory, mode, 0.3, &*curve); !done) {
    return fail(std::move(done.error()));
  }
  return stage.finish(std::move(report));
}

}  // namespace mjarm::app
