#include "mjarm/view/controls.hpp"

#include <algorithm>
#include <utility>

#include "mjarm/core/messages/view.hpp"
#include "mjarm/view/settings.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace mjarm::view {
namespace {

using enum KeyModifier;
using enum ViewAction;

constexpr ActionRow kActions[] = {
    {pause, GLFW_KEY_SPACE, none, msg::view_space, msg::view_key_pause},
    {step, GLFW_KEY_RIGHT, none, msg::view_right_key, msg::view_key_step},
    {step_back, GLFW_KEY_LEFT, none, msg::view_left_key, msg::view_key_step_back},
    {faster, GLFW_KEY_EQUAL, none, {"+", "+"}, msg::view_key_faster},
    {slower, GLFW_KEY_MINUS, none, {"-", "-"}, msg::view_key_slower},
    {reset, GLFW_KEY_BACKSPACE, none, msg::view_backspace, msg::view_key_reset},
    {first_view, GLFW_KEY_A, control, {"Ctrl-A", "Ctrl-A"}, msg::view_key_first_view},
    {previous_camera, GLFW_KEY_LEFT_BRACKET, none, {"[", "["}, msg::view_key_previous_camera},
    {next_camera, GLFW_KEY_RIGHT_BRACKET, none, {"]", "]"}, msg::view_key_next_camera},
    {left_panel, GLFW_KEY_TAB, none, {"Tab", "Tab"}, msg::view_key_left_panel},
    {right_panel, GLFW_KEY_TAB, shift, {"Shift-Tab", "Shift-Tab"}, msg::view_key_right_panel},
    {next_frame, GLFW_KEY_F6, none, {"F6", "F6"}, msg::view_key_next_frame},
    {next_label, GLFW_KEY_F7, none, {"F7", "F7"}, msg::view_key_next_label},
    {target, GLFW_KEY_T, control, {"Ctrl-T", "Ctrl-T"}, msg::view_key_target},
    {screenshot, GLFW_KEY_P, control, {"Ctrl-P", "Ctrl-P"}, msg::view_key_screenshot},
    {help, GLFW_KEY_F1, none, {"F1", "F1"}, msg::view_key_help},
    {close, GLFW_KEY_ESCAPE, none, {"Esc", "Esc"}, msg::view_key_close},
};

/// The same keys elsewhere on the keyboard.
int main_key(int key) {
  if (key == GLFW_KEY_KP_ADD) return GLFW_KEY_EQUAL;
  if (key == GLFW_KEY_KP_SUBTRACT) return GLFW_KEY_MINUS;
  return key;
}

constexpr double kSpeeds[] = {0.1, 0.2, 0.5, 1, 2, 5, 10};

}  // namespace

std::span<const ActionRow> action_rows() noexcept { return kActions; }
std::span<const double> view_speeds() noexcept { return kSpeeds; }

std::optional<ViewAction> action_of(int key, bool control_held, bool shift_held) noexcept {
  const KeyModifier held = control_held ? control : shift_held ? shift : none;
  const ActionRow* found = nullptr;
  for (const ActionRow& row : kActions) {
    if (row.key != main_key(key)) continue;
    if (row.modifier == held) return row.action;
    // Shift alone makes no other key, as in `+`.
    if (row.modifier == none && held == shift) found = &row;
  }
  return found == nullptr ? std::nullopt : std::optional(found->action);
}

std::vector<ControlHelp> control_help(std::span<const int> taken) {
  std::vector<ControlHelp> rows;
  const auto add = [&rows](std::string keys, Msg about) {
    rows.push_back({std::move(keys), text(about)});
  };
  const bool whole = taken.empty();
  add(text(msg::view_left_drag), msg::view_mouse_turn);
  add(text(msg::view_right_drag), msg::view_mouse_pan);
  add(text(msg::view_wheel), msg::view_mouse_zoom);
  add(text(msg::view_right_click), msg::view_mouse_settings);
  if (whole) add(text(msg::view_drag_handle), msg::view_mouse_target);
  add(text(msg::view_double_click), msg::view_mouse_select);
  if (whole) {
    add(text(msg::view_ctrl_right_drag), msg::view_mouse_push);
    add(text(msg::view_ctrl_left_drag), msg::view_mouse_twist);
  }
  for (const ActionRow& row : kActions) {
    if (!whole && row.action == target) continue;
    const bool plain = row.modifier == none;
    if (!plain || std::ranges::find(taken, row.key) == taken.end()) add(text(row.shown), row.about);
  }
  return rows;
}

std::vector<ControlHelp> control_help() {
  std::vector<ControlHelp> rows = control_help({});
  const auto add = [&rows](std::string keys, Msg about) {
    rows.push_back({std::move(keys), text(about)});
  };
  add("0 - 5", msg::view_key_geom_groups);
  add("Shift 0 - 5", msg::view_key_site_groups);
  for (const SettingRow& row : setting_rows()) {
    add(std::string(1, static_cast<char>(row.key)), row.about);
  }
  return rows;
}

}  // namespace mjarm::view
