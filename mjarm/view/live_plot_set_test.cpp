#include "mjarm/view/live_plot_set.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "mjarm/view/figure_internal.hpp"

namespace mjarm::view {
namespace {

using ::testing::HasSubstr;

Arm two_joints() {
  Arm arm;
  arm.joints.resize(2);
  arm.joints[0].name = "pan";
  arm.joints[1].name = "lift";
  arm.limits.lower = joint_vec(std::vector<double>{-3, -2});
  arm.limits.upper = joint_vec(std::vector<double>{3, 2});
  arm.limits.torque = joint_vec(std::vector<double>{50, 50});
  return arm;
}

LiveRow row_at(double time) {
  LiveRow row;
  row.time = time;
  row.q = joint_vec(std::vector<double>{std::sin(time), std::cos(time)});
  row.q_ref = row.q + joint_vec(std::vector<double>{0.001, -0.004});
  row.X_WT.p = {0.1 * time, 0.2, 0.3};
  row.X_ref.p = row.X_WT.p + Eigen::Vector3d(0, 0.003, 0.004);
  row.torque = joint_vec(std::vector<double>{10 * std::sin(time), 5});
  row.manipulability = 0.05;
  return row;
}

TEST(LivePlotSet, WhatGoesInComesOut) {
  LivePlotSet plots(two_joints());
  for (int i = 0; i < 400; ++i) plots.add(row_at(0.05 * i));
  for (const LiveSpan span : {LiveSpan::latest, LiveSpan::all}) {
    const LivePlot joints = plots.figure(LiveFigure::joints, span);
    EXPECT_EQ(joints.title, "joints [rad]");
    EXPECT_EQ(joints.x_label, "time [s]");
    ASSERT_GE(joints.series.size(), 2U);
    ASSERT_EQ(joints.series[1].x.size(), 400U);
    EXPECT_EQ(joints.series[1].name, "lift");
    for (int i = 0; i < 400; ++i) {
      EXPECT_DOUBLE_EQ(joints.series[1].x[i], 0.05 * i);
      EXPECT_DOUBLE_EQ(joints.series[1].y[i], std::cos(0.05 * i));
    }
    const LivePlot tracking = plots.figure(LiveFigure::tracking_error, span);
    for (const double error : tracking.series.at(0).y) {
      EXPECT_NEAR(error, 5, 1e-9) << "millimetres";
    }
    const LivePlot worst = plots.figure(LiveFigure::joint_error, span);
    for (const double error : worst.series.at(0).y) {
      EXPECT_NEAR(error, 4, 1e-9) << "milliradians, of the worst joint";
    }
    EXPECT_NEAR(plots.figure(LiveFigure::tool_position, span).series.at(0).y.at(50), 0.25, 1e-12);
    EXPECT_NEAR(plots.figure(LiveFigure::tool_position, span).series.at(4).y.at(50), 0.203, 1e-12);
    EXPECT_EQ(plots.figure(LiveFigure::manipulability, span).series.at(0).y.at(3), 0.05);
  }
}

TEST(LivePlotSet, LimitsAreDottedAndEqualOnesDrawnOnce) {
  LivePlotSet plots(two_joints());
  plots.add(row_at(0));
  plots.add(row_at(2));
  const LivePlot joints = plots.figure(LiveFigure::joints);
  std::vector<double> limits;
  for (const LiveSeries& series : joints.series) {
    if (series.style != render::LineStyle::dotted) continue;
    EXPECT_EQ(series.x, (std::vector<double>{0, 2}));
    EXPECT_EQ(series.y[0], series.y[1]);
    limits.push_back(series.y[0]);
  }
  EXPECT_THAT(limits, ::testing::UnorderedElementsAre(-3, -2, 3, 2));
  limits.clear();
  for (const LiveSeries& series : plots.figure(LiveFigure::torque).series) {
    if (series.style == render::LineStyle::dotted) limits.push_back(series.y[0]);
  }
  EXPECT_THAT(limits, ::testing::UnorderedElementsAre(-50, 50));
  const auto figure = std::make_unique<mjvFigure>();
  fill_figure(joints, *figure);
  EXPECT_EQ(figure->flg_barplot, 1) << "dots are separate pieces";
  EXPECT_LE(figure->range[1][0], -3);
  EXPECT_GE(figure->range[1][1], 3);
}

/// An hour at 500 rows a second with one peak of one row.
TEST(LivePlotSet, AnHourTakesBoundedMemoryAndKeepsEveryPeak) {
  LivePlotSet plots(two_joints(), {.latest = 20, .places = 480});
  constexpr int kRows = 3600 * 500 / 4;  // every fourth, so that the test is short
  constexpr int kPeak = 123457;
  for (int i = 0; i < kRows; ++i) {
    LiveRow row = row_at(0.008 * i);
    if (i == kPeak) row.X_ref.p.x() += 0.5;
    if (i == kPeak + 7) row.torque[1] = -49;
    plots.add(row);
  }
  const LivePlot error = plots.figure(LiveFigure::tracking_error, LiveSpan::all);
  const LiveSeries& series = error.series.at(0);
  EXPECT_LE(series.x.size(), 961U);
  EXPECT_GE(series.x.size(), 240U);
  const auto peak = std::ranges::max_element(series.y);
  EXPECT_NEAR(*peak, std::hypot(500, 3, 4), 1e-9);
  EXPECT_DOUBLE_EQ(series.x[static_cast<std::size_t>(peak - series.y.begin())], 0.008 * kPeak);
  EXPECT_TRUE(std::ranges::is_sorted(series.x));
  EXPECT_EQ(series.x.front(), 0);
  EXPECT_DOUBLE_EQ(series.x.back(), 0.008 * (kRows - 1));
  const LivePlot torque = plots.figure(LiveFigure::torque, LiveSpan::all);
  EXPECT_EQ(std::ranges::min(torque.series.at(1).y), -49);
  // The latest 20 s are as fine as ever.
  const LivePlot latest = plots.figure(LiveFigure::joints);
  EXPECT_NEAR(latest.series.at(0).x.front(), 0.008 * (kRows - 1) - 20, 0.2);
  EXPECT_GT(latest.series.at(0).x.size(), 800U);
  EXPECT_LE(latest.series.at(0).x.size(), 961U);
  for (std::size_t i = 0; i < latest.series[0].x.size(); ++i) {
    EXPECT_DOUBLE_EQ(latest.series[0].y[i], std::sin(latest.series[0].x[i]));
  }
}

TEST(LivePlotSet, ThePageHoldsTheSameCurves) {
  LivePlotSet plots(two_joints());
  for (int i = 0; i < 100; ++i) plots.add(row_at(0.05 * i));
  const render::Plot page = plots.page("run", LiveSpan::latest);
  ASSERT_EQ(page.panels.size(), 6U);
  const LivePlot figure = plots.figure(LiveFigure::joints);
  const render::PlotPanel& panel = page.panels[3];
  EXPECT_EQ(panel.title, "joints");
  EXPECT_EQ(panel.y_label, "rad");
  ASSERT_EQ(panel.lines.size(), figure.series.size());
  for (std::size_t i = 0; i < panel.lines.size(); ++i) {
    EXPECT_EQ(panel.lines[i].x, figure.series[i].x);
    EXPECT_EQ(panel.lines[i].y, figure.series[i].y);
    EXPECT_EQ(panel.lines[i].style, figure.series[i].style);
  }
  const Result<std::string> svg = render::plot_svg(page);
  ASSERT_TRUE(svg) << svg.error().what;
  EXPECT_THAT(*svg, HasSubstr("manipulability"));
  EXPECT_THAT(*svg, HasSubstr("stroke-dasharray"));
}

TEST(LivePlotSet, TakesAnything) {
  LivePlotSet plots(two_joints());
  EXPECT_TRUE(render::plot_svg(plots.page("empty")));
  const auto figure = std::make_unique<mjvFigure>();
  fill_figure(plots.figure(LiveFigure::joints), *figure);
  LiveRow row;
  row.time = 1;
  row.X_WT.p.x() = INFINITY;
  row.q = joint_vec(std::vector<double>{1, 2, 3});
  plots.add(row);
  row.time = std::nan("");
  plots.add(row);
  for (const LiveFigure which : {LiveFigure::tool_position, LiveFigure::joints, LiveFigure::torque,
                                 LiveFigure::manipulability}) {
    fill_figure(plots.figure(which), *figure);
  }
  EXPECT_TRUE(render::plot_svg(plots.page("odd")));
  // Time that goes back is a new run.
  plots.add(row_at(5));
  plots.add(row_at(0.5));
  EXPECT_EQ(plots.figure(LiveFigure::joints).series.at(0).x, (std::vector<double>{0.5}));
}

}  // namespace
}  // namespace mjarm::view
