// Plots read back from their SVG files: the numbers by the axes, where panels and legends stand,
// colours. The reader is strict, so whatever passes here is well-formed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/render/canvas_internal.hpp"
#include "mjarm/render/plot.hpp"
#include "mjarm/render/svg_reader_test.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::render {
namespace {

using ::testing::HasSubstr;
using testing::SvgElement;
using testing::SvgReader;
using Svg = std::vector<SvgElement>;

Svg svg_of(const Plot& plot) { return SvgReader::read(plot_svg(plot).value()); }

Plot one_panel(PlotPanel panel) { return {.panels = {std::move(panel)}, .columns = 1}; }

/// The axes of each panel, by the line at their left and bottom.
std::vector<canvas::Box> axes_in(const Svg& svg) {
  std::vector<canvas::Box> out;
  for (const SvgElement& element : svg) {
    if (element.name != "polyline" || !element.is("stroke-width", "0.7")) continue;
    const auto p = element.points();
    if (p.size() != 3) continue;
    out.push_back({p[0].first, p[0].second, p[2].first - p[1].first, p[1].second - p[0].second});
  }
  return out;
}

/// Curves of that colour, without what stands in legends (which is not clipped).
std::vector<SvgElement> curves_in(const Svg& svg, const std::string& color) {
  std::vector<SvgElement> out;
  std::ranges::copy_if(svg, std::back_inserter(out), [&](const SvgElement& element) {
    return element.name == "polyline" && element.parents == "svg/g/" && element.is("stroke", color);
  });
  return out;
}

/// "×10⁻³" as 1e-3.
double factor_of(const std::string& text) {
  static const char* kDigits[] = {"\u2070", "\u00B9", "\u00B2", "\u00B3", "\u2074",
                                  "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  std::string rest = text.substr(std::string("\u00D710").size());
  int sign = 1, exponent = 0;
  if (rest.rfind("\u207B", 0) == 0) {
    sign = -1;
    rest.erase(0, std::string("\u207B").size());
  }
  while (!rest.empty()) {
    int digit = 0;
    while (rest.rfind(kDigits[digit], 0) != 0) ++digit;
    exponent = 10 * exponent + digit;
    rest.erase(0, std::string(kDigits[digit]).size());
  }
  return std::pow(10.0, sign * exponent);
}

/// Value = offset + slope * place, from the labels of one axis.
struct Scale {
  double offset = 0, slope = 0;
  [[nodiscard]] double at(double place) const { return offset + slope * place; }
};

/// By the first and the last label beside the only axes; all others must lie on that line.
Scale scale_in(const Svg& svg, bool x_axis) {
  const canvas::Box box = axes_in(svg).at(0);
  std::vector<std::pair<double, double>> marks;  // place, value
  double factor = 1;
  for (const SvgElement& element : svg) {
    if (element.name != "text" || !element.is("font-size", "7")) continue;
    const bool below = element.number("y") > box.y + box.height + 5;
    if (element.text.rfind("\u00D710", 0) == 0) {
      if (below == x_axis) factor = factor_of(element.text);
      continue;
    }
    if (below != x_axis || !element.is("text-anchor", x_axis ? "middle" : "end")) continue;
    std::string digits = element.text;
    if (digits.rfind("\u2212", 0) == 0) digits.replace(0, 3, "-");
    marks.emplace_back(x_axis ? element.number("x") : element.number("y") - 2.5, std::stod(digits));
  }
  EXPECT_GE(marks.size(), 2U);
  const auto [p0, v0] = marks.front();
  const auto [p1, v1] = marks.back();
  const double slope = (v1 - v0) / (p1 - p0);
  for (const auto& [place, value] : marks) {
    EXPECT_NEAR(value, v0 + slope * (place - p0), 0.02 * std::abs(slope)) << "labels are even";
  }
  return {factor * (v0 - slope * p0), factor * slope};
}

TEST(PlotPages, NumbersAreReadBackFromTheirPlaces) {
  Rng rng(3);
  for (int round = 0; round < 60; ++round) {
    const double x_size = std::pow(10.0, rng.uniform(-7, 7)),
                 y_size = std::pow(10.0, rng.uniform(-7, 7));
    const double x_begin = x_size * rng.uniform(-3, 3), y_begin = y_size * rng.uniform(-3, 3);
    PlotLine line;
    for (int i = 0; i < 12; ++i) {
      line.x.push_back(x_begin + x_size * i / 11);
      line.y.push_back(y_begin + y_size * rng.uniform(0, 1));
    }
    const Svg svg = svg_of(one_panel({.x_label = "x", .lines = {line}}));
    const Scale x = scale_in(svg, true), y = scale_in(svg, false);
    const std::vector<SvgElement> curves = curves_in(svg, "#0072b2");
    ASSERT_EQ(curves.size(), 1U);
    const auto points = curves[0].points();
    ASSERT_EQ(points.size(), 12U);
    for (std::size_t i = 0; i < 12; ++i) {
      ASSERT_NEAR(x.at(points[i].first), line.x[i], 0.03 * std::abs(x.slope)) << round;
      ASSERT_NEAR(y.at(points[i].second), line.y[i], 0.03 * std::abs(y.slope)) << round;
    }
  }
}

TEST(PlotPages, RangesThatAreAskedForAreTheEndsOfTheAxes) {
  PlotPanel panel{.lines = {{.x = {0, 1, 2}, .y = {-5, 0, 5}}}};
  panel.x_range = {.lower = -1, .upper = 4};
  panel.y_range = {.lower = -1, .upper = 3};
  const Svg svg = svg_of(one_panel(panel));
  const canvas::Box box = axes_in(svg).at(0);
  EXPECT_NEAR(scale_in(svg, true).at(box.x), -1, 0.002);
  EXPECT_NEAR(scale_in(svg, true).at(box.x + box.width), 4, 0.002);
  EXPECT_NEAR(scale_in(svg, false).at(box.y + box.height), -1, 0.002);
  EXPECT_NEAR(scale_in(svg, false).at(box.y), 3, 0.002);
  // What is beyond is drawn all the same and clipped to the axes.
  const auto clip = std::ranges::find_if(
      svg, [](const SvgElement& e) { return e.parents == "svg/defs/clipPath/"; });
  ASSERT_NE(clip, svg.end());
  EXPECT_NEAR(clip->number("x"), box.x, 0.011);
  EXPECT_NEAR(clip->number("width"), box.width, 0.011);
  EXPECT_NEAR(clip->number("height"), box.height, 0.011);
  panel.y_range.reset();
  panel.lines[0].y = {2, 3, 4};
  panel.y_from_zero = true;
  const Svg zero = svg_of(one_panel(panel));
  const canvas::Box from_zero = axes_in(zero).at(0);
  EXPECT_NEAR(scale_in(zero, false).at(from_zero.y + from_zero.height), 0, 0.002);
}

/// In pages of any shape: panels row by row, axes in line, nothing on top of each other or outside.
TEST(PlotPages, PanelsStandInAGrid) {
  for (const auto& [count, columns] :
       {std::pair(1, 5), std::pair(2, 1), std::pair(4, 2), std::pair(5, 3), std::pair(7, 3)}) {
    Plot plot{.title = "t", .note = "n", .columns = columns};
    for (int i = 0; i < count; ++i) {
      // Panels of unlike needs: long labels, a title or none, a scale at the right.
      PlotPanel panel{.title = i % 2 == 0 ? "title" : "", .x_label = i % 3 == 0 ? "x" : ""};
      panel.lines = {{.x = {0, 1}, .y = {0, std::pow(10.0, i)}, .label = i % 3 == 1 ? "a" : ""}};
      if (i % 4 == 3) {
        panel.field = PlotField{.x = {0, 1}, .y = {0, 1}, .columns = 1, .values = {1, 2}};
      }
      plot.panels.push_back(panel);
    }
    const Svg svg = svg_of(plot);
    const std::vector<canvas::Box> axes = axes_in(svg);
    ASSERT_EQ(axes.size(), static_cast<std::size_t>(count));
    const double width = svg[0].number("width"), height = svg[0].number("height");
    const int used = std::min(columns, count);
    EXPECT_NEAR(width, 16 + 270 * used, 1e-9);
    for (int i = 0; i < count; ++i) {
      const canvas::Box& box = axes[static_cast<std::size_t>(i)];
      EXPECT_GT(box.width, 100);
      EXPECT_GT(box.height, 80);
      EXPECT_GE(box.x, 8 + 270 * (i % used));
      EXPECT_LE(box.x + box.width, 8 + 270 * (i % used + 1));
      EXPECT_LT(box.y + box.height, height);
      if (i >= used) {
        const canvas::Box& above = axes[static_cast<std::size_t>(i - used)];
        EXPECT_NEAR(box.x, above.x, 0.011) << "one edge in a column";
        EXPECT_GT(box.y, above.y + above.height);
      }
      if (i % used > 0) {
        const canvas::Box& left = axes[static_cast<std::size_t>(i - 1)];
        EXPECT_NEAR(box.y, left.y, 0.011) << "one edge in a row";
        EXPECT_NEAR(box.height, left.height, 0.011);
        EXPECT_GT(box.x, left.x + left.width);
      }
    }
    for (const SvgElement& element : svg) {
      if (element.name != "text") continue;
      EXPECT_TRUE(element.number("x") >= 0 && element.number("x") <= width) << element.text;
      EXPECT_TRUE(element.number("y") >= 0 && element.number("y") <= height) << element.text;
    }
  }
}

TEST(PlotPages, LegendsWrapAboveTheirAxes) {
  PlotPanel panel{.title = "many"};
  for (int i = 0; i < 14; ++i) {
    panel.lines.push_back(
        {.x = {0, 1}, .y = {0, 1.0 * i}, .label = "joint number " + std::to_string(i)});
  }
  panel.lines.push_back({.x = {0, 1}, .y = {1, 2}});
  panel.bands.push_back({.lower = 1, .upper = 2, .label = "tolerance"});
  const Svg svg = svg_of(one_panel(panel));
  const canvas::Box box = axes_in(svg).at(0);
  std::vector<const SvgElement*> entries;
  for (const SvgElement& element : svg) {
    if (element.name == "text" && element.is("font-size", "7.5")) entries.push_back(&element);
  }
  ASSERT_EQ(entries.size(), 15U) << "what has no label has no entry";
  EXPECT_EQ(entries.back()->text, "tolerance");
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const double x = entries[i]->number("x"), y = entries[i]->number("y");
    EXPECT_LE(x + canvas::text_width(entries[i]->text, {.size = 7.5}), box.x + box.width + 0.01);
    EXPECT_GE(x, box.x);
    EXPECT_LT(y, box.y);
    if (i == 0) continue;
    const double before_x = entries[i - 1]->number("x"), before_y = entries[i - 1]->number("y");
    EXPECT_TRUE((y == before_y && x > before_x) || y > before_y + 7.5) << entries[i]->text;
  }
  panel.legend = false;
  for (const SvgElement& element : svg_of(one_panel(panel))) {
    EXPECT_NE(element.text, "tolerance");
  }
}

/// Millions of panel heights away: cairo would lose it.
TEST(PlotPages, BandsFarBeyondTheirAxesAreDrawnAllTheSame) {
  PlotPanel panel{.title = "distance"};
  panel.lines.push_back({.x = {0, 1}, .y = {0, 1e-10}});
  panel.bands.push_back({.lower = 0, .upper = 5e-4, .label = "tolerance", .fits = false});
  const Svg svg = svg_of(one_panel(panel));
  const canvas::Box box = axes_in(svg).at(0);
  int bands = 0;
  for (const SvgElement& element : svg) {
    if (element.name != "rect" || element.parents != "svg/g/") continue;
    EXPECT_LT(element.number("y"), box.y);
    EXPECT_LT(element.number("height"), 2.1e5);
    ++bands;
  }
  EXPECT_GE(bands, 1);
}

/// A colour that is asked for takes none from those that are given in turn.
TEST(PlotPages, ColoursAreGivenInTurnAndGoRound) {
  const auto hex = [](const Rgba& color) {
    char text[8];
    std::snprintf(text, sizeof(text), "#%02x%02x%02x",
                  static_cast<unsigned>(std::lround(255 * color.r)),
                  static_cast<unsigned>(std::lround(255 * color.g)),
                  static_cast<unsigned>(std::lround(255 * color.b)));
    return std::string(text);
  };
  PlotPanel panel;
  const int asked[] = {-1, 5, -1, PlotLine::kInk, -1, 9};
  const int expected[] = {0, 5, 1, PlotLine::kInk, 2, 1};
  for (const int color : asked) panel.lines.push_back({.x = {0, 1}, .y = {0, 1}, .color = color});
  std::vector<std::string> seen;
  for (const SvgElement& element : svg_of(one_panel(panel))) {
    if (element.name == "polyline" && element.parents == "svg/g/") {
      seen.push_back(element.attributes.at("stroke"));
    }
  }
  ASSERT_EQ(seen.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(seen[i], expected[i] < 0 ? "#333333" : hex(plot_color(expected[i]))) << i;
  }
  for (int i = 0; i < 8; ++i) {
    EXPECT_EQ(plot_color(i), plot_color(i + 8));
    for (int k = 0; k < i; ++k) EXPECT_NE(plot_color(i), plot_color(k));
  }
}

TEST(PlotPages, BandsAndPointsAreWhereTheirNumbersAre) {
  PlotPanel panel{
      .lines = {{.x = {0, 1, std::nan(""), 3}, .y = {0, 1, 2, 4}, .style = LineStyle::points}},
      .bands = {{.lower = -1, .upper = 1.5}, {.lower = 70, .upper = 80, .fits = false}}};
  const Svg svg = svg_of(one_panel(panel));
  const Scale x = scale_in(svg, true), y = scale_in(svg, false);
  std::vector<double> tops, bottoms, dots;
  for (const SvgElement& element : svg) {
    if (element.name == "circle") {
      dots.push_back(x.at(element.number("cx")));
      dots.push_back(y.at(element.number("cy")));
    }
    if (element.name != "rect" || element.parents != "svg/g/") continue;
    tops.push_back(y.at(element.number("y")));
    bottoms.push_back(y.at(element.number("y") + element.number("height")));
  }
  const auto near = [](double value) { return ::testing::DoubleNear(value, 0.05); };
  EXPECT_THAT(tops, ::testing::ElementsAre(near(1.5), near(80)));
  EXPECT_THAT(bottoms, ::testing::ElementsAre(near(-1), near(70)));
  EXPECT_THAT(dots, ::testing::ElementsAre(near(0), near(0), near(1), near(1), near(3), near(4)));
  EXPECT_LT(y.at(axes_in(svg).at(0).y), 6) << "the second band does not stretch the axis";
}

/// Each cell has the colour that the scale beside it has at its value.
TEST(PlotPages, CellsHaveTheColourOfTheScaleAtTheirValue) {
  PlotField field{.x = {0, 4}, .y = {0, 1}, .columns = 4, .values = {0, 10, 20, 30}};
  const Svg svg = svg_of(one_panel({.field = field}));
  const canvas::Box box = axes_in(svg).at(0);
  std::vector<const SvgElement*> cells, shades;
  for (const SvgElement& element : svg) {
    if (element.name != "rect" || element.parents.find("clipPath") != std::string::npos) continue;
    if (element.parents == "svg/g/") cells.push_back(&element);
    if (element.parents == "svg/" && element.number("x") > box.x + box.width) {
      shades.push_back(&element);
    }
  }
  ASSERT_EQ(cells.size(), 4U);
  ASSERT_EQ(shades.size(), 64U);
  EXPECT_EQ(cells.front()->attributes.at("fill"), shades.front()->attributes.at("fill"));
  EXPECT_EQ(cells.back()->attributes.at("fill"), shades.back()->attributes.at("fill"));
  EXPECT_EQ(cells[1]->attributes.at("fill"), shades[21]->attributes.at("fill"));
  EXPECT_EQ(cells[2]->attributes.at("fill"), shades[42]->attributes.at("fill"));
  // Shades rise in brightness, so that they read in grey as well.
  const auto grey = [](const SvgElement& element) {
    const auto rgb = std::stoul(element.attributes.at("fill").substr(1), nullptr, 16);
    return 0.3 * static_cast<double>(rgb >> 16) + 0.6 * static_cast<double>((rgb >> 8) & 255U) +
           0.1 * static_cast<double>(rgb & 255U);
  };
  for (std::size_t i = 8; i < 64; i += 8) EXPECT_GT(grey(*shades[i]), grey(*shades[i - 8]));
  // Equal neighbours are one rectangle, and bare cells none.
  field.values = {5, 5, std::nan(""), 7};
  field.whole_numbers = true;
  std::size_t count = 0;
  for (const SvgElement& element : svg_of(one_panel({.field = field}))) {
    count += element.name == "rect" && element.parents == "svg/g/" ? 1U : 0U;
  }
  EXPECT_EQ(count, 2U);
}

TEST(PlotPages, NamesOfTheTwoCurvesAreInTheLanguageInUse) {
  const LanguageScope chinese(Language::chinese);
  EXPECT_EQ(planned_line({}, {}).label, "规划");
  EXPECT_EQ(executed_line({}, {}).label, "实际");
  const Result<std::string> bad = plot_svg(one_panel({.lines = {{.x = {1}, .y = {}}}}));
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().what, "图表第 1 格、第 1 条曲线：x 有 1 个值，y 有 0 个值");
}

TEST(PlotPages, EveryRefusalNamesThePanelAndTheNumbers) {
  const auto why = [](const Plot& plot) {
    const Result<std::string> svg = plot_svg(plot);
    const Result<Image> image = plot_image(plot);
    EXPECT_FALSE(svg || image);
    EXPECT_EQ(svg.error().what, image.error().what) << "both ways refuse the same";
    EXPECT_EQ(svg.error().code, Errc::bad_input);
    return svg.error().what;
  };
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(why({}), "plot: no panels, or panels smaller than 120 pt");
  for (const double size : {119.9, -1.0, std::nan("")}) {
    EXPECT_EQ(why({.panels = {{}}, .panel_width = size}), why({}));
    EXPECT_EQ(why({.panels = {{}}, .panel_height = size}), why({}));
  }
  EXPECT_EQ(why({.panels = {{}, {.x_range = {{.lower = 2, .upper = 1}}}}}),
            "plot, panel 2: the range [2, 1] is empty");
  EXPECT_EQ(why({.panels = {{.y_range = {{.lower = 0, .upper = inf}}}}}),
            "plot, panel 1: the range [0, inf] is empty");
  PlotField field{.x = {0, 1}, .y = {0, 1}, .columns = 2};
  EXPECT_EQ(why({.panels = {{.field = field}}}),
            "plot, panel 1: 0 values do not fill rows of 2 cells");
  field.values = {1, 2};
  field.colors = {.lower = 3, .upper = 3};
  EXPECT_EQ(why({.panels = {{.field = field}}}), "plot, panel 1: the range [3, 3] is empty");
}

TEST(PlotPages, ASecondRunReplacesBothFilesOrNone) {
  const support::TempFolder folder;
  const Plot first = one_panel({.lines = {{.x = {0, 1}, .y = {0, 1}}}});
  ASSERT_TRUE(save_plot(first, folder.path() / "plot"));
  const std::string svg = folder.read("plot.svg"), png = folder.read("plot.png");
  Plot bad = first;
  bad.panels[0].lines[0].y.pop_back();
  EXPECT_FALSE(save_plot(bad, folder.path() / "plot"));
  EXPECT_EQ(folder.read("plot.svg"), svg);
  EXPECT_EQ(folder.read("plot.png"), png);
  Plot second = first;
  second.panels[0].lines[0].y[1] = -4;
  ASSERT_TRUE(save_plot(second, folder.path() / "plot"));
  EXPECT_NE(folder.read("plot.svg"), svg);
  EXPECT_NE(folder.read("plot.png"), png);
}

TEST(PlotNumbers, ThatAreNoneAreRefused) {
  const PlotPanel panel{.lines = {{.x = {0, 1}, .y = {0, 1}}},
                        .bands = {{.lower = std::nan(""), .upper = 1}}};
  EXPECT_FALSE(plot_svg({.panels = {panel}}));
  EXPECT_FALSE(plot_svg({.panels = {{}}, .panel_width = INFINITY}));
}

/// An axis of logarithms is marked with the values themselves; equal ratios are equally far apart.
TEST(PlotPages, LogarithmicAxesAreMarkedWithValues) {
  PlotPanel panel{.x_label = "time [us]", .y_label = "share"};
  panel.x_log = panel.y_log = true;
  panel.lines.push_back({.x = {1, 10, 100, 1000, 0, 1e5}, .y = {2, 20, 200, 2000, 5, 2e5}});
  const auto svg = testing::SvgReader::read(plot_svg({.panels = {panel}, .columns = 1}).value());
  std::map<std::string, double> places;
  std::vector<std::pair<double, double>> points;
  for (const testing::SvgElement& element : svg) {
    if (element.name == "text" && !element.is("text-anchor", "end")) {
      places[element.text] = element.number("x");
    }
    if (element.name == "polyline" && element.points().size() > 3) points = element.points();
  }
  ASSERT_EQ(points.size(), 4U) << "0 has no place, and ends the curve";
  for (const char* mark : {"1", "10", "100", "1000"}) EXPECT_EQ(places.count(mark), 1U) << mark;
  EXPECT_EQ(places.count("10\u2074"), 1U);
  EXPECT_NEAR(places["10"] - places["1"], places["1000"] - places["100"], 0.1);
  EXPECT_NEAR(points[1].first, places["10"], 0.1);
  panel.x_range = PlotRange{0, 10};
  EXPECT_FALSE(plot_svg({.panels = {panel}, .columns = 1})) << "0 cannot be on it";
}

}  // namespace
}  // namespace mjarm::render
