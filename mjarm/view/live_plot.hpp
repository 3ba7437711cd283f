#pragma once

#include <string>
#include <vector>

#include "mjarm/render/overlay.hpp"
#include "mjarm/render/plot.hpp"

namespace mjarm::view {

/// One curve of a live plot. The caller appends while it runs; long curves are thinned for display.
struct LiveSeries {
  std::string name = {};  ///< in the legend; empty = not in the legend
  render::Rgba color = {0.90F, 0.35F, 0.30F, 1};
  std::vector<double> x = {};                          ///< shape (n,)
  std::vector<double> y = {};                          ///< shape (n,); NaN leaves a gap
  render::LineStyle style = render::LineStyle::solid;  ///< points are drawn as dots along the curve
  bool operator==(const LiveSeries&) const = default;
};

/// A figure at the right edge of a window: a tool path (`equal_aspect`) or curves over time.
struct LivePlot {
  std::string title = {};
  std::string x_label = {};  ///< with its unit
  std::vector<LiveSeries> series = {};
  bool equal_aspect = false;  ///< one unit is equally long on both axes
  bool y_from_zero = false;   ///< the y axis begins at 0 (errors)
  bool over_time = false;     ///< x is the time of a run that is over [s]: what is shown is marked
  bool operator==(const LivePlot&) const = default;
};

}  // namespace mjarm::view
