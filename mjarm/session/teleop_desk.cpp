#include "mjarm/session/teleop_desk.hpp"

#include <algorithm>
#include <utility>

namespace mjarm::session {

void TeleopDesk::changed() {
  if (!since_) since_ = Clock::now();
}

void TeleopDesk::set(Device device, const HandInput& hand) {
  const std::scoped_lock lock(mutex_);
  if (device == page) heard_ = Clock::now();
  HandInput& known = hands_[static_cast<std::size_t>(device)];
  if (known == hand) return;
  known = hand;
  changed();
}

void TeleopDesk::act(TeleopAction action) {
  const std::scoped_lock lock(mutex_);
  actions_.push_back(action);
  changed();
}

TeleopDesk::Taken TeleopDesk::take() {
  const std::scoped_lock lock(mutex_);
  const std::chrono::duration<double> silent = Clock::now() - heard_;
  if (silent.count() > kPagePatience) hands_[page] = {};
  Taken out{{}, std::exchange(actions_, {}), std::exchange(since_, {})};
  for (const HandInput& hand : hands_) {
    out.hand.linear += hand.linear;
    out.hand.angular += hand.angular;
    out.hand.grip += hand.grip;
  }
  out.hand.linear = out.hand.linear.cwiseMax(-1).cwiseMin(1);
  out.hand.angular = out.hand.angular.cwiseMax(-1).cwiseMin(1);
  out.hand.grip = std::clamp(out.hand.grip, -1.0, 1.0);
  return out;
}

}  // namespace mjarm::session
