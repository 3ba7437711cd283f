#pragma once

#include <mujoco/mujoco.h>

#include <vector>

#include "mjarm/view/glyph_font_internal.hpp"
#include "mjarm/view/panel_section.hpp"

namespace mjarm::view {

/// A panel of MuJoCo's user interface, and what it shows.
struct LabelledUi {
  const mjUI& ui;
  const std::vector<PanelSection>& sections;
  const std::vector<std::vector<int>>& first_lines;  ///< of each item's list, as it is shown
};

/// Draws those texts of a panel over it that are not ASCII, each where MuJoCo would have drawn it.
void draw_labels(const LabelledUi& panel, const mjuiState& state, const mjrContext& context,
                 GlyphFont& font);

}  // namespace mjarm::view
