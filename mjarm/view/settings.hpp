#pragma once

#include <array>
#include <span>

#include "mjarm/core/messages.hpp"

namespace mjarm::view {

/// What can be switched on and off in a window.
enum class ViewFlag {
  contact_points,
  contact_forces,
  contact_split,
  transparent,
  joints,
  actuators,
  center_of_mass,
  inertia,
  convex_hull,
  collision_geoms,
  static_bodies,
  auto_connect,
  constraints,
  tendons,
  range_finders,
  cameras,
  lights,
  push_force,
  push_object,
  texture,
  shadow,
  reflection,
  wireframe,
  skybox,
  fog,
  haze,
};
inline constexpr int kViewFlags = static_cast<int>(ViewFlag::haze) + 1;
inline constexpr int kViewGroups = 6;

/// What a window shows: plain data, without MuJoCo's types.
struct ViewSettings {
  std::array<bool, kViewFlags> flags = {};
  std::array<bool, kViewGroups> geom_groups = {true, true, true, false, false, false};
  std::array<bool, kViewGroups> site_groups = {true, true, true, false, false, false};
  int label = 0;  ///< which objects have labels, index into `view_label_names()`; 0 = none
  int frame = 0;  ///< which objects show their axes, index into `view_frame_names()`; 0 = none

  [[nodiscard]] bool shows(ViewFlag flag) const { return flags[static_cast<std::size_t>(flag)]; }
  void set(ViewFlag flag, bool on) { flags[static_cast<std::size_t>(flag)] = on; }
  [[nodiscard]] bool operator==(const ViewSettings&) const = default;
};

/// One flag as keys, the settings panel and the help know it.
struct SettingRow {
  ViewFlag flag;
  int key;    ///< as GLFW numbers keys (ASCII, capital); 0 = none
  Msg label;  ///< in the panel
  Msg about;  ///< in the help
};
/// All flags, in the order of `ViewFlag`.
[[nodiscard]] std::span<const SettingRow> setting_rows() noexcept;

[[nodiscard]] std::span<const char* const> view_label_names() noexcept;
[[nodiscard]] std::span<const char* const> view_frame_names() noexcept;

}  // namespace mjarm::view
