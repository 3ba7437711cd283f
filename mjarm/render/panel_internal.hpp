#pragma once

#include "mjarm/render/axis_internal.hpp"
#include "mjarm/render/canvas_internal.hpp"
#include "mjarm/render/plot.hpp"

/// One pair of axes of a plot on a page.
namespace mjarm::panel {

/// [pt] Room round the axes for labels, legend and title.
struct Margins {
  double left = 0;
  double top = 0;
  double right = 0;
  double bottom = 0;
};

/// Where a panel goes and how much room its labels need.
struct Layout {
  canvas::Box place;  ///< [pt] all of the panel
  Margins margins;    ///< may be enlarged before drawing
};

/// Measures a panel that fills `place`.
[[nodiscard]] Layout measure(const render::PlotPanel& panel, const canvas::Box& place);

/// Adds the panel to a page.
void draw(const render::PlotPanel& panel, const Layout& layout, canvas::Page& page);

}  // namespace mjarm::panel
