#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "mjarm/trajectory/via_points_solver_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr double kGuessUse = 0.95;     // share of the limits the first guess takes
constexpr double kFirstBarrier = 0.3;  // weight of the whole barrier, as a share of the duration
constexpr double kLastBarrier = 1e-3;  // the same at the end: about the duration left to gain
constexpr double kShrink = 0.5;        // of the barrier's weight after a good step
constexpr double kToWall = 0.99;       // share of the way to the nearest limit that a step may take
constexpr double kDescent = 1e-4;      // share of the promised descent that a step must bring
constexpr int kHalvings = 12;          // of one step
constexpr double kBand = 1e4;          // multipliers stay within this factor of the central path

/// Minimises duration - mu * sum of log(room) with mu going down, from one feasible motion to the
/// next. J. Nocedal and S. Wright, Numerical Optimization, 2nd ed., chapter 19.
class Descent {
 public:
  Descent(std::span<const JointVec> steps, const Bounds& bounds)
      : steps_(steps),
        bounds_(bounds),
        motion_(static_cast<int>(steps[0].size()), static_cast<int>(steps.size())),
        trial_(motion_),
        step_(motion_),
        newton_(motion_.joints(), motion_.segments()),
        parts_(motion_.inner.size()),
        rooms_(parts_.size()),
        trial_rooms_(rooms_),
        multipliers_(rooms_),
        multiplier_steps_(rooms_) {}

  [[nodiscard]] bool guess();
  void improve(int iterations);
  void scale_to_limits(double use);
  [[nodiscard]] const ViaSpline& motion() const { return motion_; }

 private:
  /// What the first-order step does to the rooms and the multipliers.
  struct Reach {
    double step, multipliers;  ///< share of the step that keeps all positive, <= 1
    double slope;              ///< derivative of the merit along the step
  };

  [[nodiscard]] SegmentTask task(int k, int j) const {
    return {steps_[static_cast<std::size_t>(k)][j], bounds_.v[j], bounds_.a[j], bounds_.j[j]};
  }
  template <class Call>
  void for_all(const Call& call) const {
    for (int k = 0; k < motion_.segments(); ++k) {
      for (int j = 0; j < motion_.joints(); ++j) call(k, j, motion_.index(k, j));
    }
  }
  [[nodiscard]] double worst_use() const;
  [[nodiscard]] bool find_step(double mu);
  [[nodiscard]] bool find_step(double mu, double curvature);
  [[nodiscard]] Reach measure_step(double mu);
  void advance(double share);
  [[nodiscard]] bool fill_rooms(const ViaSpline& motion, std::vector<RowPairs>& rooms) const;
  [[nodiscard]] double merit(const ViaSpline& motion, const std::vector<RowPairs>& rooms,
                             double mu) const;
  [[nodiscard]] double take_step(double mu, const Reach& reach);
  void move_multipliers(double mu, double share);

  std::span<const JointVec> steps_;
  const Bounds& bounds_;
  ViaSpline motion_, trial_, step_;
  ViaNewton newton_;
  std::vector<Condensed> parts_;
  std::vector<RowPairs> rooms_, trial_rooms_, multipliers_, multiplier_steps_;
};

/// The least factor on time that keeps all limits: velocities go with 1 / k, accelerations with
/// 1 / k^2, jerks with 1 / k^3.
double Descent::worst_use() const {
  double v = 0, a = 0, j = 0;
  for_all([&](int k, int joint, std::size_t) {
    const Rows g = row_values(coefs_of(motion_, k, joint));
    const double h = motion_.h[static_cast<std::size_t>(k)];
    const Rows per = row_fill(1 / bounds_.v[joint], 0, 0);
    const Rows per_a = row_fill(0, 1 / (bounds_.a[joint] * h), 0);
    const Rows per_j = row_fill(0, 0, 1 / (bounds_.j[joint] * h * h));
    for (std::size_t r = 0; r < g.size(); ++r) {
      v = std::max(v, std::abs(g[r]) * per[r]);
      a = std::max(a, std::abs(g[r]) * per_a[r]);
      j = std::max(j, std::abs(g[r]) * per_j[r]);
    }
  });
  return std::max({v, std::sqrt(a), std::cbrt(j)});
}

void Descent::scale_to_limits(double use) {
  const double slower = worst_use() / use;
  for (double& h : motion_.h) h *= slower;
  motion_.v /= slower;
  motion_.a /= slower * slower;
  for (Inner& inner : motion_.inner) {
    for (double& c : inner) c /= slower;
  }
}

/// The smoothest motion (least square jerk) at times in proportion to those the limits would need
/// for each step alone, slowed down to keep the limits.
bool Descent::guess() {
  for_all([&](int k, int j, std::size_t) {
    const SegmentTask t = task(k, j);
    const double way = std::abs(t.step);
    double& h = motion_.h[static_cast<std::size_t>(k)];
    h = std::max({h, way / t.v / kCells, std::sqrt(2 * way / t.a) / kCells,
                  std::cbrt(8 * way / t.j) / kCells});
  });
  bool sound = true;
  for_all([&](int k, int j, std::size_t id) {
    const double h = motion_.h[static_cast<std::size_t>(k)];
    motion_.inner[id].fill(task(k, j).step / h / kInner);
    const double weight = 1 / (h * h * h * bounds_.j[j] * bounds_.j[j]);
    const SegmentModel model = smoothness_model(coefs_of(motion_, k, j), weight);
    sound = condense(task(k, j), motion_.shared(k, j), model, parts_[id]) && sound;
  });
  if (!sound || !newton_.solve(parts_, 0, step_)) return false;
  advance(1);
  std::swap(motion_, trial_);
  scale_to_limits(kGuessUse);
  return fill_rooms(motion_, rooms_);
}

bool Descent::find_step(double mu, double curvature) {
  bool sound = true;
  for_all([&](int k, int j, std::size_t id) {
    const Shared y = motion_.shared(k, j);
    const SegmentModel model =
        barrier_model(task(k, j), y, mu, rooms_[id], multipliers_[id], curvature);
    sound = condense(task(k, j), y, model, parts_[id]) && sound;
  });
  return sound && newton_.solve(parts_, 1, step_);
}

bool Descent::find_step(double mu) { return find_step(mu, 1) || find_step(mu, 0); }

Descent::Reach Descent::measure_step(double mu) {
  double shrink = 1, shrink_multipliers = 1, slope = step_.duration();
  for_all([&](int k, int j, std::size_t id) {
    const auto segment = static_cast<std::size_t>(k);
    const double h = motion_.h[segment], dh = step_.h[segment];
    const Rows dg =
        row_values(coefs_step(motion_.shared(k, j), step_.shared(k, j), step_.inner[id]));
    const Rows db = row_fill(0, bounds_.a[j] * dh, 2 * bounds_.j[j] * h * dh);
    const RowPairs &room = rooms_[id], &z = multipliers_[id];
    const auto one = [&](double change, double s, double m) {
      const double relative = change / s;
      slope -= mu * relative;
      const double dm = mu / s - m * (1 + relative);
      shrink = std::max(shrink, -relative / kToWall);
      shrink_multipliers = std::max(shrink_multipliers, -dm / (m * kToWall));
      return dm;
    };
    for (std::size_t r = 0; r < dg.size(); ++r) {
      multiplier_steps_[id].up[r] = one(db[r] - dg[r], room.up[r], z.up[r]);
      multiplier_steps_[id].down[r] = one(db[r] + dg[r], room.down[r], z.down[r]);
    }
  });
  return {1 / shrink, 1 / shrink_multipliers, slope};
}

/// The trial motion: `share` of the step, then all inner coefficients of a segment shifted alike to
/// cover the way exactly.
void Descent::advance(double share) {
  trial_.v = motion_.v + share * step_.v;
  trial_.a = motion_.a + share * step_.a;
  for (std::size_t k = 0; k < trial_.h.size(); ++k) {
    trial_.h[k] = motion_.h[k] + share * step_.h[k];
  }
  for_all([&](int k, int j, std::size_t id) {
    double missing = inner_sum(task(k, j), trial_.shared(k, j));
    for (std::size_t i = 0; i < kInner; ++i) {
      trial_.inner[id][i] = motion_.inner[id][i] + share * step_.inner[id][i];
      missing -= trial_.inner[id][i];
    }
    for (double& c : trial_.inner[id]) c += missing / kInner;
  });
}

/// @return whether all rooms are positive.
bool Descent::fill_rooms(const ViaSpline& motion, std::vector<RowPairs>& rooms) const {
  bool inside = std::all_of(motion.h.begin(), motion.h.end(), [](double h) { return h > 0; });
  for_all([&](int k, int j, std::size_t id) {
    const double h = motion.h[static_cast<std::size_t>(k)];
    const Rows g = row_values(coefs_of(motion, k, j));
    const Rows b = row_fill(bounds_.v[j], bounds_.a[j] * h, bounds_.j[j] * h * h);
    for (std::size_t r = 0; r < g.size(); ++r) {
      rooms[id].up[r] = b[r] - g[r];
      rooms[id].down[r] = b[r] + g[r];
      inside = inside && rooms[id].up[r] > 0 && rooms[id].down[r] > 0;
    }
  });
  return inside;
}

double Descent::merit(const ViaSpline& motion, const std::vector<RowPairs>& rooms,
                      double mu) const {
  double logs = 0;
  for (const RowPairs& room : rooms) {
    for (std::size_t r = 0; r < room.up.size(); ++r) logs += std::log(room.up[r] * room.down[r]);
  }
  return motion.duration() - mu * logs;
}

/// @return the share of the step taken, 0 for none.
double Descent::take_step(double mu, const Reach& reach) {
  const double before = merit(motion_, rooms_, mu);
  double share = reach.step;
  for (int i = 0; i < kHalvings; ++i, share *= 0.5) {
    advance(share);
    if (!fill_rooms(trial_, trial_rooms_)) continue;
    if (merit(trial_, trial_rooms_, mu) > before + kDescent * share * reach.slope) continue;
    std::swap(motion_, trial_);
    rooms_.swap(trial_rooms_);
    return share;
  }
  return 0;
}

void Descent::move_multipliers(double mu, double share) {
  const auto move = [&](double& z, double change, double room) {
    z = std::clamp(z + share * change, mu / room / kBand, mu / room * kBand);
  };
  for (std::size_t id = 0; id < multipliers_.size(); ++id) {
    for (std::size_t r = 0; r < kRows; ++r) {
      move(multipliers_[id].up[r], multiplier_steps_[id].up[r], rooms_[id].up[r]);
      move(multipliers_[id].down[r], multiplier_steps_[id].down[r], rooms_[id].down[r]);
    }
  }
}

void Descent::improve(int iterations) {
  const double rows = 2.0 * kRows * static_cast<double>(rooms_.size());
  const double last = kLastBarrier * motion_.duration() / rows;
  double mu = kFirstBarrier * motion_.duration() / rows;
  for (std::size_t id = 0; id < rooms_.size(); ++id) {
    for (std::size_t r = 0; r < kRows; ++r) {
      multipliers_[id].up[r] = mu / rooms_[id].up[r];
      multipliers_[id].down[r] = mu / rooms_[id].down[r];
    }
  }
  for (int i = 0; i < iterations; ++i) {
    if (!find_step(mu)) return;
    const Reach reach = measure_step(mu);
    const double share = take_step(mu, reach);
    if (share > 0) move_multipliers(mu, reach.multipliers);
    if (mu <= last && (share == 0 || -reach.slope < 0.1 * kLastBarrier * motion_.duration()))
      return;
    if (share == 0 || share > 0.3) mu = std::max(last, kShrink * mu);
  }
}

}  // namespace

Coefs coefs_of(const ViaSpline& motion, int k, int j) {
  return coefs_of(motion.shared(k, j), motion.inner[motion.index(k, j)]);
}

std::optional<ViaSpline> fastest_via(std::span<const JointVec> steps, const Bounds& bounds,
                                     int iterations) {
  Descent descent(steps, bounds);
  if (!descent.guess()) return std::nullopt;
  descent.improve(iterations);
  descent.scale_to_limits(1);
  return descent.motion();
}

}  // namespace mjarm::detail
