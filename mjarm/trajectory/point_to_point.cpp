#include "mjarm/trajectory/point_to_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "mjarm/core/messages/trajectory.hpp"
#include "mjarm/trajectory/kept_limits_internal.hpp"
#include "mjarm/trajectory/movers_internal.hpp"

namespace mjarm {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();

/// @param h  [s] by so much; a phase far shorter than the motion loses digits where it is told by
///           its ends.
PointToPoint::Piece moved_by(const PointToPoint::Piece& piece, double h) noexcept {
  return {piece.t + h, piece.q + h * (piece.v + h * (0.5 * piece.a + h / 6 * piece.jerk)),
          piece.v + h * (piece.a + 0.5 * h * piece.jerk), piece.a + h * piece.jerk, piece.jerk};
}

/// @param piece  one that begins at or before `t`.
PointToPoint::Piece moved_on(const PointToPoint::Piece& piece, double t) noexcept {
  return moved_by(piece, t - piece.t);
}

// Times of a motion of duration T are exact to eps T. What a limit changes in that time must be a
// small share of the limit below it, or no double can say when a phase of it ends.
constexpr double kTimeShare = 1e-7;
// Beyond this, squares and cubes of limits overflow.
constexpr double kLargest = 1e60;

/// The largest `limit` that still counts beside the one below it: a motion with it is but a few
/// 1e-9 of its time longer than one with more. 0 and infinite limits stay.
double within_time(double limit, double below, double duration) noexcept {
  if (!std::isfinite(limit)) return limit;
  const double most = duration > 0 ? kTimeShare / kEps * below / duration : kLargest;
  return std::min({limit, most, kLargest});
}

bool beyond_time(const JointLimits& limits, double duration) noexcept {
  for (int i = 0; i < limits.jerk.size(); ++i) {
    const double a = limits.acceleration[i], j = limits.jerk[i];
    if (within_time(a, limits.velocity[i], duration) != a || within_time(j, a, duration) != j) {
      return true;
    }
  }
  return false;
}

JointLimits within_time(JointLimits limits, double duration) noexcept {
  for (int i = 0; i < limits.jerk.size(); ++i) {
    double& a = limits.acceleration[i];
    a = within_time(a, limits.velocity[i], duration);
    limits.jerk[i] = within_time(limits.jerk[i], a, duration);
  }
  return limits;
}

}  // namespace

Result<PointToPoint, PointToPointFailure> PointToPoint::solve(const JointState& start,
                                                              const JointState& end,
                                                              const JointLimits& limits) noexcept {
  Result<PointToPoint, PointToPointFailure> result;
  detail::Movers movers;
  auto failure = movers.set(start, end, limits);
  double duration = failure ? 0 : movers.common_duration();
  if (!failure && std::isfinite(duration) && beyond_time(limits, duration)) {
    failure = movers.set(start, end, within_time(limits, duration));
    if (!failure) duration = movers.common_duration();
  }
  if (!failure && !std::isfinite(duration)) {
    failure = PointToPointFailure{PointToPointErrc::bad_states, 0};
  }
  if (!failure) failure = movers.keep_ranges(duration);
  if (failure) {
    result = tl::unexpected(*failure);
    return result;
  }
  result->start_ = start;
  result->end_ = end;
  result->duration_ = duration;
  for (int i = 0; i < result->dof(); ++i) {
    Joint& joint = result->joints_[static_cast<std::size_t>(i)];
    joint.count = 0;
    Piece piece{0, start.q[i], start.v[i], start.a[i], 0};
    const detail::Phases motion = movers[i].motion(result->duration_);
    for (const detail::JerkPhase& phase : motion.all()) {
      piece.a = phase.a;
      piece.jerk = phase.jerk;
      joint.pieces[static_cast<std::size_t>(joint.count++)] = piece;
      piece = moved_by(piece, phase.duration);
    }
  }
  return result;
}

std::span<const PointToPoint::Piece> PointToPoint::pieces(int joint) const noexcept {
  const Joint& j = joints_[static_cast<std::size_t>(joint)];
  return {j.pieces.data(), static_cast<std::size_t>(j.count)};
}

JointState PointToPoint::at(double t) const noexcept {
  if (t >= duration_) return end_;
  JointState state = start_;
  if (t <= 0) return state;
  for (int i = 0; i < dof(); ++i) {
    const std::span<const Piece> all = pieces(i);
    if (all.empty()) continue;
    std::size_t k = 0;
    while (k + 1 < all.size() && all[k + 1].t <= t) ++k;
    const Piece now = moved_on(all[k], t);
    state.q[i] = now.q;
    state.v[i] = now.v;
    state.a[i] = now.a;
  }
  return state;
}

namespace {

Error in_words(const PointToPointFailure& failure, const JointState& start, const JointState& end,
               const JointLimits& limits) {
  const int i = failure.joint;
  switch (failure.code) {
    case PointToPointErrc::bad_limits:
      return {Errc::bad_input, text(msg::trajectory_bad_limits, start.q.size())};
    case PointToPointErrc::end_outside:
      return {Errc::impossible, text(msg::trajectory_end_outside, i + 1, end.v[i], end.a[i])};
    case PointToPointErrc::start_leaves_range:
      return {Errc::impossible, text(msg::trajectory_start_leaves_range, i + 1, start.v[i],
                                     start.a[i], failure.beyond, limits.lower[i], limits.upper[i])};
    case PointToPointErrc::end_leaves_range:
      return {Errc::impossible, text(msg::trajectory_end_leaves_range, i + 1, end.v[i], end.a[i],
                                     failure.beyond, limits.lower[i], limits.upper[i])};
    case PointToPointErrc::no_room:
      return {Errc::impossible,
              text(msg::trajectory_no_room, i + 1, limits.lower[i], limits.upper[i])};
    case PointToPointErrc::bad_states:
      break;
  }
  return {Errc::bad_input, text(msg::trajectory_bad_states)};
}

/// All joints in common phases of constant jerk, each phase from the state in which it begins:
/// rounding of its duration does not add up on the way.
Result<Trajectory> in_common_phases(const PointToPoint& motion, const JointState& start,
                                    const JointState& end) {
  std::vector<double> times{0, motion.duration()};
  for (int i = 0; i < motion.dof(); ++i) {
    for (const PointToPoint::Piece& piece : motion.pieces(i)) times.push_back(piece.t);
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  std::vector<Trajectory> phases;
  std::array<std::size_t, kMaxDof> now{};
  JointState state = start;
  for (std::size_t k = 0; k + 1 < times.size() && times[k] < motion.duration(); ++k) {
    JointVec jerk = JointVec::Zero(motion.dof());
    for (int i = 0; i < motion.dof(); ++i) {
      const auto pieces = motion.pieces(i);
      std::size_t& n = now[static_cast<std::size_t>(i)];
      while (n + 1 < pieces.size() && pieces[n + 1].t <= times[k]) ++n;
      if (pieces.empty()) continue;
      const PointToPoint::Piece piece = moved_on(pieces[n], times[k]);
      state.q[i] = piece.q;
      state.v[i] = piece.v;
      state.a[i] = piece.a;
      jerk[i] = piece.jerk;
    }
    JointState next = k + 2 < times.size() ? motion.at(times[k + 1]) : end;
    Result<Trajectory> phase =
        Trajectory::from_jerks(state, std::array{times[k + 1] - times[k]}, std::array{jerk}, next);
    if (!phase) return phase;
    phases.push_back(*std::move(phase));
    state = std::move(next);
  }
  if (phases.empty()) return Trajectory::from_jerks(start, {}, {}, end);
  return Trajectory::chain(phases);
}

}  // namespace

Result<Trajectory> point_to_point(const JointState& start, const JointState& end,
                                  const JointLimits& limits) {
  const auto motion = PointToPoint::solve(start, end, limits);
  if (!motion) return fail(in_words(motion.error(), start, end, limits));
  if (!limits.jerk.allFinite()) {
    return fail(Errc::bad_input, text(msg::trajectory_bad_limits, start.q.size()));
  }
  return in_common_phases(*motion, start, end).and_then([&](Trajectory whole) {
    return detail::check_kept(whole, limits, true).map([&] { return std::move(whole); });
  });
}

}  // namespace mjarm
