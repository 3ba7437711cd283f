#include "mjarm/trajectory/point_to_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "mjarm/core/messages/trajectory.hpp"
#include "mjarm/trajectory/extremal_internal.hpp"
#include "mjarm/trajectory/kept_limits_internal.hpp"
#include "mjarm/trajectory/recovery_internal.hpp"
#include "mjarm/trajectory/sound_state_internal.hpp"

namespace mjarm {
namespace {

using detail::JerkPhase;
using detail::JointTimes;
using detail::OneJoint;
using detail::Recovery;

constexpr double kEps = std::numeric_limits<double>::epsilon();

/// Two motions of one joint laid over another, with weights that add up to 1. The limits are
/// convex, so what keeps them twice keeps them in between.
class Blend {
 public:
  Blend(const JointTimes& times, double way, double duration) noexcept
      : up_(times.up().phases(duration)), down_(times.down().phases(duration)) {
    const double farthest = times.up().at(duration).way;
    const double nearest = -times.down().at(duration).way;
    const double range = farthest - nearest;
    up_weight_ = range > 0 ? std::clamp((way - nearest) / range, 0.0, 1.0) : 1;
    down_weight_ = range > 0 ? std::clamp((farthest - way) / range, 0.0, 1.0) : 0;
    // A motion that is all but one of the two is that one.
    if (up_weight_ < 16 * kEps) up_weight_ = 0, down_weight_ = 1;
    if (down_weight_ < 16 * kEps) up_weight_ = 1, down_weight_ = 0;
  }

  /// Calls `add(duration, a, jerk)` for each stretch of constant jerk.
  template <class Add>
  void for_each(Add add) const noexcept {
    if (down_weight_ == 0) return alone(up_, 1, add);
    if (up_weight_ == 0) return alone(down_, -1, add);
    std::size_t i = 0, k = 0;
    double up_done = 0, down_done = 0;
    while (i < up_.size() && k < down_.size()) {
      const double up_left = up_[i].duration - up_done, down_left = down_[k].duration - down_done;
      const double h = std::min(up_left, down_left);
      if (h > 0) {
        add(h,
            up_weight_ * (up_[i].a + up_[i].jerk * up_done) -
                down_weight_ * (down_[k].a + down_[k].jerk * down_done),
            up_weight_ * up_[i].jerk - down_weight_ * down_[k].jerk);
      }
      up_done += h;
      down_done += h;
      if (up_left <= h) ++i, up_done = 0;
      if (down_left <= h) ++k, down_done = 0;
    }
  }

 private:
  template <class Add>
  static void alone(const std::array<JerkPhase, 7>& phases, double sign, Add add) noexcept {
    for (const JerkPhase& phase : phases) {
      if (phase.duration > 0) add(phase.duration, sign * phase.a, sign * phase.jerk);
    }
  }

  std::array<JerkPhase, 7> up_, down_;
  double up_weight_, down_weight_;
};

/// One joint: the motion back within the limits, and all fastest ones from there.
class Mover {
 public:
  explicit Mover(const OneJoint& joint) noexcept
      : recovery_(joint), joint_(after(joint, recovery_)), times_(joint_) {}

  [[nodiscard]] double first_possible(double from) const noexcept {
    const double rest = times_.first_possible(from - recovery_.duration);
    return rest > from - recovery_.duration ? std::max(from, recovery_.duration + rest) : from;
  }

  /// Calls `add(duration, a, jerk)` for each stretch of constant jerk of the motion so long.
  template <class Add>
  void for_each(double duration, Add add) const noexcept {
    for (const JerkPhase& phase : recovery_.phases) {
      if (phase.duration > 0) add(phase.duration, phase.a, phase.jerk);
    }
    Blend(times_, joint_.way, duration - recovery_.duration).for_each(add);
  }

 private:
  /// Limits are widened to hold what rounding leaves of the ends.
  static OneJoint after(OneJoint joint, const Recovery& recovery) noexcept {
    joint.v0 = recovery.v;
    joint.a0 = recovery.a;
    joint.way -= recovery.way;
    const double r = joint.inverse_jerk;
    joint.a_max = std::max({joint.a_max, std::abs(joint.a0), std::abs(joint.a1)});
    joint.v_max =
        std::max({joint.v_max, std::abs(joint.v0 + 0.5 * r * joint.a0 * std::abs(joint.a0)),
                  std::abs(joint.v1 - 0.5 * r * joint.a1 * std::abs(joint.a1))});
    return joint;
  }

  Recovery recovery_;
  OneJoint joint_;
  JointTimes times_;
};

std::optional<PointToPointErrc> fault(const OneJoint& joint) noexcept {
  const double r = joint.inverse_jerk;
  const bool limited = std::isfinite(joint.a_max) || r > 0;
  if (!(joint.v_max > 0 && joint.a_max > 0 && r >= 0 && std::isfinite(r) && limited)) {
    return PointToPointErrc::bad_limits;
  }
  // The velocity it comes from when it arrives with an acceleration.
  const double before = joint.v1 - 0.5 * r * joint.a1 * std::abs(joint.a1);
  constexpr double kSlack = 1 + detail::kLimitSlack;
  if (std::max(std::abs(joint.v1), std::abs(before)) > joint.v_max * kSlack ||
      std::abs(joint.a1) > joint.a_max * kSlack) {
    return PointToPointErrc::end_outside;
  }
  return std::nullopt;
}

/// All joints of a problem.
class Movers {
 public:
  /// @return why there is no motion.
  std::optional<PointToPointFailure> set(const JointState& start, const JointState& end,
                                         const JointLimits& limits) noexcept {
    dof_ = static_cast<int>(start.q.size());
    if (!is_sound(start, dof_) || !is_sound(end, dof_)) {
      return PointToPointFailure{PointToPointErrc::bad_states, 0};
    }
    if (limits.velocity.size() != dof_ || limits.acceleration.size() != dof_ ||
        limits.jerk.size() != dof_) {
      return PointToPointFailure{PointToPointErrc::bad_limits, 0};
    }
    for (int i = 0; i < dof_; ++i) {
      const double r = 1 / limits.jerk[i], way = end.q[i] - start.q[i];
      // Without a jerk limit the acceleration jumps, whatever it was.
      const double a0 = r == 0 ? 0 : start.a[i], a1 = r == 0 ? 0 : end.a[i];
      const OneJoint joint{start.v[i],
                           a0,
                           end.v[i],
                           a1,
                           way,
                           limits.velocity[i],
                           limits.acceleration[i],
                           r,
                           8 * kEps * (std::abs(start.q[i]) + std::abs(end.q[i]))};
      if (const auto code = fault(joint)) return PointToPointFailure{*code, i};
      movers_[static_cast<std::size_t>(i)].emplace(joint);
    }
    return std::nullopt;
  }

  [[nodiscard]] const Mover& operator[](int i) const noexcept {
    return *movers_[static_cast<std::size_t>(i)];
  }

  /// Whatever a joint asks for bounds all from below; the first duration that suits all is the
  /// answer. Each asks for a few later ones at most, one for each of its gaps.
  [[nodiscard]] double common_duration() const noexcept {
    double duration = 0;
    for (int i = 0, content = 0; content < dof_; i = (i + 1) % dof_) {
      const double asked = (*this)[i].first_possible(duration);
      content = asked > duration ? 1 : content + 1;
      duration = std::max(duration, asked);
    }
    return duration;
  }

 private:
  int dof_ = 0;
  std::array<std::optional<Mover>, kMaxDof> movers_;
};

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
  Movers movers;
  auto failure = movers.set(start, end, limits);
  double duration = failure ? 0 : movers.common_duration();
  if (!failure && std::isfinite(duration) && beyond_time(limits, duration)) {
    failure = movers.set(start, end, within_time(limits, duration));
    if (!failure) duration = movers.common_duration();
  }
  if (failure) {
    result = tl::unexpected(*failure);
    return result;
  }
  result->start_ = start;
  result->end_ = end;
  result->duration_ = duration;
  if (!std::isfinite(result->duration_)) {
    result = tl::unexpected(PointToPointFailure{PointToPointErrc::bad_states, 0});
    return result;
  }
  for (int i = 0; i < result->dof(); ++i) {
    Joint& joint = result->joints_[static_cast<std::size_t>(i)];
    joint.count = 0;
    Piece piece{0, start.q[i], start.v[i], start.a[i], 0};
    movers[i].for_each(result->duration_, [&](double time, double a, double jerk) {
      piece.a = a;
      piece.jerk = jerk;
      joint.pieces[static_cast<std::size_t>(joint.count++)] = piece;
      piece = moved_by(piece, time);
    });
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

Error in_words(const PointToPointFailure& failure, const JointState& start, const JointState& end) {
  switch (failure.code) {
    case PointToPointErrc::bad_limits:
      return {Errc::bad_input, text(msg::trajectory_bad_limits, start.q.size())};
    case PointToPointErrc::end_outside:
      return {Errc::impossible, text(msg::trajectory_end_outside, failure.joint + 1,
                                     end.v[failure.joint], end.a[failure.joint])};
    case PointToPointErrc::bad_states:
      break;
  }
  return {Errc::bad_input, text(msg::trajectory_bad_states)};
}

/// The largest and the smallest value of a joint over its motion.
struct Range {
  double low, high;
};
Range range_of(std::span<const PointToPoint::Piece> pieces, double duration, double q0, double q1) {
  Range range{std::min(q0, q1), std::max(q0, q1)};
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const PointToPoint::Piece& p = pieces[k];
    const double h = (k + 1 < pieces.size() ? pieces[k + 1].t : duration) - p.t;
    // Where the velocity is 0: both roots of v + a x + jerk x^2 / 2, without cancellation.
    const double root = std::sqrt(std::max(0.0, p.a * p.a - 2 * p.jerk * p.v));
    const double b = -(p.a + std::copysign(root, p.a));
    for (const double x : {b / p.jerk, 2 * p.v / b, h}) {
      if (!(x > 0 && x <= h)) continue;
      const double q = moved_on(p, p.t + x).q;
      range = {std::min(range.low, q), std::max(range.high, q)};
    }
  }
  return range;
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
  if (!motion) return fail(in_words(motion.error(), start, end));
  if (!limits.jerk.allFinite()) {
    return fail(Errc::bad_input, text(msg::trajectory_bad_limits, start.q.size()));
  }
  constexpr double kRounding = 1e-9;
  for (int i = 0; i < motion->dof() && limits.lower.size() == motion->dof(); ++i) {
    const double q0 = start.q[i], q1 = end.q[i];
    const Range range = range_of(motion->pieces(i), motion->duration(), q0, q1);
    const double lower = std::min({limits.lower[i], q0, q1}) - kRounding;
    const double upper = std::max({limits.upper[i], q0, q1}) + kRounding;
    if (range.low >= lower && range.high <= upper) continue;
    return fail(Errc::impossible,
                text(msg::trajectory_leaves_range, i + 1,
                     range.low < lower ? range.low : range.high, limits.lower[i], limits.upper[i]));
  }
  return in_common_phases(*motion, start, end).and_then([&](Trajectory whole) {
    return detail::check_kept(whole, limits, true).map([&] { return std::move(whole); });
  });
}

}  // namespace mjarm
