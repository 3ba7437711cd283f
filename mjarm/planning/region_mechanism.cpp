// Where the mechanism that a region hangs on stands, for a pose of the tool.
//
// Seen from a door that is turned by a, whatever bounds the tool is a wave in a: the place of F
// along an axis of R, and what an axis of F has along one of R, are each mean + c cos(a) + s
// sin(a). So each bound forbids an arc of the circle of all a; the gaps between these arcs are all
// values for which the pose is within the bounds, without a search. In the middle of a gap there is
// room to both sides, and it moves smoothly with the tool.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include "mjarm/planning/task_region.hpp"

namespace mjarm {
namespace {

constexpr double kCircle = 2 * std::numbers::pi;
constexpr double kFirstSlack = 1e-9;  // [m] and [rad] by which bounds are wider at first,
constexpr double kMoreSlack = 8;      // times so much where the pose is not within them,
constexpr int kSlacks = 12;           // so many times at most
constexpr double kAcross = 1e-12;     // of a unit vector along an axis that is across it
constexpr double kAlike = 1e-9;       // [rad] gaps have the same room
constexpr int kMaxArcs = 13;  // 6 of the place, 2 each of roll, pitch and yaw, 1 of the lean

/// What a number does as a hinge turns by a: mean + cosine cos(a) + sine sin(a).
struct Wave {
  double mean, cosine, sine;

  friend Wave operator+(const Wave& a, const Wave& b) {
    return {a.mean + b.mean, a.cosine + b.cosine, a.sine + b.sine};
  }
  friend Wave operator*(double k, const Wave& a) { return {k * a.mean, k * a.cosine, k * a.sine}; }
  friend Wave operator+(const Wave& a, double mean) { return {a.mean + mean, a.cosine, a.sine}; }
};

/// Along axis `row` of R, which turns about `axis`, of a vector that does not.
Wave seen_along(int row, const Eigen::Vector3d& axis, const Eigen::Vector3d& v) {
  const double mean = axis[row] * axis.dot(v);
  return {mean, v[row] - mean, -axis.cross(v)[row]};
}

/// From an angle on, over a width up to a whole turn.
struct Arc {
  double from, width;
};

double on_circle(double angle) {
  const double out = std::fmod(angle, kCircle);
  return out < 0 ? out + kCircle : out;
}

/// Where a wave is below 0; width 0: nowhere.
Arc arc_below(const Wave& wave) {
  const double height = std::hypot(wave.cosine, wave.sine);
  if (wave.mean >= height) return {0, 0};
  if (wave.mean <= -height) return {0, kCircle};
  const double half = std::acos(-wave.mean / height);  // where it is not, round its crest
  return {on_circle(std::atan2(wave.sine, wave.cosine) + half), kCircle - 2 * half};
}

/// What bounds forbid of a circle.
class Forbidden {
 public:
  /// Where the wave is below 0.
  void below(const Wave& wave) { add(arc_below(wave)); }
  /// Where both are.
  void below_both(const Wave& a, const Wave& b) {
    const Arc one = arc_below(a), other = arc_below(b);
    const double start = on_circle(other.from - one.from), end = start + other.width;
    add({one.from + start, std::min(one.width, end) - start});
    add({one.from, std::min(one.width, end - kCircle)});
  }

  /// The middle of the gap that has most to both sides of the value of the range that is nearest to
  /// it, as that value; none where no gap reaches the range. Of gaps alike (two bounds on one wave
  /// leave such) the one nearer to the middle of the range, not that which rounding prefers.
  std::optional<double> value(double min, double max) {
    const double middle = 0.5 * (min + max);
    std::optional<double> best;
    double most = 0;
    const auto offer = [&](double from, double to) {
      const double wanted = middle + std::remainder(0.5 * (from + to) - middle, kCircle);
      const double there = std::clamp(wanted, min, max);
      const double room = 0.5 * (to - from) - std::abs(there - wanted);
      if (room < 0 || (best && room < most - kAlike)) return;
      const bool alike = best && room <= most + kAlike;
      if (alike && std::abs(there - middle) >= std::abs(*best - middle)) return;
      best = there;
      most = room;
    };
    if (count_ == 0) offer(middle - 0.5 * kCircle, middle + 0.5 * kCircle);
    const std::span<Arc> arcs(arcs_.data(), count_);
    std::ranges::sort(arcs, {}, &Arc::from);
    double done = -kCircle;  // up to here all is forbidden, beginning a turn before
    for (const Arc& arc : arcs) done = std::max(done, arc.from + arc.width - kCircle);
    for (const Arc& arc : arcs) {
      if (arc.from > done) offer(done, arc.from);
      done = std::max(done, arc.from + arc.width);
    }
    return best;
  }

 private:
  void add(const Arc& arc) {
    if (arc.width > 0) arcs_[count_++] = {on_circle(arc.from), arc.width};
  }

  std::array<Arc, kMaxArcs> arcs_{};
  std::size_t count_ = 0;
};

/// What a region bounds, as its hinge turns.
class HingeView {
 public:
  HingeView(const TaskRegion& region, const Pose& X_WT) : region_(region) {
    const Mechanism& hinge = *region.mechanism;
    const Pose X_RW = region.X_WR.inverse(), X_RF = X_RW * X_WT * region.X_FT.inverse();
    const Eigen::Vector3d axis = X_RW.R * hinge.axis_W, p = X_RW * hinge.p_W;
    for (int row = 0; row < 3; ++row) {
      const auto i = static_cast<std::size_t>(row);
      place_[i] = seen_along(row, axis, X_RF.p - p) + p[row];
      x_[i] = seen_along(row, axis, X_RF.R.col(0));
      last_[i] = seen_along(2, axis, X_RF.R.col(row));
    }
  }

  /// Where the pose is not within the bounds, each of them wider by `slack` [m] or [rad].
  [[nodiscard]] Forbidden forbidden(double slack) const {
    Forbidden out;
    for (int k = 0; k < 3; ++k) {
      const Wave& place = place_[static_cast<std::size_t>(k)];
      const double min = region_.place_min[k] - slack, max = region_.place_max[k] + slack;
      if (min > -kFreePlace) out.below(place + -min);
      if (max < kFreePlace) out.below(-1 * place + max);
    }
    // Roll, pitch and yaw stand in the last row and the first column of R_RF.
    forbid_turns(wider(0, slack), last_[2], last_[1], out);
    forbid_turns(wider(2, slack), x_[0], x_[1], out);
    const TurnBounds pitch = wider(1, slack);
    if (pitch.min > -kFreePitch) out.below(-1 * x_[2] + -std::sin(pitch.min));
    if (pitch.max < kFreePitch) out.below(x_[2] + std::sin(pitch.max));
    const double lean = region_.lean + slack;
    if (lean < std::numbers::pi) out.below(last_[2] + -std::cos(lean));
    return out;
  }

 private:
  [[nodiscard]] TurnBounds wider(int axis, double slack) const {
    const TurnBounds bounds = turn_bounds(region_, axis);
    return {bounds.min - slack, bounds.max + slack};
  }

  /// An angle of which cosine and sine are given, times something that is not negative.
  static void forbid_turns(const TurnBounds& bounds, const Wave& cosine, const Wave& sine,
                           Forbidden& out) {
    if (!(bounds.max - bounds.min < kCircle)) return;
    const Wave above = -std::sin(bounds.min) * cosine + std::cos(bounds.min) * sine;
    const Wave below = std::sin(bounds.max) * cosine + -std::cos(bounds.max) * sine;
    if (bounds.max - bounds.min > 0.5 * kCircle) {
      out.below_both(above, below);
    } else {
      out.below(above);
      out.below(below);
    }
  }

  const TaskRegion& region_;
  std::array<Wave, 3> place_{}, x_{}, last_{};  // x_: of x of F; last_: along z of R
};

double hinge_value(const TaskRegion& region, const Pose& X_WT) {
  const double min = region.mechanism->min, max = region.mechanism->max;
  const HingeView view(region, X_WT);
  double slack = kFirstSlack;
  for (int k = 0; k < kSlacks; ++k, slack *= kMoreSlack) {
    if (const auto value = view.forbidden(slack).value(min, max)) return *value;
  }
  return 0.5 * (min + max);
}

/// As a slide shifts, all that changes is the place, along a line: each bound ends the values, at
/// one that moves evenly with the slack. Of a pose outside the slack is the least that leaves any.
double slide_value(const TaskRegion& region, const Pose& X_WT) {
  const Mechanism& slide = *region.mechanism;
  const Pose X_RW = region.X_WR.inverse();
  const Eigen::Vector3d axis = X_RW.R * slide.axis_W, p = (X_RW * X_WT * region.X_FT.inverse()).p;
  Eigen::Array3d low = Eigen::Array3d::Constant(-kFreePlace), high = -low, by_slack{0, 0, 0};
  for (int k = 0; k < 3; ++k) {
    if (std::abs(axis[k]) < kAcross) continue;
    const double a = (p[k] - region.place_max[k]) / axis[k],
                 b = (p[k] - region.place_min[k]) / axis[k];
    low[k] = std::min(a, b);
    high[k] = std::max(a, b);
    by_slack[k] = 1 / std::abs(axis[k]);
  }
  double slack = kFirstSlack;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      if (low[i] <= high[k]) continue;
      slack = std::max(slack, (low[i] - high[k]) / (by_slack[i] + by_slack[k]));
    }
  }
  double least = (low - slack * by_slack).maxCoeff(), most = (high + slack * by_slack).minCoeff();
  if (!std::isfinite(least)) least = std::min(slide.min, most);
  if (!std::isfinite(most)) most = std::max(slide.max, least);
  return std::clamp(0.5 * (least + most), slide.min, slide.max);
}

}  // namespace

double value_for(const TaskRegion& region, const Pose& X_WT) noexcept {
  if (!region.mechanism) return 0;
  return region.mechanism->type == JointType::hinge ? hinge_value(region, X_WT)
                                                    : slide_value(region, X_WT);
}

}  // namespace mjarm
