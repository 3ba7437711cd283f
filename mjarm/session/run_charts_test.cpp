#include "mjarm/session/run_charts.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace mjarm::session {
namespace {

/// A run along the x axis, `error` [m] beside it at most.
MeasuredRun run_beside(const Curve& line, double error) {
  MeasuredRun run{.rows = {}, .curve = &line};
  for (int i = 0; i <= 100; ++i) {
    RecordRow row;
    row.time = 0.01 * i;
    row.q = row.v = JointVec::Zero(1);
    row.X_WT.p = {0.01 * i, error * i / 100, 0};
    row.X_ref.p = {0.01 * i, 0, 0};
    run.rows.push_back(row);
  }
  return run;
}

/// The tolerance is told in words, and scales the axis only where errors come near it.
TEST(RunCharts, ErrorsAreSeenHoweverSmallTheyAre) {
  const Curve line = Curve::line({}, {{1, 0, 0}, Eigen::Matrix3d::Identity()}).value();
  for (const auto& [error, fits] :
       {std::pair(1e-11, false), {1e-6, false}, {1e-4, true}, {2e-3, true}}) {
    const MeasuredRun run = run_beside(line, error);
    const render::PlotPanel panel = error_panel({&run, 1}, 5e-4);
    ASSERT_EQ(panel.bands.size(), 1U);
    EXPECT_EQ(panel.bands[0].fits, fits) << error;
    EXPECT_EQ(panel.bands[0].label, "tolerance 0.5 mm");
    EXPECT_NEAR(panel.lines.at(0).y.back(), 1e3 * error, 1e-6 * error);
  }
}

/// A gripper that closes has no ideal curve to be off.
TEST(RunCharts, ErrorsAreThoseOfRunsWithACurve) {
  const Curve line = Curve::line({}, {{1, 0, 0}, Eigen::Matrix3d::Identity()}).value();
  std::vector<MeasuredRun> runs = {run_beside(line, 1e-4), run_beside(line, 1)};
  runs[1].curve = nullptr;
  const render::PlotPanel panel = error_panel(runs, 5e-4);
  EXPECT_EQ(panel.lines.at(0).y.size(), 101U);
  EXPECT_NEAR(std::ranges::max(panel.lines.at(0).y), 0.1, 1e-9);
}

/// Between two runs there is a gap in every curve.
TEST(RunCharts, RunsAreNotJoined) {
  const Curve line = Curve::line({}, {{1, 0, 0}, Eigen::Matrix3d::Identity()}).value();
  const std::vector<MeasuredRun> runs = {run_beside(line, 0), run_beside(line, 0)};
  const render::PlotPanel speed = tool_speed_panel(runs);
  int gaps = 0;
  for (const double value : speed.lines.at(0).y) {
    gaps += std::isnan(value) ? 1 : 0;
    EXPECT_FALSE(value > 2) << value;
  }
  EXPECT_GE(gaps, 1);
}

/// Of a pen that pressed: its ink, its force and how far it was off, stroke by stroke.
TEST(RunCharts, APenShowsItsInkAndItsForce) {
  Arm arm;
  arm.joints.resize(1);
  JointLimits& limits = arm.limits;
  for (JointVec* one : {&limits.lower, &limits.upper, &limits.velocity, &limits.torque}) {
    *one = JointVec::Constant(1, 1);
  }
  const MeasuredRun run;
  std::vector<InkPoint> ink;
  for (int i = 0; i < 200; ++i) {
    InkPoint& point = ink.emplace_back();
    point.move = i < 100 ? 1 : 3;
    point.time = 0.01 * i;
    point.X_WT.p = {0.001 * i, 0.3, 0.5};
    point.X_WT.R = Eigen::AngleAxisd(-1.5, Eigen::Vector3d::UnitX()).toRotationMatrix();
    point.off = 1e-5 * i;
    point.force = 1 + 1e-3 * i;
  }
  const render::Plot plot = run_plot("pen", "tool_impedance", {}, arm, {{&run, 1}, ink}, 5e-4);
  ASSERT_EQ(plot.panels.size(), 8U);
  const auto panel = std::ranges::find(plot.panels, "force of the pen", &render::PlotPanel::title);
  ASSERT_NE(panel, plot.panels.end());
  const std::vector<double>& force = panel->lines.at(0).y;
  EXPECT_EQ(std::ranges::count_if(force, [](double y) { return std::isnan(y); }), 1)
      << "two strokes";
  EXPECT_DOUBLE_EQ(force.front(), 1);
  EXPECT_DOUBLE_EQ(force.back(), 1.199);
  // The sheet stands, so that it is seen from the front.
  const auto drawn = std::ranges::find(plot.panels, "ink", &render::PlotPanel::title);
  ASSERT_NE(drawn, plot.panels.end());
  EXPECT_EQ(drawn->y_label, "z [m]");
  EXPECT_DOUBLE_EQ(drawn->lines.at(0).y.back(), 0.5);
}

}  // namespace
}  // namespace mjarm::session
