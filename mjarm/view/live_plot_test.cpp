#include "mjarm/view/live_plot.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/view/figure_internal.hpp"
#include "mjarm/view/recorded_run.hpp"

namespace mjarm::view {
namespace {

class Figures : public ::testing::Test {
 protected:
  /// Figures are too large for the stack.
  const mjvFigure& fill(const LivePlot& plot) {
    fill_figure(plot, *figure_);
    return *figure_;
  }
  std::unique_ptr<mjvFigure> figure_ = std::make_unique<mjvFigure>();
};

TEST_F(Figures, HoldTheCurvesAndTheirNames) {
  const LivePlot plot = {.title = "joints",
                         .x_label = "time [s]",
                         .series = {{.name = "pan", .x = {0, 1, 2}, .y = {0, 0.5, 1}},
                                    {.name = "lift", .x = {0, 1}, .y = {-1, 1}}}};
  const mjvFigure& figure = fill(plot);
  EXPECT_STREQ(figure.title, "joints");
  EXPECT_STREQ(figure.xlabel, "time [s]");
  EXPECT_STREQ(figure.linename[0], "pan");
  EXPECT_STREQ(figure.linename[1], "lift");
  EXPECT_EQ(figure.flg_legend, 1);
  EXPECT_EQ(figure.linepnt[0], 3);
  EXPECT_EQ(figure.linepnt[1], 2);
  EXPECT_EQ(figure.linepnt[2], 0);
  EXPECT_FLOAT_EQ(figure.linedata[0][3], 0.5F);
  EXPECT_FLOAT_EQ(figure.range[0][0], 0);
  EXPECT_FLOAT_EQ(figure.range[0][1], 2);
  EXPECT_FLOAT_EQ(figure.range[1][0], -1);
  EXPECT_FLOAT_EQ(figure.range[1][1], 1);
}

TEST(RecordedPlots, TheUnitStandsInTheTitle) {
  const render::PlotPanel panel{.title = "error", .y_label = "mm"};
  EXPECT_EQ(live_plot(panel).title, "error, mm");
  const LanguageScope chinese(Language::chinese);
  EXPECT_EQ(live_plot(panel).title, "error，mm");
}

TEST_F(Figures, ThinLongCurvesAndKeepTheirEnds) {
  for (const int count : {1000, 1001, 1002, 54321}) {
    LivePlot plot = {.series = {{}}};
    for (int i = 0; i < count; ++i) {
      plot.series[0].x.push_back(i);
      plot.series[0].y.push_back(2 * i);
    }
    const mjvFigure& figure = fill(plot);
    const int points = figure.linepnt[0];
    ASSERT_LE(points, mjMAXLINEPNT);
    ASSERT_GE(points, std::min(count, 400));
    EXPECT_FLOAT_EQ(figure.linedata[0][0], 0);
    EXPECT_FLOAT_EQ(figure.linedata[0][2 * points - 2], static_cast<float>(count - 1));
  }
}

TEST_F(Figures, RangesHoldAllAndOneUnitIsOneLength) {
  LivePlot plot = {.series = {{}}, .equal_aspect = true};
  for (int i = 0; i < 100; ++i) {
    plot.series[0].x.push_back(0.3 * std::cos(0.0628 * i) - 0.01);
    plot.series[0].y.push_back(0.15 * std::sin(0.0628 * i) + 0.5);
  }
  const mjvFigure& figure = fill(plot);
  EXPECT_FLOAT_EQ(figure.range[0][1] - figure.range[0][0], figure.range[1][1] - figure.range[1][0]);
  for (int i = 0; i < 100; ++i) {
    EXPECT_GE(plot.series[0].x[i], figure.range[0][0]);
    EXPECT_LE(plot.series[0].x[i], figure.range[0][1]);
    EXPECT_GE(plot.series[0].y[i], figure.range[1][0]);
    EXPECT_LE(plot.series[0].y[i], figure.range[1][1]);
  }
}

TEST_F(Figures, TakeAnything) {
  const double nan = std::nan("");
  const mjvFigure& empty = fill({});
  EXPECT_LT(empty.range[0][0], empty.range[0][1]);
  const mjvFigure& odd =
      fill({.title = std::string(5000, 'x'),
            .series = {{.x = {nan, 1, 2}, .y = {1, nan}}, {.x = {5}, .y = {5}}}});
  EXPECT_EQ(odd.linepnt[0], 0);
  EXPECT_EQ(odd.linepnt[1], 1);
  EXPECT_LT(odd.range[1][0], odd.range[1][1]);
  EXPECT_LT(std::string(odd.title).size(), sizeof(odd.title));
}

/// MuJoCo moves the ends of the y axis outwards to multiples of the power of ten in its length; the
/// labels of the grid are round only where they are such already.
TEST_F(Figures, TheYAxisEndsWhereMujocoLeavesIt) {
  for (const auto& [least, max] :
       {std::pair(-0.31, 0.81), std::pair(0.0, 1.42), std::pair(0.03, 0.12), std::pair(-6.3, 6.3),
        std::pair(99.0, 101.0), std::pair(0.0, 0.08), std::pair(-150.0, 28.0)}) {
    const mjvFigure& figure = fill({.series = {{.x = {0, 12}, .y = {least, max}}}});
    const double lower = figure.range[1][0];
    const double upper = figure.range[1][1];
    EXPECT_LE(lower, least + 1e-6);
    EXPECT_GE(upper, max - 1e-6);
    const double ten = std::pow(10, std::floor(std::log10(upper - lower) + 1e-5));
    EXPECT_NEAR(lower / ten, std::round(lower / ten), 1e-4) << least << " " << max;
    EXPECT_NEAR(upper / ten, std::round(upper / ten), 1e-4) << least << " " << max;
    EXPECT_EQ(figure.gridsize[1], 5);
    EXPECT_EQ(figure.gridsize[0], 4) << "0 5 10 15";
    EXPECT_FLOAT_EQ(figure.range[0][1], 15);
  }
}

TEST_F(Figures, DashesAndGapsAreSeparatePieces) {
  LivePlot plot = {.series = {{.name = "a"}, {.style = render::LineStyle::dashed}}};
  for (int i = 0; i < 900; ++i) {
    plot.series[0].x.push_back(i);
    plot.series[0].y.push_back(std::sin(0.01 * i));
  }
  plot.series[1].x = {0, 899};
  plot.series[1].y = {0.5, 0.5};
  const mjvFigure& figure = fill(plot);
  ASSERT_EQ(figure.flg_barplot, 1);
  // The first curve needs two lines of the figure, of which one has its name.
  EXPECT_STREQ(figure.linename[0], "a");
  EXPECT_STREQ(figure.linename[1], "");
  EXPECT_EQ(figure.linepnt[0] + figure.linepnt[1], 2 * 899);
  EXPECT_FLOAT_EQ(figure.linergb[0][0], figure.linergb[1][0]);
  EXPECT_FLOAT_EQ(figure.linedata[1][2 * figure.linepnt[1] - 2], 899);
  double drawn = 0;
  for (int i = 0; i < figure.linepnt[2]; i += 2) {
    drawn += figure.linedata[2][2 * i + 2] - figure.linedata[2][2 * i];
    EXPECT_FLOAT_EQ(figure.linedata[2][2 * i + 1], 0.5F);
  }
  EXPECT_NEAR(drawn, 899 * 0.625, 30);
  plot.series.resize(1);
  EXPECT_EQ(fill(plot).flg_barplot, 0);
  plot.series[0].y[500] = std::nan("");
  EXPECT_EQ(fill(plot).flg_barplot, 1);
  EXPECT_EQ(figure_->linepnt[0] + figure_->linepnt[1], 2 * 897);
}

TEST_F(Figures, HaveRoomForSoManyCurvesOnly) {
  LivePlot plot;
  plot.series.resize(mjMAXLINE + 10, {.x = {0, 1}, .y = {0, 1}});
  EXPECT_EQ(fill(plot).linepnt[mjMAXLINE - 1], 2);
}

}  // namespace
}  // namespace mjarm::view
