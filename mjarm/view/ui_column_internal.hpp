#pragma once

#include <mujoco/mujoco.h>

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mjarm/view/glyph_font_internal.hpp"
#include "mjarm/view/panel_section.hpp"

namespace mjarm::view {

/// An item that the user changed.
struct UiChange {
  int section = 0;
  int item = 0;
  double value = 0;  ///< as in `PanelEvent`
};

/// One panel, drawn by MuJoCo's own user interface from plain data. An OpenGL context is current
/// in every call but the constructor.
class UiColumn {
 public:
  /// @param rect index of its place in mjuiState; its image is the auxiliary buffer of that number.
  explicit UiColumn(int rect);

  /// Shows these sections: builds the panel anew where their structure changed, else only draws
  /// what has another value. An item that the user holds keeps its value.
  void show(const std::vector<PanelSection>& sections, mjuiState& state, mjrContext& context);
  /// Draws all anew; needed after the place of the panel appeared or changed.
  void refresh(mjuiState& state, mjrContext& context);
  /// Lets an event of the mouse act.
  std::optional<UiChange> handle(mjuiState& state, const mjrContext& context);
  /// @param font  for what MuJoCo's has no letters for.
  void render(const mjuiState& state, const mjrContext& context, GlyphFont& font);

  [[nodiscard]] int width() const { return ui_->width; }
  /// Middle of an item in the window, from its lower left, or of a title where `item` < 0; for
  /// tests.
  [[nodiscard]] std::optional<mjrRect> place(int section, int item, const mjuiState& state) const;

 private:
  /// What MuJoCo writes into while the user changes an item.
  struct Cell {
    int integer = 0;
    mjtNum number = 0;
    int first = 0;        ///< of a list: the line that is its first element
    std::string printed;  ///< as it was drawn last
  };
  void build(const std::vector<PanelSection>& sections);
  void add_item(const PanelItem& item, Cell& cell);
  /// Writes the value into its cell.
  /// @return true where it has to be drawn.
  bool write(const PanelItem& item, Cell& cell, mjuiItem& drawn);
  [[nodiscard]] bool is_held(int section, int item) const;

  std::unique_ptr<mjUI> ui_;
  std::vector<PanelSection> sections_;
  std::vector<std::deque<Cell>> cells_;  ///< of each section and item; they never move
};

}  // namespace mjarm::view
