#include "mjarm/sim/body_record.hpp"

#include <utility>

namespace mjarm {

bool BodyRecord::is_due(double time) const noexcept {
  constexpr double kEarly = 1e-9;  // [s] clocks are sums of steps
  return !last_ || time < *last_ || time >= next_ - kEarly;
}

void BodyRecord::add(const Snapshot& snapshot) {
  if (!poses_.set(snapshot)) return;
  if (moments_.size() == kMaxMoments) {
    for (std::size_t i = 1; 2 * i < moments_.size(); ++i) {
      moments_[i] = std::move(moments_[2 * i]);
    }
    moments_.resize(moments_.size() / 2);
    spacing_ *= 2;
  }
  const double step = static_cast<double>(spacing_) * kInterval;
  if (last_ && snapshot.time < *last_) offset_ = moments_.back().time + step - snapshot.time;
  const double time = offset_ + snapshot.time;
  // The end of a run is added whatever its time, and may be there already.
  if (!moments_.empty() && time <= moments_.back().time) return;
  // Steps do not divide the interval: moments are the first steps behind its multiples.
  next_ = last_ && snapshot.time < next_ + step && snapshot.time >= *last_ ? next_ + step
                                                                           : snapshot.time + step;
  last_ = snapshot.time;
  const auto copy = [](std::span<const double> from) {
    return std::vector<double>(from.begin(), from.end());
  };
  moments_.push_back({time, copy(poses_.qpos()), copy(poses_.p_W()), copy(poses_.quat())});
}

}  // namespace mjarm
