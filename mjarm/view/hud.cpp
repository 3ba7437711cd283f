#include <algorithm>
#include <span>

#include "mjarm/core/messages/view.hpp"
#include "mjarm/view/controls.hpp"
#include "mjarm/view/hud_internal.hpp"

namespace mjarm::view {
namespace {

/// One column of the help, with its left edge at `left` [pixels of the window].
/// @return its right edge.
int draw_help_rows(std::span<const ControlHelp> rows, int left, int top, const TextTools& tools) {
  int keys_wide = 0;
  for (const ControlHelp& row : rows) keys_wide = std::max(keys_wide, tools.width(row.keys));
  const int about_left = left + keys_wide + tools.context.charHeight;
  int right = about_left;
  int y = top - tools.line();
  for (const ControlHelp& row : rows) {
    tools.draw(row.keys, left, y, 0.7F);
    tools.draw(row.about, about_left, y, 1);
    right = std::max(right, about_left + tools.width(row.about));
    y -= tools.line();
  }
  return right;
}

void draw_help(const std::vector<ControlHelp>& chosen, const mjrRect& view,
               const TextTools& tools) {
  const std::vector<ControlHelp> rows = chosen.empty() ? control_help() : chosen;
  const std::size_t half = (rows.size() + 1) / 2;
  const int wanted = tools.width(std::string(100, 'n'));
  mjrRect box = view;
  box.width = std::min(view.width, wanted);
  box.height = std::min(view.height, static_cast<int>(half) * tools.line() + 12);
  box.left += (view.width - box.width) / 2;
  box.bottom += (view.height - box.height) / 2;
  mjr_rectangle(box, 0, 0, 0, 0.75F);
  const std::span<const ControlHelp> all = rows;
  const int gap = tools.context.charHeight;
  const int top = box.bottom + box.height - 4;
  const int right = draw_help_rows(all.first(half), box.left + gap, top, tools);
  draw_help_rows(all.subspan(half), right + 2 * gap, top, tools);
}

std::vector<TextRow> facts_of(const HudText& hud) {
  std::vector<TextRow> rows = {
      {text(msg::view_time),
       text(hud.paused ? msg::view_time_paused : msg::view_time_value, hud.time)}};
  if (hud.speed != 1)
    rows.push_back({text(msg::view_speed), text(msg::view_speed_value, hud.speed)});
  if (!hud.camera.empty()) rows.push_back({text(msg::view_camera), hud.camera});
  for (const Picker::Row& row : hud.selected) rows.push_back({row.name, row.value});
  if (hud.help) {
    rows.push_back(
        {text(msg::view_frames), text(msg::view_frames_value, hud.stats.fps, hud.stats.frame_ms)});
    rows.push_back({text(msg::view_simulation), text(msg::view_sim_rate, hud.stats.sim_rate)});
    rows.push_back({text(msg::view_first_frame), text(msg::view_ms, hud.stats.first_frame_ms)});
  }
  return rows;
}

}  // namespace

void draw_hud(const HudText& hud, const mjrRect& view, const TextTools& tools) {
  draw_text_block(facts_of(hud), view, true, tools);
  std::vector<TextRow> foot;
  for (const std::string& line : {hud.note, hud.status, text(msg::view_hint)}) {
    if (!line.empty()) foot.push_back({line});
  }
  draw_text_block(foot, view, false, tools);
  if (hud.help) draw_help(hud.help_rows, view, tools);
}

}  // namespace mjarm::view
