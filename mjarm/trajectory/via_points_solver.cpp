#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "mjarm/trajectory/via_points_solver_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr double kGuessUse = 0.95;     // share of the limits the first guess takes
constexpr double kFirstBarrier = 0.3;  // weight of the whole barrier, as a share of the duration
constexpr double kLastBarrier = 1e-3;  // the same at the end: about the duration left to gain
constexpr double kShrink = 0.5;        // of the barrier's weight after a good step
constexpr double kGoodStep = 0.3;      // share of a step from which on it is called good
constexpr double kToWall = 0.99;       // share of the way to the nearest limit that a step may take
constexpr double kDescent = 1e-4;      // share of the promised descent that a step must bring
constexpr double kPenalty = 2;         // of a room missed, in multipliers
constexpr int kHalvings = 12;          // of one step
constexpr int kPatience = 10;          // steps at the end without a better motion
constexpr double kBand = 1e4;          // multipliers stay within this factor of the central path
constexpr double kTiny = 0.1;          // of both neighbours: a step so short may be made in passing
constexpr double kShort = 0.2;         // of the mean cell: the barrier weighs less on shorter ones
constexpr double kWorth = 0.9;         // of the other guess is left at most, where passing works

/// A motion, the rooms taken for those of its rows, and its own rooms less those.
struct State {
  ViaSpline motion;
  std::vector<RowPairs> rooms, missed;
};

ViaSpline stretched(ViaSpline motion, double factor) {
  for (double& h : motion.h) h *= factor;
  motion.v /= factor;
  motion.a /= factor * factor;
  for (Inner& inner : motion.inner) {
    for (double& c : inner) c /= factor;
  }
  return motion;
}

/// Minimises duration - mu * (sum of log(room)) with mu going down: a primal-dual interior point
/// method. The rooms are unknowns of their own, which meet those of the rows only in the end, so
/// that bent limits do not shorten the steps; any motion on the way becomes one within the limits
/// when time is stretched, and the shortest of these is kept. J. Nocedal and S. Wright, Numerical
/// Optimization, 2nd ed., chapter 19.
class Descent {
 public:
  Descent(std::span<const JointVec> steps, const Bounds& bounds)
      : steps_(steps),
        bounds_(bounds),
        now_{ViaSpline(static_cast<int>(steps[0].size()), static_cast<int>(steps.size())), {}, {}},
        trial_(now_),
        step_(now_.motion),
        best_(now_.motion),
        shares_(step_.h.size(), 1.0),
        newton_(step_.joints(), step_.segments()),
        parts_(step_.inner.size()),
        room_steps_(parts_.size()),
        multipliers_(parts_.size()),
        multiplier_steps_(parts_.size()) {
    now_.rooms = now_.missed = room_steps_;
    trial_ = now_;
  }

  /// Makes the motion to start from. @return false where numbers overflow.
  /// @param in_passing  tiny steps take the time they have at the speed of their neighbours; else
  ///                    as long as from rest to rest.
  [[nodiscard]] bool guess(bool in_passing);
  void improve(int iterations);
  [[nodiscard]] const ViaSpline& best() const { return best_; }
  [[nodiscard]] double duration() const { return best_duration_; }

 private:
  /// How far the first-order step may go, <= 1, and the derivative of the merit along it.
  struct Reach {
    double step, multipliers, slope;
  };

  [[nodiscard]] SegmentTask task(int k, int j) const {
    return {steps_[static_cast<std::size_t>(k)][j], bounds_.v[j], bounds_.a[j], bounds_.j[j]};
  }
  /// Of the barrier's weight: less for a segment far shorter than the others, which the same
  /// weight would keep long.
  [[nodiscard]] double share_of(int k) const { return shares_[static_cast<std::size_t>(k)]; }
  template <class Call>
  void for_all(const Call& call) const {
    for (int k = 0; k < step_.segments(); ++k) {
      for (int j = 0; j < step_.joints(); ++j) call(k, j, step_.index(k, j));
    }
  }
  void time_alone();
  void time_in_passing();
  [[nodiscard]] bool keep_best();
  [[nodiscard]] bool find_step(double mu, double curvature);
  [[nodiscard]] Reach measure_step(double mu);
  void advance(double share);
  void advance_rooms(double share);
  [[nodiscard]] double merit(const State& state, double mu) const;
  [[nodiscard]] double take_step(double mu, const Reach& reach);
  void move_multipliers(double mu, double share);

  std::span<const JointVec> steps_;
  const Bounds& bounds_;
  State now_, trial_;
  ViaSpline step_, best_;
  double best_duration_ = std::numeric_limits<double>::infinity();
  std::vector<double> shares_;  // of each segment
  ViaNewton newton_;
  std::vector<Condensed> parts_;
  std::vector<RowPairs> room_steps_, multipliers_, multiplier_steps_;
};

/// Whether step `k` is tiny beside both its neighbours.
bool is_tiny(std::span<const JointVec> steps, std::size_t k) {
  return k > 0 && k + 1 < steps.size() &&
         steps[k].norm() < kTiny * std::min(steps[k - 1].norm(), steps[k + 1].norm());
}

/// Cell lengths in proportion to the times the limits would need for each step alone.
void Descent::time_alone() {
  for_all([&](int k, int j, std::size_t) {
    const SegmentTask t = task(k, j);
    const double way = std::abs(t.step);
    double& h = now_.motion.h[static_cast<std::size_t>(k)];
    h = std::max({h, way / t.v / kCells, std::sqrt(2 * way / t.a) / kCells,
                  std::cbrt(8 * way / t.j) / kCells});
  });
}

/// Shortens the cells of tiny steps to what they take at the mean speed of their neighbours.
void Descent::time_in_passing() {
  std::vector<double>& h = now_.motion.h;
  const std::vector<double> alone = h;
  for (std::size_t k = 0; k < h.size(); ++k) {
    if (!is_tiny(steps_, k)) continue;
    const double before = alone[k - 1] / steps_[k - 1].norm();
    const double after = alone[k + 1] / steps_[k + 1].norm();
    h[k] = 0.5 * steps_[k].norm() * (before + after);
  }
  double mean = 0;
  for (const double cell : h) mean += cell / static_cast<double>(h.size());
  for (std::size_t k = 0; k < h.size(); ++k) shares_[k] = std::min(1.0, h[k] / (kShort * mean));
}

/// The smoothest motion (least square jerk) at some cell lengths, slowed down to keep the limits.
bool Descent::guess(bool in_passing) {
  ViaSpline& motion = now_.motion;
  time_alone();
  if (in_passing) time_in_passing();
  bool sound = true;
  for_all([&](int k, int j, std::size_t id) {
    const double h = motion.h[static_cast<std::size_t>(k)];
    motion.inner[id].fill(task(k, j).step / h / kInner);
    const double weight = 1 / (h * h * h * bounds_.j[j] * bounds_.j[j]);
    const SegmentModel model = smoothness_model(coefs_of(motion, k, j), weight);
    sound = condense(task(k, j), motion.shared(k, j), model, parts_[id]) && sound;
  });
  if (!sound || !newton_.solve(parts_, 0, step_)) return false;
  advance(1);
  now_.motion = trial_.motion;
  if (!keep_best()) return false;
  trial_.motion = stretched(best_, 1 / kGuessUse);
  advance_rooms(0);
  std::swap(now_, trial_);
  return true;
}

/// Remembers the motion if none was shorter, each stretched to keep the limits.
/// @return whether it was clearly shorter.
bool Descent::keep_best() {
  double factor = 0;
  for_all([&](int k, int j, std::size_t) {
    const double h = now_.motion.h[static_cast<std::size_t>(k)];
    factor = std::max(factor, time_factor(task(k, j), coefs_of(now_.motion, k, j), h));
  });
  const double duration = factor * now_.motion.duration();
  if (!(duration < best_duration_)) return false;
  const bool clearly = duration < (1 - 0.1 * kLastBarrier) * best_duration_;
  best_duration_ = duration;
  best_ = stretched(now_.motion, factor);
  return clearly;
}

bool Descent::find_step(double mu, double curvature) {
  bool sound = true;
  for_all([&](int k, int j, std::size_t id) {
    const Shared y = now_.motion.shared(k, j);
    const SegmentModel model = barrier_model(task(k, j), y, mu * share_of(k), now_.rooms[id],
                                             now_.missed[id], multipliers_[id], curvature);
    sound = condense(task(k, j), y, model, parts_[id]) && sound;
  });
  return sound && newton_.solve(parts_, 1, step_);
}

Descent::Reach Descent::measure_step(double mu) {
  double shrink = 1, shrink_multipliers = 1, slope = step_.duration();
  for_all([&](int k, int j, std::size_t id) {
    const double weight = mu * share_of(k);
    const auto one = [&](double change, double s, double miss, double z, double& ds, double& dz) {
      ds = change + miss;
      const double relative = ds / s;
      dz = weight / s - z * (1 + relative);
      slope -= weight * relative + kPenalty * z * std::abs(miss);
      shrink = std::max(shrink, -relative / kToWall);
      shrink_multipliers = std::max(shrink_multipliers, -dz / (z * kToWall));
    };
    const Shared y = now_.motion.shared(k, j), dy = step_.shared(k, j);
    const double h = y.back(), dh = dy.back();
    const Rows dg = row_values(coefs_step(y, dy, step_.inner[id]));
    const Rows db = row_fill(0, bounds_.a[j] * dh, 2 * bounds_.j[j] * h * dh);
    const RowPairs &s = now_.rooms[id], &miss = now_.missed[id], &z = multipliers_[id];
    RowPairs &ds = room_steps_[id], &dz = multiplier_steps_[id];
    for (std::size_t r = 0; r < kRows; ++r) {
      one(db[r] - dg[r], s.up[r], miss.up[r], z.up[r], ds.up[r], dz.up[r]);
      one(db[r] + dg[r], s.down[r], miss.down[r], z.down[r], ds.down[r], dz.down[r]);
    }
  });
  return {1 / shrink, 1 / shrink_multipliers, slope};
}

/// The trial motion: `share` of the step, then all inner coefficients of a segment shifted alike to
/// cover the way exactly.
void Descent::advance(double share) {
  const ViaSpline& from = now_.motion;
  ViaSpline& to = trial_.motion;
  to.v = from.v + share * step_.v;
  to.a = from.a + share * step_.a;
  for (std::size_t k = 0; k < to.h.size(); ++k) {
    const double change = share * step_.h[k];
    // The way is speed times length, so that a step of both at once keeps it where the inverse
    // length changes in proportion; over very short cells an error would be a great jerk.
    to.h[k] = shares_[k] < 1 ? from.h[k] / (1 - change / from.h[k]) : from.h[k] + change;
  }
  for_all([&](int k, int j, std::size_t id) {
    double missing = inner_sum(task(k, j), to.shared(k, j));
    for (std::size_t i = 0; i < kInner; ++i) {
      to.inner[id][i] = from.inner[id][i] + share * step_.inner[id][i];
      missing -= to.inner[id][i];
    }
    for (double& c : to.inner[id]) c += missing / kInner;
  });
}

/// The rooms of the trial: `share` of their step on, or the rows' own where these are larger.
void Descent::advance_rooms(double share) {
  for_all([&](int k, int j, std::size_t id) {
    const double h = trial_.motion.h[static_cast<std::size_t>(k)];
    const Rows g = row_values(coefs_of(trial_.motion, k, j));
    const Rows b = row_fill(bounds_.v[j], bounds_.a[j] * h, bounds_.j[j] * h * h);
    const RowPairs &from = now_.rooms[id], &step = room_steps_[id];
    RowPairs &to = trial_.rooms[id], &missed = trial_.missed[id];
    for (std::size_t r = 0; r < kRows; ++r) {
      to.up[r] = std::max(from.up[r] + share * step.up[r], b[r] - g[r]);
      to.down[r] = std::max(from.down[r] + share * step.down[r], b[r] + g[r]);
      missed.up[r] = b[r] - g[r] - to.up[r];
      missed.down[r] = b[r] + g[r] - to.down[r];
    }
  });
}

/// The rooms missed count with their price, the multipliers.
double Descent::merit(const State& state, double mu) const {
  double logs = 0, missed = 0;
  for_all([&](int k, int, std::size_t id) {
    const RowPairs &s = state.rooms[id], &miss = state.missed[id], &z = multipliers_[id];
    for (std::size_t r = 0; r < kRows; ++r) {
      logs += share_of(k) * std::log(s.up[r] * s.down[r]);
      missed -= z.up[r] * miss.up[r] + z.down[r] * miss.down[r];
    }
  });
  return state.motion.duration() - mu * logs + kPenalty * missed;
}

/// @return the share of the step taken, 0 for none.
double Descent::take_step(double mu, const Reach& reach) {
  const double before = merit(now_, mu);
  double share = reach.step;
  for (int i = 0; i < kHalvings; ++i, share *= 0.5) {
    advance(share);
    const std::vector<double>& h = trial_.motion.h;
    if (!std::all_of(h.begin(), h.end(), [](double cell) { return cell > 0; })) continue;
    advance_rooms(share);
    if (!(merit(trial_, mu) <= before + kDescent * share * reach.slope)) continue;
    std::swap(now_, trial_);
    return share;
  }
  return 0;
}

void Descent::move_multipliers(double mu, double share) {
  for_all([&](int k, int, std::size_t id) {
    const double weight = mu * share_of(k);
    const auto move = [&](double& z, double change, double room) {
      z = std::clamp(z + share * change, weight / room / kBand, weight / room * kBand);
    };
    const RowPairs &s = now_.rooms[id], &dz = multiplier_steps_[id];
    for (std::size_t r = 0; r < kRows; ++r) {
      move(multipliers_[id].up[r], dz.up[r], s.up[r]);
      move(multipliers_[id].down[r], dz.down[r], s.down[r]);
    }
  });
}

void Descent::improve(int iterations) {
  const double start = now_.motion.duration();
  const double share_of_row = start / (2.0 * kRows * static_cast<double>(parts_.size()));
  const double last = kLastBarrier * share_of_row;
  double mu = kFirstBarrier * share_of_row;
  for_all([&](int k, int, std::size_t id) {
    const double weight = mu * share_of(k);
    for (std::size_t r = 0; r < kRows; ++r) {
      multipliers_[id].up[r] = weight / now_.rooms[id].up[r];
      multipliers_[id].down[r] = weight / now_.rooms[id].down[r];
    }
  });
  int patience = kPatience;
  for (int i = 0; i < iterations && patience > 0; ++i) {
    // Without the curvature of the limits where that makes the system indefinite.
    if (!find_step(mu, 1) && !find_step(mu, 0)) return;
    const Reach reach = measure_step(mu);
    const double share = take_step(mu, reach);
    if (share > 0) move_multipliers(mu, reach.multipliers);
    const bool better = share > 0 && keep_best();
    if (mu <= last) {
      const double now = now_.motion.duration();
      const bool within = best_duration_ < (1 + kLastBarrier) * now;
      if (share == 0 || (within && -reach.slope < 0.1 * kLastBarrier * now)) return;
      patience = better ? kPatience : patience - 1;
    }
    if (share == 0 || share > kGoodStep) mu = std::max(last, kShrink * mu);
  }
}

}  // namespace

Coefs coefs_of(const ViaSpline& motion, int k, int j) {
  return coefs_of(motion.shared(k, j), motion.inner[motion.index(k, j)]);
}

std::optional<ViaSpline> fastest_via(std::span<const JointVec> steps, const Bounds& bounds,
                                     int iterations) {
  Descent alone(steps, bounds);
  if (!alone.guess(false)) return std::nullopt;
  bool any_tiny = false;
  for (std::size_t k = 0; k < steps.size(); ++k) any_tiny = any_tiny || is_tiny(steps, k);
  if (any_tiny) {
    // From rests at tiny steps the descent would hardly get away.
    Descent passing(steps, bounds);
    if (passing.guess(true)) passing.improve(iterations);
    if (passing.duration() < kWorth * alone.duration()) return passing.best();
  }
  alone.improve(iterations);
  return alone.best();
}

}  // namespace mjarm::detail
