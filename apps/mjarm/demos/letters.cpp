#include "mjarm/path/letters.hpp"

#include "apps/mjarm/demos/demos.hpp"
#include "apps/mjarm/demos/stage.hpp"
#include "apps/mjarm/demos/tutorial.hpp"

namespace mjarm::app {
namespace {

constexpr double kPlane = -0.2;       // [m] y of the plane written on, as the tutorial's
constexpr double kHeight = 0.2;       // [m] of a letter, as the tutorial's
constexpr double kWidest = 0.7;       // [m] of a line of text
constexpr double kTextPlane = -0.5;   // [m] y of the plane for longer texts, where the arm has room
constexpr double kTextBottom = 0.35;  // [m]

using Line = std::vector<Pose>;

Line line(std::initializer_list<Eigen::Vector3d> points) {
  Line out;
  for (const Eigen::Vector3d& p : points) out.push_back({p, tool_down()});
  return out;
}

/// The tutorial's L and Z.
std::vector<Line> tutorial_letters() {
  const Eigen::Vector3d top_left(0.3, kPlane, 0.4), top_right(0.5, kPlane, 0.4);
  const Eigen::Vector3d bottom_left(0.3, kPlane, 0.2), bottom_right(0.5, kPlane, 0.2);
  return {line({top_left, bottom_left, bottom_right}),
          line({top_left, top_right, bottom_left, bottom_right})};
}

/// `text` upright in front of the arm, centred, smaller where it would get too wide.
Result<std::vector<Line>> written(const std::string& text) {
  const auto flat = letter_strokes(text, 1);
  if (!flat) return fail(flat.error());
  double width = 0;
  for (const Stroke& points : *flat) {
    for (const Eigen::Vector2d& p : points) width = std::max(width, p.x());
  }
  const double scale = std::min(kHeight, kWidest / std::max(width, 1e-9));
  std::vector<Line> strokes;
  for (const Stroke& points : *flat) {
    Line& out = strokes.emplace_back();
    for (const Eigen::Vector2d& p : points) {
      out.push_back(
          {{scale * (p.x() - width / 2), kTextPlane, kTextBottom + scale * p.y()}, tool_down()});
    }
  }
  return strokes;
}

}  // namespace

Result<Report> run_letters(const DemoOptions& options) {
  const Result<std::vector<Line>> strokes =
      options.text.empty() ? tutorial_letters() : written(options.text);
  if (!strokes) return fail(strokes.error());
  Result<std::unique_ptr<Stage>> opened = Stage::open("letters", options);
  if (!opened) return fail(std::move(opened.error()));
  Stage& stage = **opened;
  stage.set_camera("front");
  const ControlMode mode = stage.control(ControlMode::computed_torque);

  std::vector<Curve> curves;
  std::vector<ToolMotion> motions;
  JointVec q = stage.arm().home;
  Report report;
  for (const Line& points : *strokes) {
    const Result<Curve> curve = Curve::polyline(points);
    if (!curve) return fail(curve.error());
    stage.show().add_line(points);
    Result<ToolMotion, MotionFailure> motion = plan_tool_motion(stage.ik(), *curve, view(q));
    if (!motion) return stage.refuse(motion.error());
    q = motion->path.q.back();
    stage.tell(*motion, report);
    motions.push_back(std::move(*motion));
  }
  for (const ToolMotion& motion : motions) {
    if (auto done = stage.approach(view(motion.path.q.front()), mode); !done) {
      return fail(std::move(done.error()));
    }
    if (auto done = stage.run(motion.trajectory, mode, 0.2, &motion.curve); !done) {
      return fail(std::move(done.error()));
    }
  }
  return stage.finish(std::move(report));
}

}  // namespace mjarm::app
