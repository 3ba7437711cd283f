#include "mjarm/trajectory/at_speed.hpp"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "mjarm/core/messages/trajectory.hpp"
#include "mjarm/trajectory/spline_internal.hpp"
#include "mjarm/trajectory/tool_path_internal.hpp"

namespace mjarm {
namespace {

using detail::CubicSpline;
using detail::SplinePoint;

constexpr double kRoom = 1.5;      // of the way that it takes to speed up
constexpr double kMaxRunUp = 0.1;  // [m or rad] farther out the first cubic says little
constexpr int kRunUpPoints = 32;   // evenly along the run-up

/// [m or rad] in which the tool gets from rest to its speed at the start.
double run_up_of(const JointPath& path, const TimingOptions& options) {
  const double speed = options.speed_at(path.s.front());
  const double needed = kRoom * 0.5 * speed * (speed / options.tool_accel + options.tool_ramp);
  return std::min({needed, kMaxRunUp, path.s.back() - path.s.front()});
}

/// The path with the run-up before it.
JointPath with_run_up(const JointPath& path, const SplinePoint& start, double length) {
  JointPath out;
  for (int i = 0; i < kRunUpPoints; ++i) {
    const double x = length * (static_cast<double>(i) / kRunUpPoints - 1);
    out.s.push_back(path.s.front() + x);
    out.q.push_back(start.q + x * (start.d + x * (0.5 * start.e + x / 6 * start.f)));
  }
  out.s.insert(out.s.end(), path.s.begin(), path.s.end());
  out.q.insert(out.q.end(), path.q.begin(), path.q.end());
  return out;
}

/// [s] when the run-up is over.
double end_of_run_up(const Trajectory& motion, const SplinePoint& start) {
  constexpr int kHalvings = 60;
  const auto is_over = [&](double t) { return (motion.at(t).q - start.q).dot(start.d) >= 0; };
  double before = 0, after = motion.duration();
  for (std::size_t i = 0; i < motion.pieces() && after == motion.duration(); ++i) {
    const double t = motion.piece(i).start;
    (is_over(t) ? after : before) = t;
  }
  for (int i = 0; i < kHalvings; ++i) {
    const double t = 0.5 * (before + after);
    (is_over(t) ? after : before) = t;
  }
  return after;
}

}  // namespace

Result<Trajectory> part_of(const Trajectory& trajectory, double from, double to) {
  constexpr double kShort = 1e-6;  // [s] pieces shorter than this would be all rounding
  if (!(from >= 0 && to > from + kShort && to <= trajectory.duration())) {
    return fail(Errc::bad_input, text(msg::trajectory_bad_knots));
  }
  std::vector<double> times{0};
  std::vector<JointState> knots{trajectory.at(from)};
  const auto add = [&](double t) {
    times.push_back(t - from);
    knots.push_back(trajectory.at(t));
  };
  for (std::size_t i = 0; i < trajectory.pieces(); ++i) {
    const double t = trajectory.piece(i).start;
    if (t > from + kShort && t < to - kShort) add(t);
  }
  add(to);
  return Trajectory::through(times, knots);
}

Result<Trajectory> time_tool_path_at_speed(const JointPath& path, std::span<const double> stops,
                                           const JointLimits& limits,
                                           const TimingOptions& options) {
  constexpr double kMissed = 1e-9;  // [rad or m]
  constexpr double kSame = 1e-9;    // of the whole parameter range
  if (auto checked = detail::check_tool_path(path); !checked) return fail(checked.error());
  if (path.q.size() < 2) return time_tool_path(path, stops, limits, options);
  const SplinePoint start = CubicSpline(path.s, path.q).at(path.s.front(), 0);
  std::vector<double> later;
  std::ranges::copy_if(stops, std::back_inserter(later), [&](double s) {
    return s > path.s.front() + kSame * (path.s.back() - path.s.front());
  });
  Result<Trajectory> whole =
      time_tool_path(with_run_up(path, start, run_up_of(path, options)), later, limits, options);
  if (!whole) return whole;
  Result<Trajectory> motion = part_of(*whole, end_of_run_up(*whole, start), whole->duration());
  if (motion && (motion->at(0).q - start.q).cwiseAbs().maxCoeff() > kMissed) {
    return fail(Errc::bad_input, text(msg::trajectory_bad_knots));
  }
  return motion;
}

}  // namespace mjarm
