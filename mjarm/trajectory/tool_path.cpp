#include <algorithm>
#include <cmath>
#include <optional>

#include "mjarm/core/messages.hpp"
#include "mjarm/trajectory/limits_internal.hpp"
#include "mjarm/trajectory/smooth_profile_internal.hpp"
#include "mjarm/trajectory/speed_profile_internal.hpp"
#include "mjarm/trajectory/spline_internal.hpp"
#include "mjarm/trajectory/trajectory.hpp"

namespace mjarm {
namespace {

using detail::Bounds;
using detail::CubicSpline;

constexpr double kKnotTime = 0.002;  // [s] between knots, at most

/// Knots of a growing trajectory.
struct Knots {
  std::vector<double> times;
  std::vector<JointState> states;
};

/// Index of the first waypoint that is not as it should be.
std::optional<std::size_t> bad_waypoint(const JointPath& path) {
  if (path.q.empty() || path.q.size() != path.s.size()) return 0;
  const Eigen::Index dof = path.q[0].size();
  for (std::size_t i = 0; i < path.q.size(); ++i) {
    const bool ascends = i == 0 || path.s[i] > path.s[i - 1];
    if (dof == 0 || path.q[i].size() != dof || !path.q[i].allFinite() ||
        !std::isfinite(path.s[i]) || !ascends) {
      return i;
    }
  }
  return std::nullopt;
}

/// Indices of the waypoints to rest at, first and last included, ascending.
Result<std::vector<std::size_t>> rests_of(const JointPath& path, std::span<const double> stops) {
  constexpr double kSame = 1e-9;  // of the whole parameter range
  std::vector<std::size_t> rests{0, path.s.size() - 1};
  const double slack = kSame * (path.s.back() - path.s.front());
  for (const double stop : stops) {
    const auto above = std::lower_bound(path.s.begin(), path.s.end(), stop - slack);
    if (above == path.s.end() || !(std::abs(*above - stop) <= slack)) {
      return fail(Errc::bad_input, text(Msg::trajectory_bad_stop, stop));
    }
    rests.push_back(static_cast<std::size_t>(above - path.s.begin()));
  }
  std::sort(rests.begin(), rests.end());
  rests.erase(std::unique(rests.begin(), rests.end()), rests.end());
  return rests;
}

JointState state_at(const CubicSpline& spline, const detail::PathState& x) {
  const detail::SplinePoint p = spline.at(x.s);
  return {p.q, x.v * p.d, x.a * p.d + x.v * x.v * p.e};
}

/// By which factor the motion is too fast in this state; <= 1 where it keeps the bounds.
double excess(const JointState& x, const Bounds& bounds) {
  return std::max(x.v.cwiseAbs().cwiseQuotient(bounds.v).maxCoeff(),
                  std::sqrt(x.a.cwiseAbs().cwiseQuotient(bounds.a).maxCoeff()));
}

/// States of a smoothed profile at `n` + 1 even times.
std::vector<JointState> sampled(const CubicSpline& spline, const detail::SmoothProfile& smooth,
                                std::size_t n) {
  std::vector<JointState> states(n + 1);
  for (std::size_t k = 0; k <= n; ++k) {
    const double t = smooth.duration() * (static_cast<double>(k) / static_cast<double>(n));
    states[k] = state_at(spline, smooth.at(t));
  }
  return states;
}

/// Makes `slow` smaller where the profile caused states that are too fast; returns the worst
/// excess.
double slow_down(const std::vector<JointState>& states, double duration, double window,
                 const Bounds& bounds, const detail::SpeedProfile& profile,
                 std::vector<double>& slow) {
  const std::vector<double> before = slow;
  double worst = 0;
  for (std::size_t k = 0; k < states.size(); ++k) {
    const double over = excess(states[k], bounds);
    worst = std::max(worst, over);
    if (over <= 1) continue;
    const double t = duration * (static_cast<double>(k) / static_cast<double>(states.size() - 1));
    // The state is a mean over the window that ends at t.
    const auto first = std::lower_bound(profile.t.begin(), profile.t.end(), t - window);
    const auto last = std::upper_bound(profile.t.begin(), profile.t.end(), t);
    const auto begin =
        static_cast<std::size_t>(std::max<std::ptrdiff_t>(first - profile.t.begin() - 1, 0));
    const auto end = std::min(static_cast<std::size_t>(last - profile.t.begin()) + 1, slow.size());
    for (std::size_t i = begin; i < end; ++i) slow[i] = std::min(slow[i], before[i] / over);
  }
  return worst;
}

/// Adds the motion along `spline` from rest to rest.
void add_piece(Knots& knots, const CubicSpline& spline, const Bounds& bounds,
               const detail::PathBounds& path_bounds, double window) {
  constexpr int kRounds = 20;
  constexpr double kClose = 1e-4;  // the rest is had by stretching the time
  const detail::PathGrid grid(spline);
  std::vector<double> slow(grid.s.size(), 1.0);
  std::vector<JointState> states;
  double duration = 0, worst = 0;
  for (int round = 0; round < kRounds; ++round) {
    const detail::SpeedProfile profile = fastest_profile(grid, bounds, path_bounds, slow);
    const detail::SmoothProfile smooth(profile, window);
    duration = smooth.duration();
    const auto n = static_cast<std::size_t>(std::max(16.0, std::ceil(duration / kKnotTime)));
    states = sampled(spline, smooth, n);
    worst = slow_down(states, duration, window, bounds, profile, slow);
    if (worst <= 1 + kClose) break;
  }
  const double stretch = std::max(worst, 1.0);
  const double t0 = knots.times.back(), n = static_cast<double>(states.size() - 1);
  for (std::size_t k = 1; k < states.size(); ++k) {
    JointState& x = states[k];
    x.v /= stretch;
    x.a /= stretch * stretch;
    knots.times.push_back(t0 + stretch * duration * (static_cast<double>(k) / n));
    knots.states.push_back(std::move(x));
  }
  JointState& last = knots.states.back();
  last.q = spline.at(spline.end()).q;
  last.v.setZero();
  last.a.setZero();
}

/// Time over which accelerations change: so long that a joint which starts at its acceleration
/// limit keeps its jerk limit, and at least what a tool should take.
double smoothing_window(const Bounds& bounds) {
  return std::clamp(2 * bounds.a.cwiseQuotient(bounds.j).maxCoeff(), 0.05, 0.2);
}

}  // namespace

Result<Trajectory> time_tool_path(const JointPath& path, std::span<const double> stops,
                                  const JointLimits& limits, const TimingOptions& options) {
  if (const auto bad = bad_waypoint(path)) {
    return fail(Errc::bad_input, text(Msg::trajectory_bad_path, *bad));
  }
  const Result<Bounds> bounds = detail::bounds_of(limits, options, path.q[0].size());
  if (!bounds) return fail(bounds.error());
  const Result<std::vector<std::size_t>> rests = rests_of(path, stops);
  if (!rests) return fail(rests.error());

  const JointVec zero = JointVec::Zero(path.q[0].size());
  Knots knots{{0.0}, {{path.q[0], zero, zero}}};
  for (std::size_t i = 0; i + 1 < rests->size(); ++i) {
    const std::size_t first = (*rests)[i], count = (*rests)[i + 1] - first + 1;
    const CubicSpline spline(std::span(path.s).subspan(first, count),
                             std::span(path.q).subspan(first, count));
    add_piece(knots, spline, *bounds, {options.tool_speed, options.tool_accel},
              smoothing_window(*bounds));
  }
  return Trajectory::through(knots.times, knots.states);
}

}  // namespace mjarm
