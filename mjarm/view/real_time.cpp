#include "mjarm/view/real_time.hpp"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>

namespace mjarm::view {
namespace {

constexpr double kMaxAtOnce = 0.25;  // [s] of the clock

}  // namespace

RealTimePacer::RealTimePacer(double timestep, double speed) : timestep_(timestep), speed_(speed) {
  assert(timestep > 0 && speed > 0);
}

void RealTimePacer::set_speed(double speed) {
  assert(speed > 0);
  speed_ = speed;
}

int RealTimePacer::steps_due(bool paused) {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return steps_due_at(std::chrono::duration<double>(now).count(), paused);
}

int RealTimePacer::steps_due_at(double now, bool paused) {
  const double passed = last_ ? std::max(now - *last_, 0.0) : 0.0;
  last_ = now;
  if (paused) return 0;
  owed_ += speed_ * std::min(passed, kMaxAtOnce);
  // The sum of many small times may stay an ulp below a whole step.
  const int steps = static_cast<int>(std::floor(owed_ / timestep_ + 1e-9));
  owed_ = std::max(owed_ - steps * timestep_, 0.0);
  return steps;
}

}  // namespace mjarm::view
