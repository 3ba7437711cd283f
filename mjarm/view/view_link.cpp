#include "mjarm/view/view_link.hpp"

#include "mjarm/view/window.hpp"

namespace mjarm::view {

Result<void> draw_until_closed(Window& window, ViewLink& link, const std::function<bool()>& ended) {
  ViewFrame frame;
  bool has_frame = false;
  Result<void> drawn;
  while (drawn && window.is_open() && !ended()) {
    if (link.frames.take(frame)) {
      has_frame = true;
      window.set_status(frame.status);
    }
    drawn = has_frame ? window.draw(frame.snapshot, frame.overlay, frame.plots, frame.panels)
                      : window.draw({});
    link.events.push(window.take_events());
  }
  link.closed = true;
  return drawn;
}

}  // namespace mjarm::view
