#include "mjarm/path/ellipse.hpp"

#include <variant>

#include "apps/mjarm/demos/demo_stage.hpp"
#include "apps/mjarm/demos/demos.hpp"
#include "apps/mjarm/demos/program_demo.hpp"
#include "apps/mjarm/messages/demo.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/path/path_fix.hpp"

namespace mjarm::app {
namespace {

constexpr int kPoints = 200;
constexpr double kGuideY = -0.2;  // [m] of the tutorial's centre, part of whose ellipse is too near

/// Says which points cannot be reached, why, and which shift of the whole curve mends it.
Result<Report> refuse(session::Stage& stage, std::span<const Pose> points,
                      std::span<const UnreachableRange> ranges) {
  Report report;
  std::string detail;
  for (const UnreachableRange& range : ranges) {
    for (std::size_t i = range.first; i <= range.last; ++i) report.unreachable.push_back(i);
    stage.show().add_unreachable(points.subspan(range.first, range.last - range.first + 1));
    if (!detail.empty()) detail += text(msg::core_semicolon);
    detail += text(msg::demo_points_unreachable, range.first, range.last, points.size(),
                   describe(range.worst, stage.arm()));
  }
  const auto shift = find_shift(free_solver(stage.robot()), points, as_span(stage.arm().home));
  if (shift) {
    report.shift = *shift;
    detail +=
        text(msg::core_semicolon) + text(msg::demo_shift_mends, shift->x(), shift->y(), shift->z());
  } else {
    detail += text(msg::core_semicolon) + text(msg::demo_no_shift);
  }
  return stage.refuse(name(ranges.front().worst.code), detail, std::move(report));
}

}  // namespace

Result<Report> run_ellipse(const DemoOptions& options) {
  Result<program::Program> program = demo_program("ellipse");
  if (!program) return fail(std::move(program.error()));
  auto* drawn = std::get_if<program::DrawEllipse>(&program->instructions.front().what);
  if (drawn == nullptr) return fail(Errc::bad_input, text(msg::demo_no_ellipse));
  if (options.guide) drawn->center.y() = kGuideY;
  const DemoValues& values = options.values;
  drawn->center = values.center.value_or(drawn->center);
  drawn->normal = values.normal.value_or(drawn->normal);
  drawn->a = values.a.value_or(drawn->a);
  drawn->b = values.b.value_or(drawn->b);
  drawn->R_FT = values.R.value_or(drawn->R_FT);
  const Ellipse ellipse{drawn->center, drawn->a, drawn->b, drawn->normal, drawn->R_FT};
  const Result<program::LoadedProgram> loaded = plan_demo(std::move(*program), options);
  if (!loaded) return fail(loaded.error());
  if (loaded->plan.ok()) return run_demo_plan(*loaded, options);

  Result<std::unique_ptr<session::Stage>> stage =
      session::Stage::open("ellipse", options, loaded->robot);
  if (!stage) return fail(std::move(stage.error()));
  const std::vector<Pose> points = ellipse_points(ellipse, kPoints);
  (*stage)->show().add_points(points, 2);
  const std::vector<UnreachableRange> ranges = unreachable_ranges(
      reach_solver(loaded->robot), points, as_span(loaded->robot.arm.home), interrupted);
  if (!ranges.empty()) return refuse(**stage, points, ranges);
  return (*stage)->refuse(loaded->plan.faults.front().reason, program::first_fault(*loaded).what);
}

}  // namespace mjarm::app
