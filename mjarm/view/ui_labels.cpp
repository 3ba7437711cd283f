#include <cmath>
#include <string_view>

#include "mjarm/view/ui_labels_internal.hpp"

namespace mjarm::view {
namespace {

/// Draws texts at places of the user interface, as MuJoCo lays them out (mjui_update).
class LabelPen {
 public:
  LabelPen(const mjUI& ui, const mjuiState& state, const mjrContext& context, GlyphFont& font)
      : ui_(ui), state_(state), context_(context), font_(font) {
    const mjrRect& place = state.rect[ui.rectid];
    left_ = place.left;
    bottom_ = place.bottom + place.height - ui.height + ui.scroll;
  }
  /// A length of the theme [pixels].
  [[nodiscard]] int scaled(int length) const {
    return static_cast<int>(std::lround(length * 0.01 * context_.fontScale));
  }
  [[nodiscard]] int margin() const { return scaled(ui_.spacing.texthor); }
  [[nodiscard]] int line_height() const {
    return context_.charHeight + 2 * scaled(ui_.spacing.textver);
  }
  /// What is beneath the box [pixels of the user interface] is not drawn from now on.
  void cover(const mjrRect& box) { covered_ = box; }
  /// @param line  the text's line, a margin wider than the text at either side.
  void draw(std::string_view text, const mjrRect& line, const float rgb[3]) {
    if (is_ascii(text) || touches_cover(line)) return;
    const mjrRect& whole = state_.rect[0];
    const mjrRect& panel = state_.rect[ui_.rectid];
    const PixelBox box{line.left + margin() + left_,
                       line.bottom + scaled(ui_.spacing.textver) + bottom_,
                       panel.width - line.left - margin(), context_.charHeight + margin()};
    font_.draw(text, {0, 0, whole.width, whole.height}, box, rgb, line.width - 2 * margin());
  }

 private:
  [[nodiscard]] bool touches_cover(const mjrRect& line) const {
    return line.bottom < covered_.bottom + covered_.height &&
           line.bottom + line.height > covered_.bottom &&
           line.left < covered_.left + covered_.width && line.left + line.width > covered_.left;
  }
  const mjUI& ui_;
  const mjuiState& state_;
  const mjrContext& context_;
  GlyphFont& font_;
  int left_;
  int bottom_;
  mjrRect covered_ = {0, 0, 0, 0};
};

/// Line `index` of `count` that stand below each other from the upper edge of a place.
mjrRect line_in(const mjrRect& place, int index, int count, int height) {
  return {place.left, place.bottom + (count - 1 - index) * height, place.width, height};
}

void draw_item(LabelPen& pen, const mjUI& ui, const mjuiSection& section, const mjuiItem& drawn,
               const PanelItem& item, int first_line) {
  const float* rgb = drawn.state != 0 ? ui.color.fontactive : ui.color.fontinactive;
  const mjrRect& place = drawn.rect;
  if (drawn.type == mjITEM_BUTTON || drawn.type == mjITEM_CHECKINT) {
    pen.draw(item.name, place, rgb);
    return;
  }
  const int side = section.rcontent.left + pen.scaled(ui.spacing.itemside);
  pen.draw(item.name, {side, place.bottom, pen.scaled(ui.spacing.label), place.height}, rgb);
  if (const auto* text = std::get_if<PanelText>(&item.what)) {
    pen.draw(text->value, place, rgb);
  } else if (const auto* choice = std::get_if<PanelChoice>(&item.what)) {
    const auto current = static_cast<std::size_t>(*static_cast<const int*>(drawn.pdata));
    if (current < choice->words.size()) pen.draw(choice->words[current], place, rgb);
  } else if (const auto* list = std::get_if<PanelList>(&item.what)) {
    const int count = drawn.multi.nelem;
    for (int i = 0; i < count; ++i) {
      const auto line = static_cast<std::size_t>(first_line + i);
      if (line >= list->lines.size()) break;
      pen.draw(list->lines[line], line_in(place, i, count, pen.line_height()), rgb);
    }
  }
}

/// The words of a menu that is open hide what is beneath it.
void draw_open_menu(LabelPen& pen, const LabelledUi& panel) {
  const mjUI& ui = panel.ui;
  if (ui.mousesect <= 0 || ui.mouseitem < 0) return;
  const mjuiItem& drawn = ui.sect[ui.mousesect - 1].item[ui.mouseitem];
  if (drawn.type != mjITEM_SELECT) return;
  const PanelItem& item = panel.sections[static_cast<std::size_t>(ui.mousesect - 1)]
                              .items[static_cast<std::size_t>(ui.mouseitem)];
  const auto& words = std::get<PanelChoice>(item.what).words;
  const int count = drawn.multi.nelem;
  mjrRect menu = drawn.rect;
  menu.height = count * pen.line_height();
  menu.bottom -= menu.height;
  for (int i = 0; i < count && static_cast<std::size_t>(i) < words.size(); ++i) {
    pen.draw(words[static_cast<std::size_t>(i)], line_in(menu, i, count, pen.line_height()),
             ui.color.fontactive);
  }
  pen.cover(menu);
}

}  // namespace

void draw_labels(const LabelledUi& panel, const mjuiState& state, const mjrContext& context,
                 GlyphFont& font) {
  const mjUI& ui = panel.ui;
  LabelPen pen(ui, state, context, font);
  draw_open_menu(pen, panel);
  for (int i = 0; i < ui.nsect; ++i) {
    const mjuiSection& section = ui.sect[i];
    const PanelSection& shown = panel.sections[static_cast<std::size_t>(i)];
    pen.draw(shown.title, section.rtitle, ui.color.sectfont);
    if (section.state == mjSECT_CLOSED) continue;
    for (int k = 0; k < section.nitem; ++k) {
      draw_item(pen, ui, section, section.item[k], shown.items[static_cast<std::size_t>(k)],
                panel.first_lines[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)]);
    }
  }
}

}  // namespace mjarm::view
