#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/render/image.hpp"
#include "mjarm/render/overlay.hpp"

namespace mjarm::render {

/// How a curve is drawn. Habit of mjarm: planned = dashed, executed = solid, limits = dotted.
enum class LineStyle { solid, dashed, dotted, points };

/// One curve of a panel. NaN in `x` or `y` leaves a gap.
struct PlotLine {
  std::vector<double> x = {};  ///< shape (n,), in the unit of the panel's x axis
  std::vector<double> y = {};  ///< shape (n,)
  std::string label = {};      ///< name in the legend; empty = not in the legend
  LineStyle style = LineStyle::solid;
  int color = -1;  ///< index into the palette (8 colours that colour-blind readers can tell
                   ///< apart, then again from the first); -1 = next one of the panel; kInk = ink
  double width = 1.4;  ///< [pt] > 0
  bool fits = true;    ///< the axes reach as far as this curve; false: drawn as far as they reach

  static constexpr int kInk = -2;  ///< dark grey, for planned curves and limits
};

/// A curve as it was planned (thin, dashed, ink) and as it was executed (wide, solid, vermilion),
/// with their names in the user's language. Add the executed one first, so that both are seen.
[[nodiscard]] PlotLine planned_line(std::vector<double> x, std::vector<double> y);
[[nodiscard]] PlotLine executed_line(std::vector<double> x, std::vector<double> y);

/// Limits of joints as dotted lines between two places of the x axis: joint j in colour j, what
/// several joints share once, in ink. Infinite limits have none.
/// @param lower, upper  shape (dof,), in the unit of the panel's y axis.
/// @param label         of the first line; empty = none has one.
[[nodiscard]] std::vector<PlotLine> limit_lines(std::span<const double> lower,
                                                std::span<const double> upper, double from,
                                                double to, const std::string& label = {});

/// The colour of the palette with an index >= 0.
[[nodiscard]] Rgba plot_color(int index);

/// A shaded strip between two heights (a tolerance), behind the curves.
struct PlotBand {
  double lower = 0;        ///< in the unit of the panel's y axis
  double upper = 0;        ///< >= lower
  std::string label = {};  ///< name in the legend; empty = not in the legend
  bool fits = true;        ///< the y axis reaches as far as this strip
};

/// A range of an axis; `lower` < `upper`.
struct PlotRange {
  double lower = 0;
  double upper = 1;
};

/// A grid of cells coloured by their value, behind the curves, with a scale at the right.
struct PlotField {
  PlotRange x = {};                 ///< left edge of the first column and right edge of the last
  PlotRange y = {};                 ///< lower edge of the first row and upper edge of the last
  int columns = 0;                  ///< > 0
  std::vector<double> values = {};  ///< shape (rows, columns), the lowest row first; NaN: bare
  std::optional<PlotRange> colors = {};  ///< values of the first and the last colour; default:
                                         ///< fits the data
  bool whole_numbers = false;            ///< one colour a number, for counts
};

/// One pair of axes.
struct PlotPanel {
  std::string title = {};    ///< empty = none
  std::string x_label = {};  ///< with its unit, e.g. "time [s]"
  std::string y_label = {};  ///< with its unit
  std::vector<PlotLine> lines = {};
  std::vector<PlotBand> bands = {};
  std::optional<PlotField> field = {};
  bool equal_aspect = false;  ///< one unit is equally long on both axes (tool paths)
  bool legend = true;         ///< shown where a curve or band has a label
  bool y_from_zero = false;   ///< the y axis begins at 0 (errors, speeds)
  bool over_time = false;     ///< x is the time of the run [s]: a page marks what is shown
  bool x_log = false;         ///< equal ratios are equally long; what is not > 0 is left out
  bool y_log = false;         ///< the same of the y axis
  std::optional<PlotRange> x_range = {};  ///< default: fits the data
  std::optional<PlotRange> y_range = {};
};

/// A page of panels, filled row by row.
struct Plot {
  std::string title = {};  ///< empty = none
  std::string note = {};   ///< small line at the foot, e.g. the worst error; empty = none
  std::vector<PlotPanel> panels = {};
  int columns = 2;            ///< >= 1
  double panel_width = 270;   ///< [pt] of one panel with its labels, >= 120
  double panel_height = 200;  ///< [pt]
};

/// The plot as an SVG file in memory: text stays text, equal plots give equal bytes.
/// @return bad_input that names the panel and curve whose lengths differ or whose range is empty.
[[nodiscard]] Result<std::string> plot_svg(const Plot& plot);

/// The plot as a picture; `pixels_per_point` = 2 suits a screen, 4 a printed page.
[[nodiscard]] Result<Image> plot_image(const Plot& plot, double pixels_per_point = 2);

/// Writes `STEM.svg` and `STEM.png`, each in one step.
/// @param stem path without extension, e.g. "out/plot".
[[nodiscard]] Result<void> save_plot(const Plot& plot, const std::filesystem::path& stem);

}  // namespace mjarm::render
