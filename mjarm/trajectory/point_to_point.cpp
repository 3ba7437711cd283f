#include "mjarm/trajectory/point_to_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "mjarm/core/messages/trajectory.hpp"
#include "mjarm/trajectory/extremal_internal.hpp"
#include "mjarm/trajectory/recovery_internal.hpp"

namespace mjarm {
namespace {

using detail::JerkPhase;
using detail::JointTimes;
using detail::OneJoint;
using detail::Recovery;

constexpr double kEps = std::numeric_limits<double>::epsilon();

bool sound(const JointState& state, Eigen::Index dof) {
  return state.q.size() == dof && state.v.size() == dof && state.a.size() == dof &&
         state.q.allFinite() && state.v.allFinite() && state.a.allFinite();
}

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
  const auto positive = [](double x) { return x > 0; };
  if (!positive(joint.v_max) || !positive(joint.a_max) || !(joint.inverse_jerk >= 0) ||
      std::isinf(joint.inverse_jerk) || (std::isinf(joint.a_max) && joint.inverse_jerk == 0)) {
    return PointToPointErrc::bad_limits;
  }
  constexpr double kSlack = 1 + detail::kLimitSlack;
  // Where the joint comes from, with full jerk, when it arrives with an acceleration.
  const double r = joint.inverse_jerk;
  const double before = joint.v1 - 0.5 * r * joint.a1 * std::abs(joint.a1);
  if (std::abs(joint.v1) > joint.v_max * kSlack || std::abs(joint.a1) > joint.a_max * kSlack ||
      std::abs(before) > joint.v_max * kSlack) {
    return PointToPointErrc::end_outside;
  }
  return std::nullopt;
}

/// @param piece  one that begins at or before `t`.
PointToPoint::Piece moved_on(const PointToPoint::Piece& piece, double t) noexcept {
  const double h = t - piece.t;
  return {t, piece.q + h * (piece.v + h * (0.5 * piece.a + h / 6 * piece.jerk)),
          piece.v + h * (piece.a + 0.5 * h * piece.jerk), piece.a + h * piece.jerk, piece.jerk};
}

}  // namespace

Result<PointToPoint, PointToPointFailure> PointToPoint::solve(const JointState& start,
                                                              const JointState& end,
                                                              const JointLimits& limits) noexcept {
  Result<PointToPoint, PointToPointFailure> result;
  const Eigen::Index dof = start.q.size();
  const auto refuse = [&](PointToPointErrc code, Eigen::Index joint) {
    result = tl::unexpected(PointToPointFailure{code, static_cast<int>(joint)});
  };
  if (dof == 0 || !sound(start, dof) || !sound(end, dof)) {
    refuse(PointToPointErrc::bad_states, 0);
    return result;
  }
  if (limits.velocity.size() != dof || limits.acceleration.size() != dof ||
      limits.jerk.size() != dof) {
    refuse(PointToPointErrc::bad_limits, 0);
    return result;
  }
  std::array<std::optional<Mover>, kMaxDof> movers;
  const auto mover = [&](Eigen::Index i) -> std::optional<Mover>& {
    return movers[static_cast<std::size_t>(i)];
  };
  for (Eigen::Index i = 0; i < dof; ++i) {
    const OneJoint joint{start.v[i],
                         start.a[i],
                         end.v[i],
                         end.a[i],
                         end.q[i] - start.q[i],
                         limits.velocity[i],
                         limits.acceleration[i],
                         1 / limits.jerk[i]};
    if (const auto code = fault(joint)) {
      refuse(*code, i);
      return result;
    }
    mover(i).emplace(joint);
  }

  // Whatever a joint asks for is a lower bound for all; the first that suits all is the answer.
  double duration = 0;
  for (Eigen::Index i = 0, content = 0; content < dof; i = (i + 1) % dof) {
    const double t = mover(i)->first_possible(duration);
    content = t > duration ? 1 : content + 1;
    duration = t;
  }

  result->start_ = start;
  result->end_ = end;
  result->duration_ = duration;
  for (Eigen::Index i = 0; i < dof; ++i) {
    Joint& joint = result->joints_[static_cast<std::size_t>(i)];
    joint.count = 0;
    Piece at{0, start.q[i], start.v[i], start.a[i], 0};
    mover(i)->for_each(duration, [&](double h, double a, double jerk) {
      at.a = a;
      at.jerk = jerk;
      joint.pieces[static_cast<std::size_t>(joint.count++)] = at;
      at = moved_on(at, at.t + h);
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

/// All joints in common phases of constant jerk.
Result<Trajectory> in_common_phases(const PointToPoint& motion, const JointState& start,
                                    const JointState& end) {
  std::vector<double> times{0, motion.duration()};
  for (int i = 0; i < motion.dof(); ++i) {
    for (const PointToPoint::Piece& piece : motion.pieces(i)) times.push_back(piece.t);
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  std::vector<double> durations;
  std::vector<JointVec> jerks;
  std::array<std::size_t, kMaxDof> now{};
  for (std::size_t k = 0; k + 1 < times.size() && times[k] < motion.duration(); ++k) {
    durations.push_back(times[k + 1] - times[k]);
    JointVec& jerk = jerks.emplace_back(JointVec::Zero(motion.dof()));
    for (int i = 0; i < motion.dof(); ++i) {
      const auto pieces = motion.pieces(i);
      std::size_t& n = now[static_cast<std::size_t>(i)];
      while (n + 1 < pieces.size() && pieces[n + 1].t <= times[k]) ++n;
      if (!pieces.empty()) jerk[i] = pieces[n].jerk;
    }
  }
  return Trajectory::from_jerks(start, durations, jerks, end);
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
  return in_common_phases(*motion, start, end);
}

}  // namespace mjarm
