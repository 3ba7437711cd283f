#pragma once

#include <mujoco/mujoco.h>

#include "mjarm/view/live_plot.hpp"

namespace mjarm::view {

/// Fills a figure that is drawn as wide as high. Curves of more points than a figure
/// holds are thinned evenly; their last point stays.
void fill_figure(const LivePlot& plot, mjvFigure& figure);

}  // namespace mjarm::view
