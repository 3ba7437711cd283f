#pragma once

#include <mujoco/mujoco.h>

#include <string>
#include <vector>

#include "mjarm/view/controls.hpp"
#include "mjarm/view/pick_internal.hpp"
#include "mjarm/view/text_block_internal.hpp"
#include "mjarm/view/view_stats.hpp"

namespace mjarm::view {

/// What stands as text over the picture.
struct HudText {
  double time = 0;  ///< [s] of the state shown
  bool paused = false;
  double speed = 1;
  std::string camera = {};  ///< empty = free
  std::vector<Picker::Row> selected = {};
  std::string status = {};  ///< of the application
  std::string note = {};    ///< of the window
  bool help = false;
  std::vector<ControlHelp> help_rows = {};  ///< empty: control_help()
  ViewStats stats = {};
};

/// Draws it into the current buffer: facts at the upper left, lines at the lower left, the help in
/// the middle.
void draw_hud(const HudText& text, const mjrRect& view, const TextTools& tools);

}  // namespace mjarm::view
