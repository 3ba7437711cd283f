#include "mjarm/session/run_charts.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace mjarm::session
