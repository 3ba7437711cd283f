#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "mjarm/core/messages/trajectory.hpp"
#include "mjarm/trajectory/limits_internal.hpp"
#include "mjarm/trajectory/smooth_timing_internal.hpp"
#include "mjarm/trajectory/spline_internal.hpp"
#include "mjarm/trajectory/tool_path_internal.hpp"
#include "mjarm/trajectory/trajectory.hpp"

namespace mjarm {
namespace {

using detail::Bounds;
using detail::CubicSpline;

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

}  // namespace

Result<void> detail::check_tool_path(const JointPath& path) {
  const auto bad = [](std::size_t i) {
    return fail(Errc::bad_input, text(msg::trajectory_bad_path, i));
  };
  if (path.q.empty() || path.q.size() != path.s.size()) return bad(0);
  const Eigen::Index dof = path.q[0].size();
  for (std::size_t i = 0; i < path.q.size(); ++i) {
    const bool ascends = i == 0 || path.s[i] > path.s[i - 1];
    if (dof == 0 || path.q[i].size() != dof || !path.q[i].allFinite() ||
        !std::isfinite(path.s[i]) || !ascends) {
      return bad(i);
    }
  }
  return {};
}

Result<Trajectory> time_tool_path(const JointPath& path, std::span<const double> stops,
                                  const JointLimits& limits, const TimingOptions& options) {
  if (auto checked = detail::check_tool_path(path); !checked) return fail(checked.error());
  const Result<Bounds> bounds = detail::bounds_of(limits, options, path.q[0].size());
  if (!bounds) return fail(bounds.error());
  const Result<std::vector<std::size_t>> rests = rests_of(path, stops);
  if (!rests) return fail(rests.error());

  detail::PathBounds tool{options.tool_speed, options.tool_accel,
                          options.tool_accel / options.tool_ramp};
  if (!options.tool_speeds.empty()) tool.asked = &options;
  const Result<Trajectory> rest = Trajectory::through({0.0}, {JointState::at_rest(path.q[0])});
  if (!rest) return fail(rest.error());
  std::vector<Trajectory> parts{*rest};
  for (std::size_t i = 0; i + 1 < rests->size(); ++i) {
    const std::size_t first = (*rests)[i], count = (*rests)[i + 1] - first + 1;
    const CubicSpline spline(std::span(path.s).subspan(first, count),
                             std::span(path.q).subspan(first, count));
    Result<Trajectory> part = detail::time_smoothly(spline, *bounds, tool);
    if (!part) return fail(std::move(part.error()));
    parts.push_back(std::move(*part));
  }
  return Trajectory::chain(parts);
}

}  // namespace mjarm
