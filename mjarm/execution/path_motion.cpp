#include "mjarm/execution/path_motion.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "mjarm/execution/motion_proof_internal.hpp"
#include "mjarm/execution/motion_shortcuts_internal.hpp"
#include "mjarm/trajectory/at_speed.hpp"
#include "mjarm/trajectory/point_to_point.hpp"
#include "mjarm/trajectory/via_points.hpp"

namespace mjarm {
namespace {

/// A motion through all corners.
struct CornerMotion {
  Trajectory motion;
  std::vector<double> times;  ///< [s] when it is at each corner
};

/// Along the edges, with a rest at each corner.
Result<CornerMotion> stop_at_corners(std::span<const JointVec> corners, const JointLimits& limits) {
  Result<Trajectory> motion = Trajectory::through({0.0}, {JointState::at_rest(corners[0])});
  CornerMotion out{{}, {0}};
  std::vector<Trajectory> edges;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    Result<Trajectory> edge = time_joint_move(as_span(corners[i - 1]), as_span(corners[i]), limits);
    if (!edge) return fail(edge.error());
    out.times.push_back(out.times.back() + edge->duration());
    edges.push_back(std::move(*edge));
  }
  if (!edges.empty()) motion = Trajectory::chain(edges);
  if (!motion) return fail(motion.error());
  out.motion = std::move(*motion);
  return out;
}

/// Without a rest, free to swing out between corners; where that is not proved, through more places
/// of the edges.
std::optional<CornerMotion> swing_round_corners(std::span<const JointVec> corners,
                                                const JointLimits& limits, const WayProver& prover,
                                                const StopCheck& stop) {
  constexpr std::size_t kMaxPoints = 48;
  std::vector<JointVec> points(corners.begin(), corners.end());
  std::vector<std::size_t> corner(corners.size());  // which point each is
  std::iota(corner.begin(), corner.end(), std::size_t{0});
  while (points.size() <= kMaxPoints && !is_stopped(stop)) {
    Result<ViaMotion> motion = time_via_points(points, limits);
    if (!motion) return std::nullopt;
    std::size_t unproved = 0;
    for (std::size_t i = points.size() - 1; i > 0; --i) {
      const Result<Trajectory> part =
          part_of(motion->trajectory, motion->times[i - 1], motion->times[i]);
      if (part && detail::is_proved(*part, prover)) continue;
      ++unproved;
      points.insert(points.begin() + static_cast<std::ptrdiff_t>(i),
                    0.5 * (points[i - 1] + points[i]));
      for (std::size_t& at : corner) at += at >= i ? 1 : 0;
    }
    if (unproved > 0) continue;
    CornerMotion out{std::move(motion->trajectory), {}};
    for (const std::size_t at : corner) out.times.push_back(motion->times[at]);
    return out;
  }
  return std::nullopt;
}

}  // namespace

Result<PathMotion> time_path(std::span<const JointVec> corners, const JointLimits& limits,
                             const WayProver& prover, const PathMotionOptions& options) {
  Result<CornerMotion> motion = stop_at_corners(corners, limits);
  if (!motion) return fail(motion.error());
  const double stopping = motion->times.back();
  // Shortcuts hardly find a way over a place with a rest, and need no better start without one.
  if (!options.passed.empty()) {
    auto swung = swing_round_corners(corners, limits, prover, options.stop);
    if (swung && swung->times.back() < stopping) motion = std::move(*swung);
  }
  std::vector<detail::MetPlace> met;
  for (const std::size_t i : options.passed) met.push_back({motion->times[i], corners[i]});
  return PathMotion{detail::shortened_in_time(limits, prover, met, options.attempts, options.stop,
                                              motion->motion),
                    stopping};
}

std::optional<Trajectory> lead_into(const Trajectory& motion, const JointState& end,
                                    const JointLimits& limits, const WayProver& prover) {
  constexpr int kTails = 30;
  constexpr double kTail = 0.05;  // [s] from one to the next longer one
  struct Led {
    double first;  // [s] of the motion that stay
    Trajectory tail;
    double duration() const { return first + tail.duration(); }
  };
  std::vector<Led> ways;
  for (int i = 1; i <= kTails && i * kTail < motion.duration(); ++i) {
    const double first = motion.duration() - i * kTail;
    auto tail = point_to_point(motion.at(first), end, limits);
    if (tail && first + tail->duration() < motion.duration()) ways.push_back({first, *tail});
  }
  std::ranges::stable_sort(ways, {}, &Led::duration);
  for (const Led& way : ways) {
    if (!detail::is_proved(way.tail, prover)) continue;
    const Result<Trajectory> front = part_of(motion, 0, way.first);
    if (!front) continue;
    Result<Trajectory> whole = Trajectory::chain(std::vector{*front, way.tail});
    if (whole) return std::move(*whole);
  }
  return std::nullopt;
}

}  // namespace mjarm
