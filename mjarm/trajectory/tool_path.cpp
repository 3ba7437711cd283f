#include <algorithm>
#include <cmath>
#include <optional>

#include "mjarm/core/messages/trajectory.hpp"
#include "mjarm/trajectory/limits_internal.hpp"
#include "mjarm/trajectory/smooth_profile_internal.hpp"
#include "mjarm/trajectory/speed_profile_internal.hpp"
#include "mjarm/trajectory/spline_internal.hpp"
#include "mjarm/trajectory/trajectory.hpp"

namespace mjarm {
namespace {

using detail::Bounds;
using detail::CubicSpline;

/// Knots of a growing trajectory, or of a part of it.
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
      return fail(Errc::bad_input, text(msg::trajectory_bad_stop, stop));
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

/// States of a smoothed profile, so near each other that quintics in between are as good as exact:
/// at most 2 ms apart (20 ms on very long motions), and several between two waypoints.
Knots sampled(const CubicSpline& spline, const detail::SmoothProfile& smooth) {
  const std::vector<double>& s = spline.knots();
  const double duration = smooth.duration();
  const double longest = std::clamp(duration / 5000, 0.002, 0.02);  // [s]
  Knots knots;
  std::size_t piece = 0;
  for (double t = 0; t < duration;) {
    const detail::PathState x = smooth.at(t);
    knots.times.push_back(t);
    knots.states.push_back(state_at(spline, x));
    while (piece + 2 < s.size() && s[piece + 1] <= x.s) ++piece;
    const double here = s[piece + 1] - s[piece];
    const double next = piece + 2 < s.size() ? s[piece + 2] - s[piece + 1] : here;
    const double speed = std::abs(x.v) + std::abs(x.a) * longest;
    const double step =
        0.5 * std::min(here, next) < speed * longest ? 0.5 * std::min(here, next) / speed : longest;
    const double left = duration - t;
    t = left <= step ? duration : t + std::min(step, 0.5 * left);
  }
  knots.times.push_back(duration);
  knots.states.push_back(state_at(spline, smooth.at(duration)));
  return knots;
}

/// Makes `slow` smaller where the profile caused states that are too fast; returns the worst
/// excess.
double slow_down(const Knots& knots, double window, const Bounds& bounds,
                 const detail::SpeedProfile& profile, std::vector<double>& slow) {
  const std::vector<double> before = slow;
  double worst = 0;
  for (std::size_t k = 0; k < knots.times.size(); ++k) {
    const double over = excess(knots.states[k], bounds);
    worst = std::max(worst, over);
    if (over <= 1) continue;
    // The state is a mean over the window that ends at its time; one grid point more on both sides.
    const auto index_of = [&](double t) {
      return std::upper_bound(profile.t.begin(), profile.t.end(), t) - profile.t.begin();
    };
    const auto begin = static_cast<std::size_t>(
        std::max<std::ptrdiff_t>(index_of(knots.times[k] - window) - 1, 0));
    const auto end = std::min(static_cast<std::size_t>(index_of(knots.times[k])) + 1, slow.size());
    for (std::size_t i = begin; i < end; ++i) slow[i] = std::min(slow[i], before[i] / over);
  }
  return worst;
}

/// Motion along `spline` from rest to rest: the fastest one, smoothed in time; where that breaks a
/// bound (the mean of what is allowed here and a little further on need not be allowed), it is made
/// slower there and tried again.
Knots piece_along(const CubicSpline& spline, const Bounds& bounds,
                  const detail::PathBounds& path_bounds, double window) {
  constexpr int kRounds = 20;
  constexpr double kClose = 1e-4;  // stretching the time does the rest
  const detail::PathGrid grid(spline);
  std::vector<double> slow(grid.s.size(), 1.0);
  Knots knots;
  for (int round = 0; round < kRounds; ++round) {
    const detail::SpeedProfile profile = fastest_profile(grid, bounds, path_bounds, slow);
    knots = sampled(spline, detail::SmoothProfile(profile, window));
    if (slow_down(knots, window, bounds, profile, slow) <= 1 + kClose) break;
  }
  const JointVec zero = JointVec::Zero(knots.states[0].q.size());
  knots.states.front() = {spline.at(spline.start()).q, zero, zero};
  knots.states.back() = {spline.at(spline.end()).q, zero, zero};
  return knots;
}

/// Stretches the time so that the quintics through the knots keep the bounds everywhere.
Result<void> stretch_into(Knots& knots, const Bounds& bounds) {
  constexpr int kSamples = 8;  // between two knots
  const Result<Trajectory> trajectory = Trajectory::through(knots.times, knots.states);
  if (!trajectory) return fail(trajectory.error());
  double stretch = 1;
  for (std::size_t k = 0; k + 1 < knots.times.size(); ++k) {
    for (int i = 0; i < kSamples; ++i) {
      const double share = static_cast<double>(i) / kSamples;
      const double t = (1 - share) * knots.times[k] + share * knots.times[k + 1];
      stretch = std::max(stretch, excess(trajectory->at(t), bounds));
    }
  }
  for (std::size_t k = 0; k < knots.times.size(); ++k) {
    knots.times[k] *= stretch;
    knots.states[k].v /= stretch;
    knots.states[k].a /= stretch * stretch;
  }
  return {};
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
    return fail(Errc::bad_input, text(msg::trajectory_bad_path, *bad));
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
    Knots piece = piece_along(spline, *bounds, {options.tool_speed, options.tool_accel},
                              smoothing_window(*bounds));
    if (auto done = stretch_into(piece, *bounds); !done) return fail(std::move(done.error()));
    const double t0 = knots.times.back();
    for (std::size_t k = 1; k < piece.times.size(); ++k) {
      knots.times.push_back(t0 + piece.times[k]);
      knots.states.push_back(piece.states[k]);
    }
  }
  return Trajectory::through(knots.times, knots.states);
}

}  // namespace mjarm
