// What robots, plans and motions look like, in notebooks too.
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>

#include <cmath>
#include <optional>
#include <utility>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/messages/run_charts.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/render/fonts.hpp"
#include "mjarm/render/offscreen.hpp"
#include "mjarm/render/overlay_shapes.hpp"
#include "mjarm/render/plot.hpp"
#include "mjarm/session/motion_view.hpp"
#include "python/src/bindings.hpp"
#include "python/src/convert.hpp"
#include "python/src/images.hpp"
#include "python/src/outcomes.hpp"
#include "python/src/robot.hpp"

namespace mjarm::python {
namespace {

using File = std::optional<std::filesystem::path>;

/// The arm at the last of `postures`, all of which are in the picture, with the way of its tool.
Result<render::Image> draw_arm(const Robot& robot, const std::vector<JointVec>& postures, int width,
                               int height) {
  Result<render::OffscreenRenderer> renderer = render::OffscreenRenderer::create(
      robot.model, {.width = width, .height = height, .supersampling = 2});
  if (!renderer) return fail(std::move(renderer.error()));
  Sim sim(robot.model);
  sim.reset_home();
  sim.place(robot.arm, as_span(postures.back()));
  render::Overlay overlay;
  constexpr int kPieces = 30;  // of an edge
  std::vector<Pose> way;
  for (std::size_t i = 0; i + 1 < postures.size(); ++i) {
    for (int k = 0; k <= kPieces; ++k) {
      const JointVec q = postures[i] + (postures[i + 1] - postures[i]) * k / kPieces;
      way.push_back(fk(robot.arm, as_span(q)));
    }
  }
  if (!way.empty()) render::add_planned_path(overlay, way);
  session::MotionOutline outline{.postures = postures};
  for (const Pose& X : way) outline.marks_W.push_back(X.p);
  const render::CameraView view =
      session::motion_view(robot.model, robot.arm, outline, false, 1.0 * width / height);
  return renderer->draw(sim.snapshot(), {.view = view}, overlay);
}

nb::object picture_of_robot(const BoundRobot& robot, nb::handle q, const File& file, int width,
                            int height) {
  check_pixels(width, height);
  const JointVec posture = robot.joints_or_home(q, "q");
  auto image = [&] {
    const nb::gil_scoped_release free;
    return draw_arm(robot.robot, {posture}, width, height);
  }();
  return give(value_of(std::move(image)), file);
}

/// For a notebook: nothing on machines that cannot draw.
nb::object shown_arm(const Robot& robot, const std::vector<JointVec>& postures) {
  constexpr int kWidth = 640, kHeight = 360;
  const auto image = draw_arm(robot, postures, kWidth, kHeight);
  return image ? nb::object(png_of(*image)) : nb::none();
}

/// Joint values and speeds over time.
render::Plot chart_of(const PlannedMove& move) {
  constexpr int kSamples = 400;
  const LanguageScope drawn(render::picture_language());
  const Trajectory& motion = move.trajectory;
  render::Plot page{.title = move.word};
  render::PlotPanel q{.x_label = text(msg::run_chart_time), .y_label = "q [rad, m]"};
  render::PlotPanel v{.x_label = text(msg::run_chart_time), .y_label = "v [rad/s, m/s]"};
  for (int joint = 0; joint < motion.dof(); ++joint) {
    render::PlotLine position{.label = "q" + std::to_string(joint + 1), .color = joint};
    render::PlotLine speed{.color = joint};
    for (int i = 0; i <= kSamples; ++i) {
      const double t = motion.duration() * i / kSamples;
      const JointState state = motion.at(t);
      position.x.push_back(t);
      speed.x.push_back(t);
      position.y.push_back(state.q[joint]);
      speed.y.push_back(state.v[joint]);
    }
    q.lines.push_back(std::move(position));
    v.lines.push_back(std::move(speed));
  }
  page.panels = {std::move(q), std::move(v)};
  return page;
}

}  // namespace

void bind_pictures(nb::module_& m) {
  auto robot = nb::borrow<nb::class_<BoundRobot>>(m.attr("Robot"));
  robot
      .def("picture", &picture_of_robot, nb::arg("q").none() = nb::none(),
           nb::arg("file") = nb::none(), nb::kw_only(), nb::arg("width") = 1280,
           nb::arg("height") = 720,
           nb::sig(
               "def picture(self, q: ArrayLike | None = None, file: str | os.PathLike[str] | None "
               "= None, *, width: int = 1280, height: int = 720) -> bytes | None"),
           "The robot in its scene at `q` [rad or m], (dof,); default: at home. PNG as bytes, or "
           "written to a file.")
      .def("_repr_png_", [](const BoundRobot& r) { return shown_arm(r.robot, {r.arm().home}); });
  auto plan = nb::borrow<nb::class_<BoundPlan>>(m.attr("Plan"));
  plan.def("_repr_png_", [](const BoundPlan& p) { return shown_arm(p.robot, p.path.q); });
  auto motion = nb::borrow<nb::class_<PlannedMove>>(m.attr("Motion"));
  motion
      .def(
          "plot",
          [](const PlannedMove& move, const File& file) { return give(chart_of(move), file); },
          nb::arg("file") = nb::none(),
          nb::sig("def plot(self, file: str | os.PathLike[str] | None = None) -> bytes | None"),
          "Joint values and speeds over time: PNG as bytes, or written to a .png or .svg file.")
      .def("_repr_png_", [](const PlannedMove& move) { return give(chart_of(move), {}); });
}

}  // namespace mjarm::python
