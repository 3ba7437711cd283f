#include <array>
#include <cmath>
#include <numbers>

#include "apps/mjarm/demos/demos.hpp"
#include "apps/mjarm/messages/demo.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/run_charts.hpp"
#include "mjarm/core/number.hpp"
#include "mjarm/core/output_folder.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/install/installed.hpp"
#include "mjarm/render/fonts.hpp"
#include "mjarm/session/run_output.hpp"
#include "mjarm/session/run_show.hpp"

namespace mjarm::app {
namespace {

// Rows of ctrl and qpos in models/car.xml: a free joint (7), then the wheels.
constexpr std::size_t kForward = 0;
constexpr std::size_t kTurn = 1;
constexpr std::size_t kWheels = 7;

struct Phase {
  Msg label;
  double seconds;
  double forward;  ///< ctrl
  double turn;     ///< ctrl
};
constexpr std::array kPhases = {Phase{msg::demo_car_forward, 3.0, 0.6, 0.0},
                                Phase{msg::demo_car_turn, 2.0, 0.2, 0.5}};

/// What was measured on the way.
struct Drive {
  std::vector<double> time;
  std::vector<Eigen::Vector3d> p_W;
  std::vector<double> left, right;  ///< [N m] sensors
  double max_wheel_step = 0;        ///< [rad]
  std::size_t straight = 0;         ///< samples before the turn
  bool ended_by_user = false;
};

Eigen::Vector3d position(const Sim& sim) { return {sim.qpos()[0], sim.qpos()[1], sim.qpos()[2]}; }

double heading(const Sim& sim) {
  const Quat q(sim.qpos()[3], sim.qpos()[4], sim.qpos()[5], sim.qpos()[6]);
  return to_euler(to_matrix(q)).z();
}

void sample(const Sim& sim, Drive& drive) {
  drive.time.push_back(sim.time());
  drive.p_W.push_back(position(sim));
  drive.left.push_back(sim.sensor_data()[0]);
  drive.right.push_back(sim.sensor_data()[1]);
}

Result<void> drive_phase(const Phase& phase, double max_seconds, Sim& sim, session::RunShow& show,
                         Drive& drive) {
  std::array<double, 2> ctrl{};
  ctrl[kForward] = phase.forward;
  ctrl[kTurn] = phase.turn;
  const double end = std::min(sim.time() + phase.seconds, max_seconds);
  while (sim.time() < end - 1e-9 && !drive.ended_by_user) {
    const std::array<double, 2> before = {sim.qpos()[kWheels], sim.qpos()[kWheels + 1]};
    if (auto done = sim.step(ctrl); !done) return done;
    for (std::size_t wheel = 0; wheel < 2; ++wheel) {
      const double step = std::abs(sim.qpos()[kWheels + wheel] - before[wheel]);
      drive.max_wheel_step = std::max(drive.max_wheel_step, step);
    }
    sample(sim, drive);
    drive.ended_by_user = !show.step(sim, position(sim));
  }
  const Eigen::Vector3d p = position(sim);
  log_info(text(msg::demo_car_state, text(phase.label), sim.time(), p.x(), p.y(),
                heading(sim) * 180 / std::numbers::pi, drive.left.back(), drive.right.back()));
  return {};
}

std::string to_csv(const Drive& drive) {
  std::string csv = "time [s],x [m],y [m],z [m],left_torque [N m],right_torque [N m]\n";
  for (std::size_t i = 0; i < drive.time.size(); ++i) {
    const Eigen::Vector3d& p = drive.p_W[i];
    for (const double value : {drive.time[i], p.x(), p.y(), p.z(), drive.left[i]}) {
      csv += number(value) + ",";
    }
    csv += number(drive.right[i]) + "\n";
  }
  return csv;
}

render::Plot plot_of(const Drive& drive) {
  const LanguageScope drawn(render::picture_language());
  render::PlotPanel path{.title = text(msg::run_chart_car), .x_label = "x [m]", .y_label = "y [m]"};
  path.equal_aspect = true;
  render::PlotLine line;
  for (const Eigen::Vector3d& p : drive.p_W) {
    line.x.push_back(p.x());
    line.y.push_back(p.y());
  }
  path.lines.push_back(std::move(line));
  render::PlotPanel torque{.title = text(msg::demo_plot_sensors),
                           .x_label = text(msg::run_chart_time),
                           .y_label = "N m",
                           .over_time = true};
  torque.lines.push_back({.x = drive.time, .y = drive.left, .label = "left_torque"});
  torque.lines.push_back({.x = drive.time, .y = drive.right, .label = "right_torque"});
  return {.title = "car", .panels = {std::move(path), std::move(torque)}};
}

/// Straight ahead is measured against the x axis; turning by the change of heading.
Report report_of(const Drive& drive, const Sim& sim) {
  Report report;
  report.name = "car";
  report.model = sim.model().name();
  report.duration = sim.time();
  report.steps = static_cast<long>(drive.time.size());
  report.max_joint_step = drive.max_wheel_step;
  for (const Phase& phase : kPhases) {
    report.torque_use = std::max({report.torque_use, phase.forward, phase.turn});
  }
  const std::span<const Eigen::Vector3d> straight(drive.p_W.data(), drive.straight);
  if (straight.empty()) return report;
  Pose from, to;
  from.p = straight.front();
  to.p = from.p + Eigen::Vector3d((straight.back() - from.p).x(), 0, 0);
  if (const auto line = Curve::line(from, to); line && line->length() > 0) {
    report.path_error = path_error(*line, straight, 0.01);
    report.done = report.path_error->coverage;
  }
  const double turned = std::abs(heading(sim));
  report.ok = to.p.x() > 0.5 && turned > 0.5 && report.path_error && report.path_error->max < 0.01;
  if (!report.ok) {
    report.reason = "not_driven";
    report.detail = text(msg::demo_car_failed, to.p.x(), turned * 180 / std::numbers::pi);
  }
  return report;
}

}  // namespace

Result<Report> run_car(const DemoOptions& options) {
  const auto model =
      (options.meshes ? install::find_mesh_scene("car") : find_model_file("car"))
          .and_then([](const std::filesystem::path& file) { return Model::load(file); });
  if (!model) return fail(model.error());
  const Result<OutputFolder> folder = OutputFolder::open(options.out, options.replace);
  if (!folder) return fail(folder.error());
  Sim sim(*model);
  Result<session::RunShow> show = session::RunShow::open(*model, "mjarm car", options.headless);
  if (!show) return fail(std::move(show.error()));
  show->set_pen(render::Pen::down);
  if (options.record) show->record(sim);
  if (options.video) {
    auto filming =
        show->film(*model, options.out / session::kVideoFile, session::default_camera(*model));
    if (!filming) return fail(std::move(filming.error()));
  }

  Drive drive;
  const double max = options.seconds > 0 ? options.seconds : 1e9;
  for (const Phase& phase : kPhases) {
    if (auto done = drive_phase(phase, max, sim, *show, drive); !done) {
      return fail(std::move(done.error()));
    }
    if (phase.turn == 0) drive.straight = drive.time.size();
  }
  Report report = report_of(drive, sim);
  const session::RunOutput output{report, plot_of(drive), show->overlay(),
                                  session::default_camera(*model), show->is_filming()};
  auto written = write_file(options.out / "log.csv", to_csv(drive))
                     .and_then([&] {
                       return session::write_output(options.out, *model, sim.snapshot(), output);
                     })
                     .and_then([&] {
                       return show->end_record(*model, sim.snapshot(), output, options.record);
                     })
                     .and_then([&] { return show->end_film(); });
  if (!written) return fail(std::move(written.error()));
  if (!show->has_window()) folder->made();
  show->linger(sim);
  return report;
}

}  // namespace mjarm::app
