#include "apps/mjarm/demos/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "apps/mjarm/messages/demo.hpp"
#include "mjarm/core/language_scope.hpp"
#include "mjarm/render/fonts.hpp"

namespace mjarm::app {
namespace {

MeasuredRun from_zero(MeasuredRun run) {
  const double start = run.rows.empty() ? 0 : run.rows.front().time;
  for (RecordRow& row : run.rows) row.time -= start;
  return run;
}

/// The curve itself: a run that leaves it must not count as planned so.
render::PlotLine front_line(const Curve& curve) {
  std::vector<double> x, z;
  for (const double s : curve.stations(0.01, std::numeric_limits<double>::infinity())) {
    const Pose X = curve.at(s);
    x.push_back(X.p.x());
    z.push_back(X.p.z());
  }
  return render::planned_line(std::move(x), std::move(z));
}

render::PlotPanel panel_of(Chart chart, const Arm& arm, const MeasuredRun& run) {
  const std::span<const MeasuredRun> runs(&run, 1);
  switch (chart) {
    case Chart::joint_speeds:
      return session::joint_speed_panel(arm, runs);
    case Chart::joints:
      return session::joint_panel(arm, runs);
    case Chart::front: {
      render::PlotPanel panel = session::front_panel(runs);
      panel.lines.back() = front_line(*run.curve);
      return panel;
    }
    case Chart::tool_speed:
      return session::tool_speed_panel(runs);
    case Chart::error:
      break;
  }
  render::PlotPanel panel = session::error_panel(runs, 0);
  panel.bands.clear();
  return panel;
}

/// The range of one coordinate over all lines of the panels, with a little room.
render::PlotRange common_range(std::span<const render::PlotPanel> panels,
                               std::vector<double> render::PlotLine::* values) {
  double lower = std::numeric_limits<double>::infinity(), upper = -lower;
  for (const render::PlotPanel& panel : panels) {
    for (const render::PlotLine& line : panel.lines) {
      for (const double x : line.*values) {
        if (std::isnan(x)) continue;
        lower = std::min(lower, x);
        upper = std::max(upper, x);
      }
    }
  }
  if (panels.front().y_from_zero && values == &render::PlotLine::y) lower = 0;
  const double room = 0.05 * (upper - lower) + 1e-9;
  return {lower >= 0 && lower < room ? 0 : lower - room, upper + room};  // time begins at 0
}

}  // namespace

PeakSpeed peak_speed(const MeasuredRun& run) {
  PeakSpeed peak;
  for (const RecordRow& row : run.rows) {
    int joint = 0;
    const double speed = row.v.cwiseAbs().maxCoeff(&joint);
    if (speed > peak.speed) peak = {speed, joint};
  }
  return peak;
}

double largest_distance(const MeasuredRun& run) {
  double largest = 0;
  for (const RecordRow& row : run.rows) {
    largest = std::max(largest, run.curve->nearest(row.X_WT.p).distance);
  }
  return largest;
}

render::Plot comparison_plot(const ComparisonText& about, const Arm& arm,
                             std::span<const ComparedRun> runs, std::span<const Chart> rows) {
  const LanguageScope drawn(render::picture_language());
  render::Plot page;
  page.title = about.title;
  page.note = about.note;
  page.columns = static_cast<int>(runs.size());
  page.panel_width = 330;
  for (const Chart chart : rows) {
    std::vector<render::PlotPanel> row;
    for (const ComparedRun& side : runs) {
      render::PlotPanel panel = panel_of(chart, arm, from_zero(side.run));
      panel.title = text(msg::demo_side_title, side.title, panel.title);
      row.push_back(std::move(panel));
    }
    const render::PlotRange x = common_range(row, &render::PlotLine::x),
                            y = common_range(row, &render::PlotLine::y);
    for (render::PlotPanel& panel : row) {
      panel.x_range = x;
      panel.y_range = y;
      page.panels.push_back(std::move(panel));
    }
  }
  return page;
}

}  // namespace mjarm::app
