#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/model/drawn_model.hpp"
#include "mjarm/serve/page_messages.hpp"
#include "mjarm/serve/scene_json.hpp"
#include "mjarm/sim/body_poses.hpp"
#include "mjarm/view/target_link.hpp"
#include "mjarm/view/view_link.hpp"

namespace mjarm::serve {

/// Kinds of messages that are sent again where they change.
enum class LiveKind { frame, overlay, plots, panels, status, target };
inline constexpr std::size_t kLiveKinds = 6;

/// What pages are told of one kind, as it stands; shared by all of them.
struct LiveMessage {
  std::shared_ptr<const std::string> bytes = {};
  std::uint64_t version = 0;  ///< rises with every change; 0 = nothing yet
};

/// What a page holds with the mouse; it is let go of where the page vanishes.
struct PageHold {
  int pushed_body = -1;                       ///< -1 = none
  std::optional<view::TargetDrag> drag = {};  ///< that has not ended
};

/// What lies between a simulation and the pages that show it: takes the newest frame from its link
/// and makes messages of it, each no oftener than the protocol says and only where it changed;
/// reads what pages send and hands it on. Holds one message of each kind, however many pages there
/// are and however slowly they read. In the thread of the server; the simulation never waits for
/// it.
class LiveFeed {
 public:
  /// All outlive this.
  /// @param target  none where the tool has no target.
  LiveFeed(const Model& model, const DrawnModel& drawn, const SceneFacts& facts,
           view::ViewLink& link, view::TargetLink* target, bool paused);

  /// Takes what is new.
  /// @param now  [s] of a clock that never falls.
  void refresh(double now);
  [[nodiscard]] const LiveMessage& message(LiveKind kind) const {
    return messages_[static_cast<std::size_t>(kind)];
  }

  /// Follows a text of a page.
  /// @param hold  of that page.
  /// @return why it was refused.
  [[nodiscard]] Result<void> handle(std::string_view text_of_page, PageHold& hold);
  /// Lets go of what a page held.
  void let_go(PageHold& hold);
  /// False while the simulation has a thousand messages to read yet: pages wait with theirs.
  [[nodiscard]] bool has_room() const;

 private:
  void take_frame();
  void set(LiveKind kind, std::string bytes);
  /// Whether a kind is to be made anew.
  bool is_due(LiveKind kind, double now);
  void mark(LiveKind kind) { stale_[static_cast<std::size_t>(kind)] = true; }

  const DrawnModel& drawn_;
  const SceneFacts& facts_;
  view::ViewLink& link_;
  view::TargetLink* target_;
  BodyPoses poses_;
  view::ViewFrame frame_;
  view::TargetLook look_;
  bool paused_;
  bool has_frame_ = false;
  std::uint32_t number_ = 0;
  std::array<LiveMessage, kLiveKinds> messages_ = {};
  std::array<bool, kLiveKinds> stale_ = {};
  std::array<double, kLiveKinds> made_ = {};  ///< [s] when they were made last
};

}  // namespace mjarm::serve
