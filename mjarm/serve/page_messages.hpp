#pragma once

#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/model/drawn_model.hpp"
#include "mjarm/serve/scene_json.hpp"
#include "mjarm/sim/body_poses.hpp"
#include "mjarm/view/events.hpp"
#include "mjarm/view/panel_section.hpp"
#include "mjarm/view/target_link.hpp"

namespace mjarm::serve {

inline constexpr std::size_t kMaxPageMessage = 64 * 1024;  ///< [bytes] of a text of a page
inline constexpr double kMaxPageNumber = 1e6;              ///< of metres, newtons and the like
inline constexpr int kMaxPageSteps = 1000;                 ///< of one message, either way

/// What a text of a page is checked against.
struct PageScene {
  const DrawnModel& model;
  const SceneFacts& facts;
  const BodyPoses& poses;                           ///< as the page sees them, or nearly
  std::span<const view::PanelSection> panels = {};  ///< as the page sees them, or nearly
};

/// What a page asked for; `std::monostate` is well said, but nothing to do: an item that was
/// enabled when it was clicked and is not any more.
using PageMessage = std::variant<std::monostate, view::ViewEvent, view::TargetDrag>;

/// Reads a text of a page, strictly: the members of its type and no others, finite numbers within
/// bounds, numbers of bodies, geoms, joints and items that there are, and only what the
/// application lets the user do. Values of panels are within the range of their item.
/// @return bad_input that says what is wrong. Never throws.
[[nodiscard]] Result<PageMessage> read_page_message(std::string_view text, const PageScene& scene);

}  // namespace mjarm::serve
