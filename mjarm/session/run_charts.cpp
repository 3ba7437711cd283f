#include "mjarm/session/run_charts.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <numeric>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/messages/run_charts.hpp"
#include "mjarm/core/messages/show.hpp"
#include "mjarm/render/fonts.hpp"
#include "mjarm/session/chart_stride_internal.hpp"

namespace mjarm::session {
namespace {

constexpr double kShareOfTolerance = 0.05;  ///< that an error has to reach to be seen below it

/// The rows of all runs to be drawn, with a gap (null) between runs.
using Rows = std::vector<const RecordRow*>;
/// Points of ink to be drawn; null where the pen was lifted.
using Ink = std::vector<const InkPoint*>;

Rows rows_to_draw(std::span<const MeasuredRun> runs) {
  std::size_t count = 0;
  for (const MeasuredRun& run : runs) count += run.rows.size();
  const std::size_t stride = chart_stride(count);
  Rows rows;
  for (const MeasuredRun& run : runs) {
    if (!rows.empty()) rows.push_back(nullptr);
    for (std::size_t i = 0; i < run.rows.size(); i += stride) rows.push_back(&run.rows[i]);
    if (!run.rows.empty() && rows.back() != &run.rows.back()) rows.push_back(&run.rows.back());
  }
  return rows;
}

Ink ink_to_draw(std::span<const InkPoint> all) {
  const std::size_t stride = chart_stride(all.size());
  Ink ink;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool begins = i == 0 || all[i].move != all[i - 1].move;
    const bool ends = i + 1 == all.size() || all[i + 1].move != all[i].move;
    if (begins && !ink.empty()) ink.push_back(nullptr);
    if (begins || ends || i % stride == 0) ink.push_back(&all[i]);
  }
  return ink;
}

/// Of rows or of points of ink; no number where there is a gap.
template <class Point, class Value>
std::vector<double> column(const std::vector<const Point*>& points, const Value& value) {
  std::vector<double> out;
  for (const Point* point : points) {
    out.push_back(point != nullptr ? value(*point) : std::numeric_limits<double>::quiet_NaN());
  }
  return out;
}

template <class Point>
std::vector<double> times(const std::vector<const Point*>& points) {
  return column(points, [](const Point& point) { return point.time; });
}

render::PlotPanel over_time(Msg title, const std::string& unit) {
  render::PlotPanel panel;
  panel.title = text(title);
  panel.x_label = text(msg::run_chart_time);
  panel.over_time = true;
  panel.y_label = unit;
  return panel;
}

/// Places, by two axes of the world.
render::PlotPanel place_panel(Msg title, int x, int y) {
  static constexpr const char* kAxes[] = {"x [m]", "y [m]", "z [m]"};
  render::PlotPanel panel;
  panel.title = text(title);
  panel.x_label = kAxes[x];
  panel.y_label = kAxes[y];
  panel.equal_aspect = true;
  return panel;
}

render::PlotPanel side_view(Msg title, const Rows& rows, int x, int y) {
  render::PlotPanel panel = place_panel(title, x, y);
  const auto executed = [&](int axis) {
    return column(rows, [axis](const RecordRow& row) { return row.X_WT.p[axis]; });
  };
  const auto planned = [&](int axis) {
    return column(rows, [axis](const RecordRow& row) { return row.X_ref.p[axis]; });
  };
  panel.lines.push_back(render::executed_line(executed(x), executed(y)));
  panel.lines.push_back(render::planned_line(planned(x), planned(y)));
  return panel;
}

render::PlotPanel a_line_a_joint(
    const Arm& arm, const Rows& rows, render::PlotPanel panel,
    const std::function<double(const RecordRow& row, int joint)>& value) {
  for (int j = 0; j < arm.dof(); ++j) {
    panel.lines.push_back({.x = times(rows),
                           .y = column(rows, [&](const RecordRow& row) { return value(row, j); }),
                           .label = arm.joints[static_cast<std::size_t>(j)].name});
  }
  return panel;
}

template <class Value>
render::PlotPanel share_panel(Msg title, const Rows& rows, const Value& share) {
  render::PlotPanel panel = over_time(title, text(msg::run_chart_share));
  panel.y_from_zero = true;
  panel.lines.push_back({.x = times(rows), .y = column(rows, share)});
  return panel;
}

/// From where the pen looks at the sheet along an axis of the world, about.
render::PlotPanel ink_panel(const Ink& ink) {
  int along = 0;
  ink.front()->X_WT.R.col(2).cwiseAbs().maxCoeff(&along);
  const int x = along == 0 ? 1 : 0, y = along == 2 ? 1 : 2;
  render::PlotPanel panel = place_panel(msg::run_chart_ink, x, y);
  const auto place = [&](int axis) {
    return column(ink, [axis](const InkPoint& point) { return point.X_WT.p[axis]; });
  };
  panel.lines.push_back({.x = place(x), .y = place(y)});
  return panel;
}

render::PlotPanel ink_error_panel(const Ink& ink) {
  render::PlotPanel panel = over_time(msg::run_chart_ink_error, "mm");
  panel.y_from_zero = true;
  panel.lines.push_back(
      {.x = times(ink), .y = column(ink, [](const InkPoint& point) { return 1e3 * point.off; })});
  return panel;
}

render::PlotPanel force_panel(const Ink& ink) {
  render::PlotPanel panel = over_time(msg::run_chart_force, "N");
  panel.lines.push_back(
      {.x = times(ink), .y = column(ink, [](const InkPoint& point) { return point.force; })});
  return panel;
}

}  // namespace

render::PlotPanel front_panel(std::span<const MeasuredRun> runs) {
  return side_view(msg::run_chart_front, rows_to_draw(runs), 0, 2);
}

render::PlotPanel tool_speed_panel(std::span<const MeasuredRun> runs) {
  const Rows rows = rows_to_draw(runs);
  render::PlotPanel panel = over_time(msg::run_chart_speed, "m/s");
  panel.y_from_zero = true;
  render::PlotLine line;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const bool gap = rows[i] == nullptr || rows[i - 1] == nullptr;
    const double dt = gap ? 0 : rows[i]->time - rows[i - 1]->time;
    line.x.push_back(gap ? std::numeric_limits<double>::quiet_NaN() : rows[i]->time);
    line.y.push_back(dt > 0 ? (rows[i]->X_WT.p - rows[i - 1]->X_WT.p).norm() / dt
                            : std::numeric_limits<double>::quiet_NaN());
  }
  panel.lines.push_back(std::move(line));
  return panel;
}

render::PlotPanel error_panel(std::span<const MeasuredRun> runs, double tolerance) {
  const bool ideal =
      std::ranges::any_of(runs, [](const MeasuredRun& run) { return run.curve != nullptr; });
  render::PlotPanel panel = over_time(ideal ? msg::run_chart_error : msg::run_chart_tracking, "mm");
  panel.y_from_zero = true;
  render::PlotLine line;
  for (const MeasuredRun& run : runs) {
    if (ideal && run.curve == nullptr) continue;  // is on its way to one, or grips
    const Rows rows = rows_to_draw({&run, 1});
    const std::vector<double> t = times(rows);
    const std::vector<double> error = column(rows, [&run](const RecordRow& row) {
      const double metres = run.curve != nullptr ? run.curve->nearest(row.X_WT.p).distance
                                                 : (row.X_WT.p - row.X_ref.p).norm();
      return 1e3 * metres;
    });
    if (!line.x.empty()) {
      line.x.push_back(std::numeric_limits<double>::quiet_NaN());
      line.y.push_back(std::numeric_limits<double>::quiet_NaN());
    }
    line.x.insert(line.x.end(), t.begin(), t.end());
    line.y.insert(line.y.end(), error.begin(), error.end());
  }
  if (ideal) {
    // Errors far below the tolerance would be a line on the axis: then they set the scale.
    const double largest = std::transform_reduce(
        line.y.begin(), line.y.end(), 0.0, [](double a, double b) { return std::max(a, b); },
        [](double error) { return std::isnan(error) ? 0.0 : error; });
    panel.bands.push_back({.lower = 0,
                           .upper = 1e3 * tolerance,
                           .label = text(msg::run_chart_tolerance, 1e3 * tolerance),
                           .fits = largest > kShareOfTolerance * 1e3 * tolerance});
  }
  panel.lines.push_back(std::move(line));
  return panel;
}

render::PlotPanel joint_panel(const Arm& arm, std::span<const MeasuredRun> runs) {
  const Rows rows = rows_to_draw(runs);
  render::PlotPanel panel = a_line_a_joint(arm, rows, over_time(msg::run_chart_joints, "rad"),
                                           [](const RecordRow& row, int j) { return row.q[j]; });
  if (rows.empty()) return panel;
  std::ranges::move(
      render::limit_lines(as_span(arm.limits.lower), as_span(arm.limits.upper), rows.front()->time,
                          rows.back()->time, text(msg::run_chart_limits)),
      std::back_inserter(panel.lines));
  return panel;
}

render::PlotPanel joint_speed_panel(const Arm& arm, std::span<const MeasuredRun> runs) {
  render::PlotPanel panel = over_time(msg::run_chart_joint_speeds, "rad/s");
  const double limit = arm.limits.velocity.maxCoeff();
  panel.bands.push_back({-limit, limit, text(msg::run_chart_limit)});
  return a_line_a_joint(arm, rows_to_draw(runs), std::move(panel),
                        [](const RecordRow& row, int j) { return row.v[j]; });
}

render::Plot motion_plot(const std::string& title, const Arm& arm,
                         std::span<const MeasuredRun> runs, double tolerance) {
  const Rows rows = rows_to_draw(runs);
  const JointLimits& limits = arm.limits;
  render::Plot plot;
  plot.title = title;
  plot.columns = 4;
  plot.panels = {side_view(msg::run_chart_top, rows, 0, 1),
                 side_view(msg::run_chart_front, rows, 0, 2),
                 side_view(msg::run_chart_side, rows, 1, 2),
                 tool_speed_panel(runs),
                 error_panel(runs, tolerance),
                 joint_panel(arm, runs),
                 share_panel(msg::run_chart_velocity, rows,
                             [&](const RecordRow& row) {
                               return 100 *
                                      row.v.cwiseQuotient(limits.velocity).cwiseAbs().maxCoeff();
                             }),
                 share_panel(msg::run_chart_torque, rows, [&](const RecordRow& row) {
                   return 100 * row.torque.cwiseQuotient(limits.torque).cwiseAbs().maxCoeff();
                 })};
  return plot;
}

render::Plot run_plot(const std::string& name, const std::string& control, const Report& report,
                      const Arm& arm, const RunRecord& record, double tolerance) {
  const LanguageScope drawn(render::picture_language());
  render::Plot plot = motion_plot(name, arm, record.runs, tolerance);
  if (!record.ink.empty()) {
    const Ink ink = ink_to_draw(record.ink);
    plot.panels[1] = ink_panel(ink);
    plot.panels[2] = force_panel(ink);
    plot.panels[4] = ink_error_panel(ink);
  }
  if (report.path_error) {
    plot.note = text(msg::show_plot_note, control, 1e3 * report.path_error->max,
                     1e3 * report.path_error->rms, 100 * report.done);
  }
  return plot;
}

}  // namespace mjarm::session
