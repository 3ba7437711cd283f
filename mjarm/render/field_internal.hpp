#pragma once

#include "mjarm/render/canvas_internal.hpp"
#include "mjarm/render/plot.hpp"

/// The coloured cells of a panel and their scale.
namespace mjarm::field {

/// [pt] room for the scale at the right of the axes.
inline constexpr double kScaleWidth = 42;

/// Fills `box` with the cells.
void draw_cells(const render::PlotField& field, const canvas::Box& box, canvas::Page& page);

/// Draws the scale at the right of the axes `box`.
void draw_scale(const render::PlotField& field, const canvas::Box& box, canvas::Page& page);

}  // namespace mjarm::field
