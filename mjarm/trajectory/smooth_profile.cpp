#include <algorithm>
#include <cmath>

#include "mjarm/trajectory/smooth_profile_internal.hpp"

namespace mjarm::detail {

SmoothProfile::SmoothProfile(const SpeedProfile& profile, double window)
    : profile_(&profile), window_(window) {}

/// Speed of the profile itself, at rest before and after.
double SmoothProfile::speed_before(double t) const {
  const SpeedProfile& p = *profile_;
  if (t <= 0 || t >= p.duration()) return 0;
  const auto after = std::upper_bound(p.t.begin() + 1, p.t.end() - 1, t);
  const auto i = static_cast<std::size_t>(after - p.t.begin()) - 1;
  const double length = p.t[i + 1] - p.t[i], x = t - p.t[i];
  return p.v[i] + x * (p.a_after[i] + 0.5 * x * (p.a_before[i + 1] - p.a_after[i]) / length);
}

/// Adds the weighted states of the times [from, to], which lie in `cell` and in one half of the
/// window that ends at time `end`. The weight is linear there and s cubic, so three Gauss points
/// are exact.
void SmoothProfile::add_cell(PathState& sum, double from, double to, std::size_t cell,
                             double end) const {
  constexpr double kNodes[3] = {-0.7745966692414834, 0, 0.7745966692414834};
  constexpr double kWeights[3] = {5. / 9, 8. / 9, 5. / 9};
  const SpeedProfile& p = *profile_;
  const double half = 0.5 * window_;
  const double v0 = p.v[cell], a0 = p.a_after[cell];
  const double jerk = (p.a_before[cell + 1] - a0) / (p.t[cell + 1] - p.t[cell]);
  const double middle = 0.5 * (from + to), reach = 0.5 * (to - from);
  for (int k = 0; k < 3; ++k) {
    const double t = middle + reach * kNodes[k];
    const double x = t - p.t[cell];
    const double weight = kWeights[k] * reach * (half - std::abs(end - half - t)) / (half * half);
    sum.s += weight * (p.s[cell] - p.s.front() + x * (v0 + x * (0.5 * a0 + x * jerk / 6)));
    sum.v += weight * (v0 + x * (a0 + 0.5 * x * jerk));
    sum.a += weight * (a0 + x * jerk);
  }
}

PathState SmoothProfile::at(double t) const {
  const std::vector<double>& times = profile_->t;
  const double length = profile_->s.back() - profile_->s.front();
  const double half = 0.5 * window_;
  // Share of the window that lies after the end of the profile, where s stays at its end.
  const double beyond = std::clamp((t - profile_->duration()) / window_, 0.0, 1.0);
  const double weight_beyond =
      beyond <= 0.5 ? 2 * beyond * beyond : 1 - 2 * (1 - beyond) * (1 - beyond);
  PathState sum{weight_beyond * length, 0, 0, 0};  // s from the start

  const double first = std::max(t - window_, 0.0), last = std::min(t, profile_->duration());
  auto cell = static_cast<std::size_t>(std::upper_bound(times.begin() + 1, times.end() - 1, first) -
                                       times.begin() - 1);
  for (double from = first; from < last;) {
    double to = std::min(times[cell + 1], last);
    if (from < t - half && t - half < to) to = t - half;
    if (to > from) add_cell(sum, from, to, cell, t);
    if (to == times[cell + 1]) {
      if (++cell + 1 == times.size()) break;
    }
    from = to;
  }
  sum.s += profile_->s.front();
  // The weight's second derivative is three pulses: at both ends and in the middle of the window.
  sum.j =
      (speed_before(t) - 2 * speed_before(t - half) + speed_before(t - window_)) / (half * half);
  return sum;
}

}  // namespace mjarm::detail
