#include "mjarm/serve/live_feed.hpp"

#include <utility>

#include "mjarm/serve/live_messages.hpp"

namespace mjarm::serve {
namespace {

constexpr std::size_t kMaxWaiting = 1000;  // messages that the simulation has not read

/// [s] At least so long lies between two messages of a kind. Ticks of the server's clock are not
/// quite even, so all are a little shorter than the protocol's.
constexpr double kIntervals[kLiveKinds] = {0.015, 0.045, 0.095, 0.045, 0.045, 0.015};

}  // namespace

LiveFeed::LiveFeed(const Model& model, const DrawnModel& drawn, const SceneFacts& facts,
                   view::ViewLink& link, view::TargetLink* target, bool paused)
    : drawn_(drawn), facts_(facts), link_(link), target_(target), poses_(model), paused_(paused) {
  made_.fill(-1e9);
  mark(LiveKind::target);  // none is shown, as long as nothing else is said
}

void LiveFeed::set(LiveKind kind, std::string bytes) {
  LiveMessage& message = messages_[static_cast<std::size_t>(kind)];
  if (message.bytes && *message.bytes == bytes) return;
  message.bytes = std::make_shared<const std::string>(std::move(bytes));
  ++message.version;
}

bool LiveFeed::is_due(LiveKind kind, double now) {
  const auto i = static_cast<std::size_t>(kind);
  if (!stale_[i] || now - made_[i] < kIntervals[i]) return false;
  stale_[i] = false;
  made_[i] = now;
  return true;
}

void LiveFeed::take_frame() {
  if (!link_.frames.take(frame_)) return;
  if (!poses_.set(frame_.snapshot)) return;  // of another model: nothing that could be shown
  has_frame_ = true;
  for (const LiveKind kind :
       {LiveKind::frame, LiveKind::overlay, LiveKind::plots, LiveKind::panels, LiveKind::status}) {
    mark(kind);
  }
}

void LiveFeed::refresh(double now) {
  // A frame that nobody took stays where it is: one that could not be sent yet is of no use here.
  if (now - made_[0] >= kIntervals[0]) take_frame();
  if (target_ != nullptr && target_->looks.take(look_)) mark(LiveKind::target);
  if (is_due(LiveKind::target, now)) {
    set(LiveKind::target, target_message(look_, facts_.turns));
  }
  if (!has_frame_) return;
  if (is_due(LiveKind::frame, now)) {
    set(LiveKind::frame, frame_message(poses_, frame_.snapshot.time, paused_, ++number_));
  }
  if (is_due(LiveKind::overlay, now)) {
    set(LiveKind::overlay, overlay_message(frame_.overlay, poses_));
  }
  if (is_due(LiveKind::plots, now)) set(LiveKind::plots, plots_message(frame_.plots));
  if (is_due(LiveKind::panels, now)) set(LiveKind::panels, panels_message(frame_.panels));
  if (is_due(LiveKind::status, now)) set(LiveKind::status, status_message(frame_.status));
}

Result<void> LiveFeed::handle(std::string_view text_of_page, PageHold& hold) {
  Result<PageMessage> message = read_page_message(
      text_of_page, {.model = drawn_, .facts = facts_, .poses = poses_, .panels = frame_.panels});
  if (!message) return fail(std::move(message.error()));
  if (auto* event = std::get_if<view::ViewEvent>(&*message)) {
    if (const auto* pause = std::get_if<view::PauseEvent>(event)) {
      paused_ = pause->paused;
      mark(LiveKind::frame);
    }
    if (const auto* push = std::get_if<view::PushEvent>(event)) hold.pushed_body = push->body;
    if (std::holds_alternative<view::ReleaseEvent>(*event)) hold.pushed_body = -1;
    link_.events.push({std::move(*event)});
  } else if (const auto* drag = std::get_if<view::TargetDrag>(&*message)) {
    hold.drag = drag->held ? std::optional(*drag) : std::nullopt;
    if (target_ != nullptr) target_->drags.push({*drag});
  }
  return {};
}

void LiveFeed::let_go(PageHold& hold) {
  if (hold.pushed_body >= 0) link_.events.push({view::ReleaseEvent{hold.pushed_body}});
  if (hold.drag && target_ != nullptr) {
    hold.drag->held = false;
    target_->drags.push({*hold.drag});
  }
  hold = {};
}

bool LiveFeed::has_room() const {
  return link_.events.size() < kMaxWaiting &&
         (target_ == nullptr || target_->drags.size() < kMaxWaiting);
}

}  // namespace mjarm::serve
