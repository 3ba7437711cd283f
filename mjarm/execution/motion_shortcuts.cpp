#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "mjarm/core/rng.hpp"
#include "mjarm/execution/motion_proof_internal.hpp"
#include "mjarm/execution/motion_shortcuts_internal.hpp"
#include "mjarm/trajectory/at_speed.hpp"
#include "mjarm/trajectory/point_to_point.hpp"

namespace mjarm::detail {
namespace {

constexpr std::uint64_t kRuns = 3;    // with other random numbers each, of which the best counts
constexpr double kLeastGain = 1e-4;   // [s] of a shortcut
constexpr std::size_t kWindow = 300;  // attempts that have to save
constexpr double kPays = 0.002;       // this share of the duration together
constexpr int kTurns = 4;             // one attempt of so many does not go through a state beside
constexpr double kFirstStep = 0.15, kLeastStep = 3e-3, kMaxStep = 0.5;  // [rad or m, L2] to there
constexpr double kLonger = 1.5, kShorter = 0.97;  // the next step after one that worked or failed

class Shortcuts {
 public:
  Shortcuts(const JointLimits& limits, const WayProver& prover, std::vector<MetPlace> met,
            const Trajectory& motion, std::uint64_t seed)
      : limits_(limits), prover_(prover), met_(std::move(met)), motion_(motion), rng_(seed, 9) {}

  Trajectory run(int attempts, const StopCheck& stop) {
    attempt({0, motion_.duration()}, true);
    std::vector<double> durations;
    for (int k = 0; k < attempts && !is_stopped(stop); ++k) {
      const double duration = motion_.duration();
      durations.push_back(duration);
      if (durations.size() > kWindow) {
        const double before = durations[durations.size() - 1 - kWindow];
        if (before - duration < kPays * duration) break;
      }
      attempt(random_span(), k % kTurns == 0);
    }
    return std::move(motion_);
  }

 private:
  struct Span {
    double from, to;  // [s]
    double length() const { return to - from; }
  };

  /// Anywhere, or round a place that has to be met.
  Span random_span() {
    constexpr double kRoundPlaces = 0.3;
    const double duration = motion_.duration();
    if (!met_.empty() && rng_.uniform() < kRoundPlaces) {
      const double t = met_[static_cast<std::size_t>(rng_.below(met_.size()))].t;
      const double before = rng_.uniform(), after = rng_.uniform();
      return {t - before * before * t, t + after * after * (duration - t)};
    }
    const double a = rng_.uniform() * duration, b = rng_.uniform() * duration;
    return {std::min(a, b), std::max(a, b)};
  }

  void attempt(Span span, bool straight) {
    const auto place = std::ranges::upper_bound(met_, span.from, {}, &MetPlace::t);
    const bool meets = place != met_.end() && place->t < span.to;
    if (meets && place + 1 != met_.end()) span.to = std::min(span.to, (place + 1)->t);
    if (span.length() < kLeastGain) return;
    if (meets) {
      go_through(span, &*place);
    } else if (straight) {
      cut(span);
    } else {
      step_ *= go_through(span, nullptr) ? kLonger : kShorter;
      if (step_ < kLeastStep || step_ > kMaxStep) step_ = kFirstStep;
    }
  }

  void cut(const Span& span) {
    const auto piece = between(motion_.at(span.from), motion_.at(span.to), span.length());
    if (piece && is_proved(*piece, prover_)) replace(span, *piece);
  }

  /// Over the place, or through a state beside the motion.
  bool go_through(const Span& span, MetPlace* place) {
    constexpr double kNearest = 0.2;  // of the length, to its ends
    const double t = place != nullptr
                         ? place->t
                         : span.from + rng_.uniform(kNearest, 1 - kNearest) * span.length();
    const JointState first = motion_.at(span.from), last = motion_.at(span.to);
    const JointState now = motion_.at(t);
    const JointVec straight = (last.q - first.q) / span.length();
    const JointState middle =
        place != nullptr ? faster_over(*place, now, first, last) : random_state(now, straight);
    const auto one = between(first, middle, span.length());
    if (!one) return false;
    const auto two = between(middle, last, span.length() - one->duration());
    if (!two || !is_proved(*one, prover_) || !is_proved(*two, prover_)) return false;
    const Result<Trajectory> both = Trajectory::chain(std::array{*one, *two});
    if (!both || !replace(span, *both)) return false;
    if (place != nullptr) place->t = span.from + one->duration();
    return true;
  }

  /// A state beside the one now, moving somewhat as now, or as on the straight way.
  JointState random_state(const JointState& now, const JointVec& straight) {
    constexpr double kAsNow = 0.7, kSpread = 0.15, kMaxShare = 1.5;
    JointState out = now;
    const JointVec way = random_way(now.q.size());
    out.q += step_ / std::max(way.norm(), 1e-9) * way;
    if (rng_.uniform() < kAsNow) {
      out.v *= 1 + kSpread * rng_.normal();
    } else {
      out.v = rng_.uniform(0, kMaxShare) * straight;
    }
    const double some = kSpread * rng_.uniform();
    out.v += some * random_way(out.v.size()).cwiseProduct(limits_.velocity);
    out.a = random_acceleration(now.a);
    keep_limits(out);
    return out;
  }

  JointVec random_acceleration(const JointVec& now) {
    constexpr double kNone = 0.5, kSpread = 0.3;
    if (rng_.uniform() < kNone) return JointVec::Zero(now.size());
    const double share = rng_.uniform(), some = kSpread * rng_.uniform();
    const JointVec a =
        share * now + some * random_way(now.size()).cwiseProduct(limits_.acceleration);
    return a.cwiseMin(limits_.acceleration).cwiseMax(-limits_.acceleration);
  }

  /// Some of the way to the velocity with which the motion over a place is fastest.
  JointState faster_over(const MetPlace& place, const JointState& now, const JointState& from,
                         const JointState& to) {
    constexpr double kLeast = 0.1;
    JointState out{place.q, now.v, random_acceleration(now.a)};
    speed_up(from, to, out);
    out.v = now.v + rng_.uniform(kLeast, 1) * (out.v - now.v);
    keep_limits(out);
    return out;
  }

  /// Slows down joints that would be too fast before their acceleration is gone, or were.
  void keep_limits(JointState& state) const {
    for (Eigen::Index i = 0; i < state.v.size(); ++i) {
      double room = limits_.velocity[i] - state.a[i] * state.a[i] / (2 * limits_.jerk[i]);
      if (room < 0) {
        state.a[i] = 0;
        room = limits_.velocity[i];
      }
      state.v[i] = std::clamp(state.v[i], -room, room);
    }
  }

  /// Compass search for the velocity of `over` with which the motion over it is fastest.
  void speed_up(const JointState& from, const JointState& to, JointState& over) const {
    constexpr double kFirst = 0.3, kLast = 0.03;  // steps, as a share of the limit
    const auto duration = [&](const JointState& state) {
      const auto one = PointToPoint::solve(from, state, limits_);
      const auto two = PointToPoint::solve(state, to, limits_);
      return one && two ? one->duration() + two->duration()
                        : std::numeric_limits<double>::infinity();
    };
    double best = duration(over);
    for (double step = kFirst; step > kLast; step *= 0.5) {
      for (Eigen::Index i = 0; i < over.v.size(); ++i) {
        const double limit = limits_.velocity[i], v = over.v[i];
        for (const double side : {1.0, -1.0}) {
          JointState other = over;
          other.v[i] = std::clamp(v + side * step * limit, -limit, limit);
          const double found = duration(other);
          if (!(found < best)) continue;
          best = found;
          over = other;
          break;
        }
      }
    }
  }

  /// The fastest motion, where it takes less than that [s] and does not hit at a first look.
  std::optional<Trajectory> between(const JointState& from, const JointState& to,
                                    double less_than) const {
    constexpr int kLooks = 8;
    const auto fastest = PointToPoint::solve(from, to, limits_);
    if (!fastest || !(fastest->duration() < less_than - kLeastGain)) return std::nullopt;
    for (int i = 1; i < kLooks; ++i) {
      if (!prover_.is_free(fastest->at(fastest->duration() * i / kLooks).q)) return std::nullopt;
    }
    Result<Trajectory> motion = point_to_point(from, to, limits_);
    if (!motion) return std::nullopt;
    return std::move(*motion);
  }

  bool replace(const Span& span, const Trajectory& piece) {
    std::vector<Trajectory> parts;
    const auto keep = [&](double from, double to) {
      if (!(from < to)) return true;
      Result<Trajectory> part = part_of(motion_, from, to);
      if (part) parts.push_back(std::move(*part));
      return part.has_value();
    };
    if (!keep(0, span.from)) return false;
    parts.push_back(piece);
    if (!keep(span.to, motion_.duration())) return false;
    Result<Trajectory> whole = Trajectory::chain(parts);
    if (!whole) return false;
    motion_ = std::move(*whole);
    for (MetPlace& place : met_) {
      if (place.t >= span.to) place.t -= span.length() - piece.duration();
    }
    return true;
  }

  /// Of some joints.
  JointVec random_way(Eigen::Index dof) {
    JointVec way(dof);
    for (double& x : way) x = rng_.uniform() < 0.5 ? rng_.normal() : 0.0;
    return way;
  }

  const JointLimits& limits_;
  const WayProver& prover_;
  std::vector<MetPlace> met_;
  Trajectory motion_;
  Rng rng_;
  double step_ = kFirstStep;
};

}  // namespace

Trajectory shortened_in_time(const JointLimits& limits, const WayProver& prover,
                             const std::vector<MetPlace>& met, int attempts, const StopCheck& stop,
                             const Trajectory& motion) {
  Trajectory best = motion;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    Trajectory other = Shortcuts(limits, prover, met, motion, seed).run(attempts, stop);
    if (other.duration() < best.duration()) best = std::move(other);
  }
  return best;
}

}  // namespace mjarm::detail
