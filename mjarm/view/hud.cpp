#include <algorithm>
#include <cstdio>
#include <span>
#include <string_view>

#include "mjarm/view/controls.hpp"
#include "mjarm/view/hud_internal.hpp"

namespace mjarm::view {
namespace {

constexpr std::size_t kMaxText = 480;  // mjMAXOVERLAY and what MuJoCo adds
constexpr const char* kHint = "F1: help   right click: settings   Tab: panels   Esc: close";

/// Two columns of text for an overlay.
class Facts {
 public:
  void add(std::string_view name, std::string_view value) {
    if (names_.size() + name.size() > kMaxText || values_.size() + value.size() > kMaxText) {
      return;
    }
    const char* separator = names_.empty() ? "" : "\n";
    names_.append(separator).append(name);
    values_.append(separator).append(value);
  }
  void draw(const mjrRect& view, const mjrContext& context) const {
    mjr_overlay(mjFONT_NORMAL, mjGRID_TOPLEFT, view, names_.c_str(), values_.c_str(), &context);
  }

 private:
  std::string names_;
  std::string values_;
};

template <class... Values>
std::string printed(const char* format, Values... values) {
  char buffer[96];
  std::snprintf(buffer, sizeof(buffer), format, values...);
  return buffer;
}

int text_pixels(std::string_view text, const mjrContext& context) {
  int width = 0;
  for (const char c : text) width += context.charWidth[static_cast<unsigned char>(c) % 127];
  return width;
}

/// One column of the help, with its left edge at `left` [pixels].
int draw_help_rows(std::span<const ControlHelp> rows, const mjrRect& box, int left,
                   const mjrContext& context) {
  const int line = context.charHeight + 4;
  int keys_wide = 0;
  for (const ControlHelp& row : rows) {
    keys_wide = std::max(keys_wide, text_pixels(row.keys, context));
  }
  int width = 0;
  int y = box.height - line - 4;
  for (const ControlHelp& row : rows) {
    const std::string about(row.about.in(Language::english));
    const auto draw = [&](const std::string& text, int x, float shade) {
      mjr_text(mjFONT_NORMAL, text.c_str(), &context,
               static_cast<float>(x) / static_cast<float>(box.width),
               static_cast<float>(y) / static_cast<float>(box.height), shade, shade, shade);
    };
    draw(row.keys, left, 0.7F);
    draw(about, left + keys_wide + context.charHeight, 1);
    width = std::max(width, keys_wide + context.charHeight + text_pixels(about, context));
    y -= line;
  }
  return left + width;
}

void draw_help(const mjrRect& view, const mjrContext& context) {
  const std::vector<ControlHelp> rows = control_help();
  const std::size_t half = (rows.size() + 1) / 2;
  const int line = context.charHeight + 4;
  const int wanted = text_pixels(std::string(100, 'n'), context);
  mjrRect box = view;
  box.width = std::min(view.width, wanted);
  box.height = std::min(view.height, static_cast<int>(half) * line + 12);
  box.left += (view.width - box.width) / 2;
  box.bottom += (view.height - box.height) / 2;
  mjr_rectangle(box, 0, 0, 0, 0.75F);
  const std::span<const ControlHelp> all = rows;
  const int gap = context.charHeight;
  const int right = draw_help_rows(all.first(half), box, gap, context);
  draw_help_rows(all.subspan(half), box, right + 2 * gap, context);
}

}  // namespace

void draw_hud(const HudText& text, const mjrRect& view, const mjrContext& context) {
  Facts facts;
  facts.add("Time", printed(text.paused ? "%.3f s   paused" : "%.3f s", text.time));
  if (text.speed != 1) facts.add("Speed", printed("%g x", text.speed));
  if (!text.camera.empty()) facts.add("Camera", text.camera);
  for (const Picker::Row& row : text.selected) facts.add(row.name, row.value);
  if (text.help) {
    facts.add("Frames", printed("%.0f /s, %.1f ms each", text.stats.fps, text.stats.frame_ms));
    facts.add("Simulation", printed("%.2f x real time", text.stats.sim_rate));
    facts.add("First frame", printed("%.0f ms", text.stats.first_frame_ms));
  }
  facts.draw(view, context);
  std::string foot;
  for (const std::string& line : {text.note, text.status}) {
    if (!line.empty()) foot += line.substr(0, kMaxText / 3) + "\n";
  }
  foot += kHint;
  mjr_overlay(mjFONT_NORMAL, mjGRID_BOTTOMLEFT, view, foot.c_str(), nullptr, &context);
  if (text.help) draw_help(view, context);
}

}  // namespace mjarm::view
