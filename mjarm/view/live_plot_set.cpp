#include "mjarm/view/live_plot_set.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/view.hpp"
#include "mjarm/view/plot_history_internal.hpp"

namespace mjarm::view {
namespace {

constexpr LiveFigure kFigures[] = {LiveFigure::tool_position, LiveFigure::tracking_error,
                                   LiveFigure::joint_error,   LiveFigure::joints,
                                   LiveFigure::torque,        LiveFigure::manipulability};
constexpr render::Rgba kReference = {0.75F, 0.75F, 0.78F, 1};

/// Where the columns of a row stand.
struct Columns {
  std::size_t dof;
  [[nodiscard]] std::size_t tool() const { return 0; }
  [[nodiscard]] std::size_t reference() const { return 3; }
  [[nodiscard]] std::size_t error() const { return 6; }
  [[nodiscard]] std::size_t joint_error() const { return 7; }
  [[nodiscard]] std::size_t manipulability() const { return 8; }
  [[nodiscard]] std::size_t q() const { return 9; }
  [[nodiscard]] std::size_t torque() const { return 9 + dof; }
  [[nodiscard]] std::size_t count() const { return 9 + 2 * dof; }
};

/// What both kinds of figure are made of.
struct Chart {
  Msg title;
  std::string unit;
  std::vector<render::PlotLine> lines;
  bool from_zero = false;
};

void add_curve(Chart& chart, const std::vector<TimedValue>& values, std::string name, int color,
               render::LineStyle style = render::LineStyle::solid) {
  render::PlotLine line{.label = std::move(name), .style = style, .color = color};
  if (style != render::LineStyle::solid) line.width = 0.9;
  for (const TimedValue& value : values) {
    line.x.push_back(value.time);
    line.y.push_back(value.value);
  }
  chart.lines.push_back(std::move(line));
}

/// Limits over all of the time that the curves take.
void add_limits(Chart& chart, const JointVec& lower, const JointVec& upper) {
  if (chart.lines.empty() || chart.lines.front().x.empty()) return;
  const std::vector<double>& times = chart.lines.front().x;
  std::ranges::move(
      render::limit_lines(as_span(lower), as_span(upper), times.front(), times.back()),
      std::back_inserter(chart.lines));
}

/// The unit of all joints, where they have one in common.
std::string joint_unit(const Arm& arm, const char* hinge, const char* slide) {
  const auto slides = std::ranges::count(arm.joints, JointType::slide, &ArmJoint::type);
  if (slides == 0) return hinge;
  return slides == arm.dof() ? slide : hinge + text(msg::core_comma) + slide;
}

/// Legends are narrow: "wrist_1" for "wrist_1_joint".
std::string short_name(std::string name) {
  constexpr std::string_view kSuffix = "_joint";
  if (name.size() > kSuffix.size() && name.ends_with(kSuffix)) {
    name.resize(name.size() - kSuffix.size());
  }
  return name;
}

render::Rgba figure_color(const render::PlotLine& line) {
  if (line.color == render::PlotLine::kInk) return kReference;
  // The figure is dark: colours made for paper are lifted.
  const render::Rgba color = render::plot_color(line.color);
  const auto lift = [](float part) { return 0.35F + 0.65F * part; };
  return {lift(color.r), lift(color.g), lift(color.b), 1};
}

}  // namespace

struct LivePlotSet::Impl {
  Impl(const Arm& the_arm, const LivePlotSetOptions& options)
      : arm(the_arm),
        columns{static_cast<std::size_t>(the_arm.dof())},
        latest(columns.count(), options.places, options.latest),
        all(columns.count(), options.places, 0) {}

  [[nodiscard]] Chart chart(LiveFigure which, LiveSpan span) const;
  void add_joints(Chart& chart, const PlotHistory& history, std::size_t first) const;

  Arm arm;
  Columns columns;
  PlotHistory latest;
  PlotHistory all;
  double last_time = -std::numeric_limits<double>::infinity();
};

void LivePlotSet::Impl::add_joints(Chart& chart, const PlotHistory& history,
                                   std::size_t first) const {
  for (std::size_t j = 0; j < columns.dof; ++j) {
    add_curve(chart, history.column(first + j), short_name(arm.joints[j].name),
              static_cast<int>(j));
  }
}

Chart LivePlotSet::Impl::chart(LiveFigure which, LiveSpan span) const {
  const PlotHistory& history = span == LiveSpan::latest ? latest : all;
  const auto single = [&](Msg title, std::string unit, std::size_t column) {
    Chart chart{title, std::move(unit), {}, true};
    add_curve(chart, history.column(column), "", 0);
    return chart;
  };
  switch (which) {
    case LiveFigure::tool_position: {
      Chart chart{msg::view_plot_tool, "m", {}};
      static constexpr const char* kNames[] = {"x", "y", "z"};
      for (std::size_t i = 0; i < 3; ++i) {
        add_curve(chart, history.column(columns.tool() + i), kNames[i], static_cast<int>(i));
      }
      for (std::size_t i = 0; i < 3; ++i) {
        add_curve(chart, history.column(columns.reference() + i), "", render::PlotLine::kInk,
                  render::LineStyle::dashed);
      }
      return chart;
    }
    case LiveFigure::tracking_error:
      return single(msg::view_plot_error, "mm", columns.error());
    case LiveFigure::joint_error:
      return single(msg::view_plot_joint_error, joint_unit(arm, "mrad", "mm"),
                    columns.joint_error());
    case LiveFigure::joints: {
      Chart chart{msg::view_plot_joints, joint_unit(arm, "rad", "m"), {}};
      add_joints(chart, history, columns.q());
      add_limits(chart, arm.limits.lower, arm.limits.upper);
      return chart;
    }
    case LiveFigure::torque: {
      Chart chart{msg::view_plot_torque, joint_unit(arm, "N m", "N"), {}};
      add_joints(chart, history, columns.torque());
      add_limits(chart, -arm.limits.torque, arm.limits.torque);
      return chart;
    }
    case LiveFigure::manipulability:
      break;
  }
  return single(msg::view_plot_manipulability, "sqrt det J J^T", columns.manipulability());
}

LivePlotSet::LivePlotSet(const Arm& arm, const LivePlotSetOptions& options)
    : impl_(std::make_unique<Impl>(arm, options)) {}
LivePlotSet::~LivePlotSet() = default;
LivePlotSet::LivePlotSet(LivePlotSet&&) noexcept = default;
LivePlotSet& LivePlotSet::operator=(LivePlotSet&&) noexcept = default;

void LivePlotSet::clear() {
  impl_->latest.clear();
  impl_->all.clear();
  impl_->last_time = -std::numeric_limits<double>::infinity();
}

void LivePlotSet::add(const LiveRow& row) {
  if (!std::isfinite(row.time)) return;
  if (row.time < impl_->last_time) clear();
  impl_->last_time = row.time;
  const Columns& at = impl_->columns;
  const auto n = static_cast<Eigen::Index>(at.dof);
  std::vector<double> values(at.count(), std::numeric_limits<double>::quiet_NaN());
  for (int i = 0; i < 3; ++i) {
    values[at.tool() + static_cast<std::size_t>(i)] = row.X_WT.p[i];
    values[at.reference() + static_cast<std::size_t>(i)] = row.X_ref.p[i];
  }
  values[at.error()] = 1e3 * (row.X_WT.p - row.X_ref.p).norm();
  values[at.manipulability()] = row.manipulability;
  if (row.q.size() == n) std::ranges::copy(row.q, values.begin() + static_cast<long>(at.q()));
  if (row.torque.size() == n) {
    std::ranges::copy(row.torque, values.begin() + static_cast<long>(at.torque()));
  }
  if (row.q.size() == n && row.q_ref.size() == n) {
    values[at.joint_error()] = 1e3 * (row.q - row.q_ref).cwiseAbs().maxCoeff();
  }
  for (double& value : values) {
    if (!std::isfinite(value)) value = std::numeric_limits<double>::quiet_NaN();
  }
  impl_->latest.add(row.time, values);
  impl_->all.add(row.time, values);
}

LivePlot LivePlotSet::figure(LiveFigure which, LiveSpan span) const {
  const Chart chart = impl_->chart(which, span);
  LivePlot plot;
  plot.title = text(chart.title) + " [" + chart.unit + "]";
  plot.x_label = text(msg::view_plot_time);
  plot.y_from_zero = chart.from_zero;
  for (const render::PlotLine& line : chart.lines) {
    plot.series.push_back({line.label, figure_color(line), line.x, line.y, line.style});
  }
  return plot;
}

render::PlotPanel LivePlotSet::panel(LiveFigure which, LiveSpan span) const {
  Chart chart = impl_->chart(which, span);
  render::PlotPanel panel;
  panel.title = text(chart.title);
  panel.x_label = text(msg::view_plot_time);
  panel.y_label = chart.unit;
  panel.y_from_zero = chart.from_zero;
  panel.lines = std::move(chart.lines);
  return panel;
}

render::Plot LivePlotSet::page(const std::string& title, LiveSpan span) const {
  render::Plot page;
  page.title = title;
  page.columns = 3;
  for (const LiveFigure which : kFigures) page.panels.push_back(panel(which, span));
  return page;
}

}  // namespace mjarm::view
