#include "mjarm/render/plot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>

#include "mjarm/render/canvas_internal.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::render {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::vector<double> steps(int count, double (*value)(double)) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(value(i * 2 * std::numbers::pi / (count - 1)));
  return values;
}

Plot circle() {
  PlotPanel panel{.title = "path", .x_label = "x [m]", .y_label = "y [m]", .equal_aspect = true};
  const auto x = steps(101, [](double a) { return std::cos(a); });
  const auto y = steps(101, [](double a) { return std::sin(a); });
  panel.lines.push_back(executed_line(x, y));
  panel.lines.push_back(planned_line(x, y));
  return {.title = "Circle", .note = "worst error 0.1 mm", .panels = {panel}, .columns = 1};
}

/// Points of the first polyline whose attributes contain `mark`.
std::vector<canvas::Point> points_of(const std::string& svg, const std::string& mark) {
  std::istringstream lines(svg);
  std::vector<canvas::Point> points;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("<polyline", 0) != 0 || line.find(mark) == std::string::npos) continue;
    const std::size_t from = line.find("points=\"") + 8;
    std::istringstream numbers(line.substr(from, line.find('"', from) - from));
    canvas::Point p;
    for (char comma; numbers >> p.x >> comma >> p.y;) points.push_back(p);
    if (points.size() > 2) return points;
    points.clear();
  }
  return points;
}

TEST(Plot, SvgHoldsEveryLabelAsText) {
  const std::string svg = plot_svg(circle()).value();
  for (const char* label :
       {"Circle", "path", "x [m]", "y [m]", "planned", "executed", "worst error 0.1 mm"}) {
    EXPECT_THAT(svg, HasSubstr(">" + std::string(label) + "</text>"));
  }
}

TEST(Plot, EqualPlotsGiveEqualBytes) {
  const support::TempFolder folder;
  ASSERT_TRUE(save_plot(circle(), folder.path() / "a"));
  ASSERT_TRUE(save_plot(circle(), folder.path() / "b"));
  EXPECT_EQ(folder.read("a.svg"), folder.read("b.svg"));
  EXPECT_EQ(folder.read("a.png"), folder.read("b.png"));
  Plot other = circle();
  other.panels[0].lines[0].y[50] += 0.01;
  EXPECT_NE(plot_svg(other).value(), folder.read("a.svg"));
}

TEST(Plot, EqualAspectKeepsACircleRound) {
  const std::vector<canvas::Point> points = points_of(plot_svg(circle()).value(), "#d55e00");
  ASSERT_GT(points.size(), 50U);
  const auto [left, right] = std::minmax_element(
      points.begin(), points.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  const auto [top, bottom] = std::minmax_element(
      points.begin(), points.end(), [](const auto& a, const auto& b) { return a.y < b.y; });
  EXPECT_NEAR(right->x - left->x, bottom->y - top->y, 0.05);
  EXPECT_GT(right->x - left->x, 80);
  // y grows upwards: the first quarter of the circle is drawn above its beginning.
  EXPECT_LT(points[points.size() / 4].y, points[0].y);
}

TEST(Plot, PlannedIsDashedAndExecutedSolid) {
  const std::string svg = plot_svg(circle()).value();
  EXPECT_FALSE(points_of(svg, "stroke-dasharray=\"4.5 2.5\"").empty());
  EXPECT_EQ(executed_line({}, {}).style, LineStyle::solid);
  EXPECT_EQ(planned_line({}, {}).style, LineStyle::dashed);
}

TEST(Plot, PictureHasTheColoursOfItsCurves) {
  const Image image = plot_image(circle(), 2).value();
  EXPECT_EQ(image.width, 2 * (270 + 16));
  EXPECT_EQ(image.pixel(0, 0), (std::array<std::uint8_t, 3>{255, 255, 255}));
  int vermilion = 0;
  int dark = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const auto [r, g, b] = image.pixel(x, y);
      vermilion += r > 190 && g > 80 && g < 110 && b < 20;
      dark += r < 70 && g < 70 && b < 70;
    }
  }
  EXPECT_GT(vermilion, 300);
  EXPECT_GT(dark, 300);
}

TEST(Plot, LimitsHaveTheColourOfTheirJointAndSharedOnesInk) {
  const std::vector<double> lower = {-3, -3, -INFINITY}, upper = {3, 2, INFINITY};
  const std::vector<PlotLine> lines = limit_lines(lower, upper, 1, 5, "limits");
  ASSERT_EQ(lines.size(), 3U);
  const double heights[] = {-3, 3, 2};
  const int colors[] = {PlotLine::kInk, 0, 1};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(lines[i].x, (std::vector<double>{1, 5}));
    EXPECT_EQ(lines[i].y, (std::vector<double>{heights[i], heights[i]}));
    EXPECT_EQ(lines[i].color, colors[i]);
    EXPECT_EQ(lines[i].style, LineStyle::dotted);
    EXPECT_EQ(lines[i].label, i == 0 ? "limits" : "");
  }
}

TEST(Plot, CurvesThatDoNotCountLeaveTheAxesAlone) {
  Plot plot{.panels = {{.lines = {{.x = {0, 1, 2}, .y = {0, 1, 0}}}}}};
  const std::string before = plot_svg(plot).value();
  plot.panels[0].lines.push_back({.x = {0, 2}, .y = {900, 900}, .fits = false});
  EXPECT_EQ(points_of(plot_svg(plot).value(), "#0072b2").at(1).y,
            points_of(before, "#0072b2").at(1).y);
  plot.panels[0].lines.back().fits = true;
  EXPECT_NE(points_of(plot_svg(plot).value(), "#0072b2").at(1).y,
            points_of(before, "#0072b2").at(1).y);
}

TEST(Plot, GapsSplitACurve) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Plot plot{.panels = {{.lines = {{.x = {0, 1, 2, 3, 4}, .y = {0, 1, nan, 1, 0}}}}}};
  const std::string svg = plot_svg(plot).value();
  std::size_t curves = 0;
  for (std::size_t at = 0; (at = svg.find("#0072b2", at)) != std::string::npos; ++at) ++curves;
  EXPECT_EQ(curves, 2U);
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(Plot, DenseCurvesAreThinnedWithoutLosingTheirPeaks) {
  PlotPanel panel;
  panel.lines.push_back({});
  for (int i = 0; i < 200000; ++i) {
    panel.lines[0].x.push_back(i);
    panel.lines[0].y.push_back(i == 123456 ? 1 : 0);
  }
  const std::vector<canvas::Point> points =
      points_of(plot_svg({.panels = {panel}}).value(), "#0072b2");
  EXPECT_LT(points.size(), 3000U);
  const auto [top, bottom] = std::minmax_element(
      points.begin(), points.end(), [](const auto& a, const auto& b) { return a.y < b.y; });
  EXPECT_GT(bottom->y - top->y, 100);
}

TEST(Plot, HoldsAnyText) {
  Plot plot = circle();
  plot.title = "a < b & c > d \xFF \xE4\xB8";
  plot.panels[0].title = "误差（毫米）";
  const std::string svg = plot_svg(plot).value();
  EXPECT_THAT(svg, HasSubstr("a &lt; b &amp; c &gt; d \xEF\xBF\xBD \xEF\xBF\xBD"));
  EXPECT_THAT(svg, HasSubstr("误差（毫米）"));
  EXPECT_TRUE(plot_image(plot));
}

TEST(Plot, EmptyCurvesAndPanelsCanBeDrawn) {
  EXPECT_TRUE(plot_svg({.panels = {{}}}));
  EXPECT_TRUE(plot_image({.panels = {{.lines = {{}}}, {.equal_aspect = true}}}));
}

TEST(Plot, NamesThePanelAndCurveThatAreWrong) {
  Plot plot{.panels = {{}, {.lines = {{}, {.x = {1, 2}, .y = {1}}}}}};
  const Result<std::string> lengths = plot_svg(plot);
  ASSERT_FALSE(lengths);
  EXPECT_EQ(lengths.error().code, Errc::bad_input);
  EXPECT_THAT(lengths.error().what, HasSubstr("panel 2, curve 2: 2 x values but 1 y values"));
  plot = circle();
  plot.panels[0].y_range = {.lower = 1, .upper = 1};
  EXPECT_FALSE(plot_svg(plot));
  plot.panels[0].y_range = {.lower = 0, .upper = std::nan("")};
  EXPECT_FALSE(plot_image(plot));
  EXPECT_FALSE(plot_svg({}));
  plot = circle();
  plot.columns = 0;
  EXPECT_FALSE(plot_svg(plot));
  EXPECT_FALSE(save_plot(circle(), "/no such folder/plot"));
}

/// Two rows of three cells, one of them bare.
Plot chequers() {
  PlotPanel panel{.x_label = "x [m]", .y_label = "y [m]", .equal_aspect = true};
  panel.field = PlotField{.x = {0, 3}, .y = {0, 2}, .columns = 3, .values = {1, 1, 3, 3, 2, 0}};
  panel.field->values[5] = std::nan("");
  panel.field->colors = {.lower = 1, .upper = 3};
  panel.field->whole_numbers = true;
  return {.panels = {panel}, .columns = 1};
}

TEST(Plot, FieldColoursItsCellsFromTheLowestRow) {
  const Image image = plot_image(chequers(), 4).value();
  const std::string svg = plot_svg(chequers()).value();
  for (const char* label : {">1</text>", ">2</text>", ">3</text>"}) {
    EXPECT_THAT(svg, HasSubstr(label));
  }
  // Cells are wider than anything else that is filled but the page: 1 is dark, 3 is bright.
  int dark = 0, bright = 0, low_dark = 0, low_bright = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width * 3 / 4; ++x) {
      const auto [r, g, b] = image.pixel(x, y);
      const bool is_dark = r < 80 && g < 10 && b > 70;
      const bool is_bright = r > 240 && g > 220 && b < 60;
      dark += is_dark ? 1 : 0;
      bright += is_bright ? 1 : 0;
      low_dark += is_dark && y > image.height / 2 ? 1 : 0;
      low_bright += is_bright && y > image.height / 2 ? 1 : 0;
    }
  }
  EXPECT_GT(dark, 1000);
  EXPECT_NEAR(dark, bright, 0.1 * dark);                // two cells each
  EXPECT_GT(low_dark, 0.8 * dark);                      // both in the lower row
  EXPECT_NEAR(low_bright, bright / 2.0, 0.2 * bright);  // one in each
}

TEST(Plot, NamesTheFieldThatIsWrong) {
  Plot plot = chequers();
  plot.panels[0].field->values.push_back(1);
  const Result<std::string> svg = plot_svg(plot);
  ASSERT_FALSE(svg);
  EXPECT_THAT(svg.error().what, HasSubstr("panel 1: 7 values do not fill rows of 3 cells"));
  plot = chequers();
  plot.panels[0].field->columns = 0;
  EXPECT_FALSE(plot_svg(plot));
  plot = chequers();
  plot.panels[0].field->x = {1, 1};
  EXPECT_FALSE(plot_svg(plot));
  plot = chequers();
  plot.panels[0].field->values.assign(6, std::nan(""));
  EXPECT_TRUE(plot_svg(plot));
}

TEST(Runs, CutTextByFontAndMendBadBytes) {
  const std::vector<canvas::Run> runs = canvas::runs_of("a×误差（b");
  ASSERT_EQ(runs.size(), 3U);
  EXPECT_EQ(runs[0].text, "a×");
  EXPECT_EQ(runs[1].text, "误差（");
  EXPECT_TRUE(runs[1].cjk);
  EXPECT_EQ(runs[2].text, "b");
  for (const char* bad : {"\xFF", "\xC0\xAF", "\xED\xA0\x80", "\xF5\x80\x80\x80", "\xE4\xB8"}) {
    for (const canvas::Run& run : canvas::runs_of(bad)) {
      EXPECT_EQ(run.text.size() % 3, 0U) << "only U+FFFD";
      EXPECT_EQ(run.text.substr(0, 3), "\xEF\xBF\xBD");
    }
  }
}

}  // namespace
}  // namespace mjarm::render
