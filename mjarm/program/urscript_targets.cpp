#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "mjarm/core/rotation.hpp"
#include "mjarm/program/urscript_targets_internal.hpp"

namespace mjarm::program::detail {
namespace {

constexpr double kOnTheSpot = 1e-9;  // [m] shorter legs are turns
constexpr double kPlainAccel = 1;    // [m/s^2] what the plan asks for, where the ramps tell nothing
constexpr double kShareOfLeg = 0.45;  // of the shorter neighbour, as blend at points of a curve

class TargetMaker {
 public:
  TargetMaker(const PlannedMove& move, const Arm& arm, const UrscriptOptions& options)
      : move_(move), curve_(*move.curve), options_(options), clock_(arm, move.trajectory, curve_) {}

  std::vector<UrTarget> make() {
    const bool round = move_.word == "circle" || (move_.word == "movec" && move_.instructions == 1);
    if (round) {
      if (!arcs(move_.word == "circle" ? 2 : 1)) points();
    } else if (move_.points.size() > 1) {
      straight();
    } else {
      points();
    }
    return std::move(out_);
  }

 private:
  /// A straight leg between two of the given poses.
  struct Leg {
    Pose from, to;
    double way = 0;               ///< [m] between the two
    double s_from = 0, s_to = 0;  ///< where the curve is nearest to them
    double r_from = 0, r_to = 0;  ///< [m] blends
    FilePlace place = {};
    [[nodiscard]] bool turn() const { return way < kOnTheSpot; }
  };

  [[nodiscard]] bool dips(double s_from, double s_to) const {
    return std::ranges::any_of(
        move_.dips, [&](const SpeedDip& dip) { return dip.s_from < s_to && dip.s_to > s_from; });
  }

  /// The speed of a statement: the plan's greatest, or its mean where the tool slows down.
  [[nodiscard]] double speed(double s_from, double s_to) const {
    const double seconds = clock_.time_at(s_to) - clock_.time_at(s_from);
    return dips(s_from, s_to) ? (s_to - s_from) / seconds : clock_.peak(s_from, s_to);
  }

  /// Parameter of the curve's point nearest to `p` between two parameters, where the distance
  /// falls and rises again.
  [[nodiscard]] double nearest(const Eigen::Vector3d& p, double low, double high) const {
    constexpr int kHalvings = 60;
    for (int i = 0; i < kHalvings; ++i) {
      const double third = (high - low) / 3;
      const bool left =
          (curve_.at(low + third).p - p).norm() < (curve_.at(high - third).p - p).norm();
      (left ? high : low) = left ? high - third : low + third;
    }
    return (low + high) / 2;
  }

  [[nodiscard]] std::vector<Leg> legs() const {
    std::vector<double> radii(move_.points.size(), 0);
    for (const CurveBlend& blend : curve_.blends()) radii[blend.point] = blend.radius;
    std::vector<Leg> out;
    double s = 0;
    for (std::size_t k = 0; k + 1 < move_.points.size(); ++k) {
      Leg leg{move_.points[k].X_WT, move_.points[k + 1].X_WT};
      leg.way = (leg.to.p - leg.from.p).norm();
      leg.r_from = radii[k];
      leg.r_to = radii[k + 1];
      leg.place = move_.points[k + 1].place;
      leg.s_from = s;
      const double whole = leg.turn() ? angle_between(leg.from.R, leg.to.R) : leg.way;
      const double blends = leg.r_from + leg.r_to;
      s = blends > 0 ? nearest(leg.to.p, s + whole - blends, s + whole) : s + whole;
      leg.s_to = s;
      out.push_back(leg);
    }
    return out;
  }

  void straight() {
    const std::vector<Leg> all = legs();
    for (std::size_t i = 0; i < all.size();) {
      std::size_t end = i + 1;
      while (end < all.size() && all[end].r_from > 0) ++end;
      group({all.begin() + static_cast<std::ptrdiff_t>(i),
             all.begin() + static_cast<std::ptrdiff_t>(end)});
      i = end;
    }
  }

  /// Legs between two rests.
  void group(std::span<const Leg> legs) {
    const double s_from = legs.front().s_from, s_to = legs.back().s_to;
    const double seconds = clock_.time_at(s_to) - clock_.time_at(s_from);
    if (legs.front().turn()) {
      UrTarget target{UrTarget::Word::turn, legs.front().to};
      target.time = seconds;
      target.place = legs.front().place;
      out_.push_back(target);
      return;
    }
    const std::size_t first = out_.size();
    for (const Leg& leg : legs) {
      const double s_last = dips(leg.s_from, leg.s_to) ? cut(leg) : leg.s_from;
      add_line(leg.to, speed(s_last, leg.s_to), leg.r_to, leg.place);
    }
    const bool uncut = out_.size() - first == legs.size();
    if (legs.size() == 1 && uncut) {
      const double way = s_to - s_from, speed = out_[first].speed;
      // One that goes on from a planned way lacks the ramp that it begins with here.
      const bool moving = s_from == 0 && clock_.speed_at_start() > 0;
      const double ramp = moving ? std::max(seconds - way / speed, 0.0) : 0;
      pace(first, trapezoid(way, seconds + ramp, speed));
      return;
    }
    double accel = kPlainAccel;
    if (uncut) {
      double at_speed = 0;
      for (std::size_t k = 0; k < legs.size(); ++k) {
        at_speed += (legs[k].s_to - legs[k].s_from) / out_[first + k].speed;
      }
      const double ramps = (out_[first].speed + out_.back().speed) / 2;
      accel = std::min(kPlainAccel, ramps / std::max(seconds - at_speed, 1e-3));
    }
    for (std::size_t k = first; k < out_.size(); ++k) out_[k].accel = accel;
  }

  void add_line(const Pose& X_WT, double speed, double radius, FilePlace place) {
    UrTarget target{UrTarget::Word::line, X_WT};
    target.speed = speed;
    target.radius = radius;
    target.place = place;
    out_.push_back(target);
  }

  /// Points on a leg on which the tool is not equally fast, with the speed that it has up to each.
  /// @return the parameter of the last one.
  double cut(const Leg& leg) {
    constexpr double kShortest = 0.02;  // [m]
    constexpr double kMax = 50;
    const double between = leg.way - leg.r_from - leg.r_to;
    const auto n = static_cast<int>(std::clamp(std::floor(between / kShortest), 1.0, kMax));
    const auto s_at = [&](double x) { return leg.s_from + (leg.s_to - leg.s_from) * x / leg.way; };
    double x_before = 0;
    for (int i = 1; i < n; ++i) {
      const double x = leg.r_from + between * i / n;
      // Where no dip is near, the leg goes on undivided.
      if (!dips(s_at(x - between / n), s_at(x + between / n))) continue;
      add_line(interpolate(leg.from, leg.to, x / leg.way), speed(s_at(x_before), s_at(x)),
               kShareOfLeg * between / n, leg.place);
      x_before = x;
    }
    return s_at(x_before);
  }

  void pace(std::size_t first, const Trapezoid& pace) {
    for (std::size_t k = first; k < out_.size(); ++k) {
      out_[k].speed = pace.speed;
      out_[k].accel = pace.accel;
    }
  }

  /// Whether a controller that turns the tool evenly from `s_from` to `s_to` follows the curve.
  [[nodiscard]] bool turns_evenly(double s_from, double s_to) const {
    constexpr int kPlaces = 16;
    const Pose first = curve_.at(s_from), last = curve_.at(s_to);
    for (int i = 1; i < kPlaces; ++i) {
      const double x = static_cast<double>(i) / kPlaces;
      const Eigen::Matrix3d R = interpolate(first, last, x).R;
      if (angle_between(R, curve_.at(s_from + (s_to - s_from) * x).R) > options_.rot_tol) {
        return false;
      }
    }
    return true;
  }

  /// The curve, which is round, as `count` arcs of a circle; false where it cannot be said so.
  bool arcs(int count) {
    const double end = curve_.end();
    if (!move_.dips.empty()) return false;
    for (int i = 0; i < count; ++i) {
      if (!turns_evenly(end * i / count, end * (i + 1) / count)) return false;
    }
    // Arcs of one circle go on into each other; a blend of this size stays within the tolerance.
    const double r = end / (2 * std::numbers::pi);
    const double blend = std::min(r / 4, std::sqrt(4 * r * options_.pos_tol));
    for (int i = 0; i < count; ++i) {
      UrTarget target{UrTarget::Word::arc, curve_.at(end * (i + 1) / count)};
      target.X_via = curve_.at(end * (2 * i + 1) / (2 * count));
      if (count == 1) target.X_via = move_.points[1].X_WT;
      target.radius = i + 1 < count ? blend : 0;
      target.place = move_.place;
      out_.push_back(target);
    }
    pace(0, trapezoid(end, move_.trajectory.duration(), clock_.peak(0, end)));
    return true;
  }

  /// True where the straight way between two places stays within the tolerances.
  [[nodiscard]] bool near(double s_from, double s_to) const {
    constexpr int kPlaces = 8;
    constexpr double kSpare = 0.9;  // what the places between may add
    const Pose a = curve_.at(s_from), b = curve_.at(s_to);
    const Eigen::Vector3d chord = b.p - a.p;
    for (int i = 1; i < kPlaces; ++i) {
      const double x = static_cast<double>(i) / kPlaces;
      const Pose X = curve_.at(s_from + (s_to - s_from) * x);
      const double along = std::clamp(chord.dot(X.p - a.p) / chord.squaredNorm(), 0.0, 1.0);
      if ((X.p - a.p - along * chord).norm() > kSpare * options_.pos_tol) return false;
      if (angle_between(X.R, interpolate(a, b, x).R) > kSpare * options_.rot_tol) return false;
    }
    return true;
  }

  void divide(double s_from, double s_to, std::vector<double>& out) const {
    const double middle = (s_from + s_to) / 2;
    if (near(s_from, s_to) || !(s_from < middle && middle < s_to)) {
      out.push_back(s_to);
      return;
    }
    divide(s_from, middle, out);
    divide(middle, s_to, out);
  }

  /// Points of the curve: at least eight between corners, so that a lap is not one chord.
  void points() {
    constexpr int kFewest = 8;
    const std::vector<double>& corners = curve_.corners();
    for (std::size_t c = 0; c + 1 < corners.size(); ++c) {
      std::vector<double> s{corners[c]};
      const double span = corners[c + 1] - corners[c];
      for (int i = 0; i < kFewest; ++i) {
        divide(corners[c] + span * i / kFewest, corners[c] + span * (i + 1) / kFewest, s);
      }
      add_points(s);
    }
  }

  void add_points(const std::vector<double>& s) {
    const std::size_t first = out_.size();
    const std::vector<Pose> X = curve_.poses(s);
    for (std::size_t k = 1; k < s.size(); ++k) {
      UrTarget target{UrTarget::Word::process, X[k]};
      const double before = (X[k].p - X[k - 1].p).norm();
      if (k + 1 < s.size()) {
        target.radius = kShareOfLeg * std::min(before, (X[k + 1].p - X[k].p).norm());
      }
      target.speed = speed(s[k - 1], s[k]);
      target.accel = kPlainAccel;
      target.place = move_.place;
      out_.push_back(target);
    }
    if (dips(s.front(), s.back())) return;
    const double seconds = clock_.time_at(s.back()) - clock_.time_at(s.front());
    pace(first, trapezoid(s.back() - s.front(), seconds, clock_.peak(s.front(), s.back())));
  }

  const PlannedMove& move_;
  const Curve& curve_;
  const UrscriptOptions& options_;
  ToolClock clock_;
  std::vector<UrTarget> out_;
};

}  // namespace

std::vector<UrTarget> ur_targets(const PlannedMove& move, const Arm& arm,
                                 const UrscriptOptions& options) {
  return TargetMaker(move, arm, options).make();
}

}  // namespace mjarm::program::detail
