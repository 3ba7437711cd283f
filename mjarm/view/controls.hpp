#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mjarm/core/messages.hpp"

namespace mjarm::view {

/// What a key of a window does, beside switching a setting.
enum class ViewAction {
  pause,
  step,
  step_back,
  faster,
  slower,
  reset,
  first_view,
  next_camera,
  previous_camera,
  left_panel,
  right_panel,
  next_frame,
  next_label,
  target,
  screenshot,
  help,
  close,
};

/// Keys held together with another.
enum class KeyModifier { none, control, shift };

/// One key and what it does.
struct ActionRow {
  ViewAction action;
  int key;  ///< as GLFW numbers keys
  KeyModifier modifier;
  Msg shown;  ///< name of the key in the help
  Msg about;
};
[[nodiscard]] std::span<const ActionRow> action_rows() noexcept;

/// What a key does; none where it does nothing, or switches a setting.
[[nodiscard]] std::optional<ViewAction> action_of(int key, bool control, bool shift) noexcept;

/// One line of the help.
struct ControlHelp {
  std::string keys;
  std::string about;
};
/// Every control of a window: mouse, keys, settings; in the language in use.
[[nodiscard]] std::vector<ControlHelp> control_help();
/// The same of a window in which an application uses the keys of these numbers: without them, those
/// of settings, and what drags a target or pushes.
[[nodiscard]] std::vector<ControlHelp> control_help(std::span<const int> taken);

/// The speeds that + and - go through, simulated seconds a second.
[[nodiscard]] std::span<const double> view_speeds() noexcept;

}  // namespace mjarm::view
