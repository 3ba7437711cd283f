#pragma once

#include <mujoco/mujoco.h>

#include "mjarm/view/live_plot.hpp"
#include "mjarm/view/text_block_internal.hpp"

namespace mjarm::view {

/// Fills a figure that is drawn as wide as high. Curves of more points than a figure
/// holds are thinned evenly; their last point stays. Texts that are not ASCII are left to
/// `draw_figure`.
void fill_figure(const LivePlot& plot, mjvFigure& figure);

/// Draws a figure that was filled from `plot`.
void draw_figure(const LivePlot& plot, mjvFigure& figure, mjrRect place, const TextTools& tools);

}  // namespace mjarm::view
