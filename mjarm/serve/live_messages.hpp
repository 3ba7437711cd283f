#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "mjarm/render/overlay.hpp"
#include "mjarm/sim/body_poses.hpp"
#include "mjarm/view/live_plot.hpp"
#include "mjarm/view/panel_section.hpp"
#include "mjarm/view/target_link.hpp"

/// What a page is told, as bytes of the protocol: one function a kind of message. What is not a
/// finite number is left out.
namespace mjarm::serve {

inline constexpr std::size_t kMaxSeriesPoints = 2000;     ///< of a curve; longer ones are thinned
inline constexpr std::size_t kMaxOverlayPoints = 20'000;  ///< of lines and segments, likewise

/// A frame, binary: how the bodies stand.
/// @param number  rising from frame to frame.
[[nodiscard]] std::string frame_message(const BodyPoses& poses, double time, bool paused,
                                        std::uint32_t number);

/// The first message of a connection.
[[nodiscard]] std::string hello_message();

/// @param poses  of the frame that the overlay belongs to; ghosts stand beside it.
[[nodiscard]] std::string overlay_message(const render::Overlay& overlay, BodyPoses& poses);
[[nodiscard]] std::string plots_message(std::span<const view::LivePlot> plots);
[[nodiscard]] std::string panels_message(std::span<const view::PanelSection> sections);
[[nodiscard]] std::string status_message(std::string_view line);
/// @param turns  the target has rings.
[[nodiscard]] std::string target_message(const view::TargetLook& look, bool turns);
/// What a page sent was refused.
[[nodiscard]] std::string error_message(std::string_view what);
/// The run is over.
[[nodiscard]] std::string bye_message(std::string_view what);

}  // namespace mjarm::serve
