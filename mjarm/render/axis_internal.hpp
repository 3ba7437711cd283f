#pragma once

#include <string>
#include <vector>

#include "mjarm/render/plot.hpp"

/// The arithmetic of a plot's axes: ranges, ticks and their labels.
namespace mjarm::axis {

/// Grows as values are seen; NaN and infinities are not.
class Extent {
 public:
  void add(double value);
  /// What was seen, widened by `margin` (a share of its length) at both ends and to a length that
  /// can be drawn; [0, 1] where nothing was seen.
  [[nodiscard]] render::PlotRange range(double margin) const;

 private:
  bool seen_ = false;
  double lower_ = 0;
  double upper_ = 0;
};

/// Where an axis is marked, and how.
struct Ticks {
  std::vector<double> at;           ///< rising, inside the range
  std::vector<std::string> labels;  ///< one a tick
  std::string factor;               ///< what every label is multiplied by, e.g. "×10⁻³"; or empty
};

/// About `count` ticks at multiples of 1, 2 or 5 times a power of ten.
/// @param range lower < upper, both finite.
[[nodiscard]] Ticks ticks_for(const render::PlotRange& range, int count);

/// Marks of an axis of logarithms: powers of ten; where that are too few, 2 and 5 times them too.
/// @param range  of the logarithms to base 10; so are the places of the marks.
[[nodiscard]] Ticks log_ticks_for(const render::PlotRange& range, int count);

/// Widens the range whose unit is drawn longer, so that a unit has one length on both axes.
/// @param width, height of the drawn area, > 0.
void equalise(render::PlotRange& x, render::PlotRange& y, double width, double height);

}  // namespace mjarm::axis
