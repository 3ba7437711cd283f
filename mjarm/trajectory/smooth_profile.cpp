#include <algorithm>
#include <cmath>

#include "mjarm/trajectory/smooth_profile_internal.hpp"

namespace mjarm::detail {

SmoothProfile::SmoothProfile(const SpeedProfile& profile, double window)
    : profile_(&profile), window_(window) {}

/// Adds the weighted states of the times [from, to], which lie in `cell` and in one half of the
/// window that ends at time `end`. The weight is linear there and s quadratic, so two Gauss points
/// are exact.
void SmoothProfile::add_cell(PathState& sum, double from, double to, std::size_t cell,
                             double end) const {
  const double half = 0.5 * window_;
  const double t0 = profile_->t[cell], t1 = profile_->t[cell + 1];
  const double v0 = profile_->v[cell];
  const double a = (profile_->v[cell + 1] - v0) / (t1 - t0);
  const double middle = 0.5 * (from + to), reach = 0.5 * (to - from);
  for (const double node : {-1 / std::sqrt(3.0), 1 / std::sqrt(3.0)}) {
    const double t = middle + reach * node;
    const double x = t - t0;
    const double weight = reach * (half - std::abs(end - half - t)) / (half * half);
    sum.s += weight * (profile_->s[cell] - profile_->s.front() + x * (v0 + 0.5 * a * x));
    sum.v += weight * (v0 + a * x);
    sum.a += weight * a;
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
  PathState sum{weight_beyond * length, 0, 0};  // s from the start

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
  return sum;
}

}  // namespace mjarm::detail
