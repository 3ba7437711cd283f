#include "mjarm/view/playback.hpp"

#include <utility>

namespace mjarm::view {

Playback::Playback(double timestep, bool paused) : pacer_(timestep), paused_(paused) {}

bool Playback::handle(const ViewEvent& event) {
  if (const auto* pause = std::get_if<PauseEvent>(&event)) {
    paused_ = pause->paused;
    asked_ = 0;
    return true;
  }
  if (const auto* speed = std::get_if<SpeedEvent>(&event)) {
    pacer_.set_speed(speed->speed);
    return true;
  }
  const auto* step = std::get_if<StepEvent>(&event);
  if (step == nullptr || step->steps < 0) return false;
  asked_ += step->steps;
  return true;
}

int Playback::steps_due() {
  const int steps = pacer_.steps_due(paused_);
  return paused_ ? std::exchange(asked_, 0) : steps;
}

int Playback::steps_due_at(double now) {
  const int steps = pacer_.steps_due_at(now, paused_);
  return paused_ ? std::exchange(asked_, 0) : steps;
}

}  // namespace mjarm::view
