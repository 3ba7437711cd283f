#include "apps/mjarm/demos/charts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mjarm/core/messages.hpp"

namespace mjarm::app {
namespace {

constexpr std::size_t kMostPoints = 2000;  // more than that no page can show

std::size_t stride(std::span<const RecordRow> rows) {
  return std::max<std::size_t>(1, rows.size() / kMostPoints);
}

template <class Value>
std::vector<double> column(std::span<const RecordRow> rows, Value value) {
  std::vector<double> out;
  for (std::size_t i = 0; i < rows.size(); i += stride(rows)) out.push_back(value(rows[i]));
  return out;
}

std::vector<double> times(std::span<const RecordRow> rows) {
  return column(rows, [](const RecordRow& row) { return row.time; });
}

PlotPanel side_view(Msg title, std::span<const RecordRow> rows, int x, int y) {
  static constexpr const char* kAxes[] = {"x [m]", "y [m]", "z [m]"};
  PlotPanel panel;
  panel.title = text(title);
  panel.x_label = kAxes[x];
  panel.y_label = kAxes[y];
  panel.equal_aspect = true;
  const auto executed = [](int axis) {
    return [axis](const RecordRow& row) { return row.X_WT.p[axis]; };
  };
  const auto planned = [](int axis) {
    return [axis](const RecordRow& row) { return row.X_ref.p[axis]; };
  };
  panel.lines.push_back({.x = column(rows, executed(x)),
                         .y = column(rows, executed(y)),
                         .label = text(Msg::demo_plot_executed)});
  panel.lines.push_back({.x = column(rows, planned(x)),
                         .y = column(rows, planned(y)),
                         .label = text(Msg::demo_plot_planned),
                         .style = LineStyle::dashed,
                         .color = PlotLine::kInk});
  return panel;
}

PlotPanel error_panel(std::span<const RecordRow> rows) {
  PlotPanel panel;
  panel.title = text(Msg::demo_plot_error);
  panel.x_label = text(Msg::demo_plot_time);
  panel.y_label = text(Msg::demo_plot_error_unit);
  panel.y_from_zero = true;
  panel.lines.push_back({.x = times(rows), .y = column(rows, [&](const RecordRow& row) {
                           return 1e3 * (row.X_WT.p - row.X_ref.p).norm();
                         })});
  return panel;
}

PlotPanel joint_panel(const Arm& arm, std::span<const RecordRow> rows) {
  PlotPanel panel;
  panel.title = text(Msg::demo_plot_joints);
  panel.x_label = text(Msg::demo_plot_time);
  panel.y_label = text(Msg::demo_plot_joint_unit);
  for (int j = 0; j < arm.dof(); ++j) {
    panel.lines.push_back(
        {.x = times(rows),
         .y = column(rows, [j](const RecordRow& row) { return row.q[j]; }),
         .label = arm.joints[static_cast<std::size_t>(j)].name});
  }
  return panel;
}

PlotPanel limit_panel(const Arm& arm, std::span<const RecordRow> rows) {
  PlotPanel panel;
  panel.title = text(Msg::demo_plot_limits);
  panel.x_label = text(Msg::demo_plot_time);
  panel.y_label = text(Msg::demo_plot_share);
  panel.y_from_zero = true;
  const auto share = [&](auto part, const JointVec& limit) {
    return column(rows, [&](const RecordRow& row) {
      return 100 * (part(row).array().abs() / limit.array()).maxCoeff();
    });
  };
  panel.lines.push_back(
      {.x = times(rows),
       .y = share([](const RecordRow& row) -> const JointVec& { return row.v; },
                  arm.limits.velocity),
       .label = text(Msg::demo_plot_velocity)});
  panel.lines.push_back(
      {.x = times(rows),
       .y = share([](const RecordRow& row) -> const JointVec& { return row.torque; },
                  arm.limits.torque),
       .label = text(Msg::demo_plot_torque)});
  return panel;
}

PlotPanel speed_panel(std::span<const RecordRow> rows) {
  PlotPanel panel;
  panel.title = text(Msg::demo_plot_speed);
  panel.x_label = text(Msg::demo_plot_time);
  panel.y_label = "m/s";
  panel.y_from_zero = true;
  PlotLine line;
  const std::size_t step = stride(rows);
  for (std::size_t i = step; i < rows.size(); i += step) {
    const double dt = rows[i].time - rows[i - step].time;
    if (dt <= 0) continue;
    line.x.push_back(rows[i].time);
    line.y.push_back((rows[i].X_WT.p - rows[i - step].X_WT.p).norm() / dt);
  }
  panel.lines.push_back(std::move(line));
  return panel;
}

}  // namespace

Plot motion_plot(const std::string& title, const Arm& arm, std::span<const RecordRow> rows) {
  Plot plot;
  plot.title = title;
  plot.columns = 3;
  plot.panels = {side_view(Msg::demo_plot_top, rows, 0, 1),
                 side_view(Msg::demo_plot_front, rows, 0, 2),
                 side_view(Msg::demo_plot_side, rows, 1, 2),
                 error_panel(rows),
                 joint_panel(arm, rows),
                 limit_panel(arm, rows),
                 speed_panel(rows)};
  return plot;
}

}  // namespace mjarm::app
