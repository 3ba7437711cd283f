#include <algorithm>
#include <cmath>

#include "mjarm/trajectory/smooth_profile_internal.hpp"

namespace mjarm::detail {

void SmoothProfile::Moments::add(const Moments& part, double later) {
  for (std::size_t i = 0; i < plain.size(); ++i) {
    plain[i] += part.plain[i];
    timed[i] += part.timed[i] + later * part.plain[i];
  }
}

SmoothProfile::SmoothProfile(const SpeedProfile& profile, double window)
    : profile_(&profile), window_(window), levels_(1) {
  const std::vector<double>& times = profile.t;
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    levels_[0].push_back(within_cell(i, times[i], times[i + 1]));
  }
  for (std::size_t length = 2; levels_.back().size() > 1; length *= 2) {
    const std::vector<Moments>& parts = levels_.back();
    std::vector<Moments> wholes;
    for (std::size_t i = 0; i + 1 < parts.size(); i += 2) {
      const std::size_t first = i / 2 * length;
      wholes.push_back(parts[i]);
      wholes.back().add(parts[i + 1], times[first + length / 2] - times[first]);
    }
    levels_.push_back(std::move(wholes));
  }
}

/// Speed of the profile itself, at rest before and after.
double SmoothProfile::speed_before(double t) const {
  const SpeedProfile& p = *profile_;
  if (t <= 0 || t >= p.duration()) return 0;
  const std::size_t i = cell_at(t);
  const double length = p.t[i + 1] - p.t[i], x = t - p.t[i];
  return p.v[i] + x * (p.a_after[i] + 0.5 * x * (p.a_before[i + 1] - p.a_after[i]) / length);
}

std::size_t SmoothProfile::cell_at(double t) const {
  const std::vector<double>& times = profile_->t;
  const auto after = std::upper_bound(times.begin() + 1, times.end() - 1, t);
  return static_cast<std::size_t>(after - times.begin()) - 1;
}

/// Three Gauss points are exact, as s is cubic there.
SmoothProfile::Moments SmoothProfile::within_cell(std::size_t cell, double from, double to) const {
  constexpr double kNodes[3] = {-0.7745966692414834, 0, 0.7745966692414834};
  constexpr double kWeights[3] = {5. / 9, 8. / 9, 5. / 9};
  const SpeedProfile& p = *profile_;
  const double v0 = p.v[cell], a0 = p.a_after[cell];
  const double jerk = (p.a_before[cell + 1] - a0) / (p.t[cell + 1] - p.t[cell]);
  const double reach = 0.5 * (to - from);
  Moments sum;
  for (int k = 0; k < 3; ++k) {
    const double later = reach * (1 + kNodes[k]), x = from - p.t[cell] + later;
    const double s = p.s[cell] - p.s.front() + x * (v0 + x * (0.5 * a0 + x * jerk / 6));
    const std::array<double, 3> f{s, v0 + x * (a0 + 0.5 * x * jerk), a0 + x * jerk};
    for (std::size_t i = 0; i < f.size(); ++i) {
      sum.plain[i] += kWeights[k] * reach * f[i];
      sum.timed[i] += kWeights[k] * reach * f[i] * later;
    }
  }
  return sum;
}

/// Moments of the times [from, to] of the profile.
SmoothProfile::Moments SmoothProfile::over(double from, double to) const {
  const std::vector<double>& times = profile_->t;
  const std::size_t first = cell_at(from), last = cell_at(to);
  if (first == last) return within_cell(first, from, to);
  Moments sum = within_cell(first, from, times[first + 1]);
  for (std::size_t i = first + 1; i < last;) {
    std::size_t level = 0;  // of the longest run that starts here and ends in time
    while ((i >> level) % 2 == 0 && i + (std::size_t{2} << level) <= last) ++level;
    sum.add(levels_[level][i >> level], times[i] - from);
    i += std::size_t{1} << level;
  }
  sum.add(within_cell(last, times[last], to), times[last] - from);
  return sum;
}

PathState SmoothProfile::at(double t) const {
  const double length = profile_->s.back() - profile_->s.front(), end = profile_->duration();
  const double half = 0.5 * window_, middle = t - half, start = t - window_;
  // Share of the window that lies after the end of the profile, where s stays at its end.
  const double beyond = std::clamp((t - end) / window_, 0.0, 1.0);
  const double weight_beyond =
      beyond <= 0.5 ? 2 * beyond * beyond : 1 - 2 * (1 - beyond) * (1 - beyond);
  std::array<double, 3> sum{weight_beyond * length * half * half, 0, 0};

  if (const double from = std::max(start, 0.0), to = std::min(middle, end); from < to) {
    const Moments m = over(from, to);  // of the half in which the weight grows
    for (std::size_t i = 0; i < 3; ++i) sum[i] += m.timed[i] + (from - start) * m.plain[i];
  }
  if (const double from = std::max(middle, 0.0), to = std::min(t, end); from < to) {
    const Moments m = over(from, to);
    for (std::size_t i = 0; i < 3; ++i) sum[i] += (t - from) * m.plain[i] - m.timed[i];
  }
  for (double& x : sum) x /= half * half;
  // The weight's second derivative is three pulses: at both ends and in the middle of the window.
  const double jerk =
      (speed_before(t) - 2 * speed_before(middle) + speed_before(start)) / (half * half);
  return {profile_->s.front() + sum[0], sum[1], sum[2], jerk};
}

}  // namespace mjarm::detail
