#include "mjarm/execution/path_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "mjarm/core/rng.hpp"
#include "mjarm/path/joint_polyline.hpp"
#include "mjarm/trajectory/at_speed.hpp"
#include "mjarm/trajectory/path_timing.hpp"
#include "mjarm/trajectory/point_to_point.hpp"
#include "mjarm/trajectory/via_points.hpp"

namespace mjarm {
namespace {

constexpr double kSag = 1e-6;           // [rad or m] that a joint leaves the chords of samples by
constexpr double kBendSamples = 100;    // of a rounded corner, for a first look
constexpr std::size_t kMaxPoints = 48;  // that a motion is led through
constexpr int kMaxTurns = 24;           // of adding points where a motion leaves what is free
constexpr double kFirstMove = 0.15, kLastMove = 0.01;  // [rad or m, L2] of a point
constexpr double kLonger = 1.4, kShorter = 0.8;  // the next move after one that helped or did not

/// A motion, and the points it is led through.
struct LedMotion {
  Trajectory trajectory;
  std::vector<JointVec> points;
  std::vector<char> fixed;  ///< of each point: it must be met
};

/// A motion in pieces whose chords no joint leaves by more than kSag.
std::vector<JointVec> sampled(const Trajectory& motion, const JointLimits& limits) {
  const double step = std::sqrt(8 * kSag / limits.acceleration.maxCoeff());
  const std::size_t count = static_cast<std::size_t>(motion.duration() / step) + 2;
  std::vector<JointVec> way;
  way.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count - 1);
    way.push_back(motion.at(share * motion.duration()).q);
  }
  return way;
}

class MotionSearch {
 public:
  MotionSearch(std::span<const JointVec> corners, const JointLimits& limits,
               const WayProver& prover, const PathMotionOptions& options)
      : corners_(corners), limits_(limits), prover_(prover), options_(options) {
    fixed_.assign(corners.size(), 0);
    fixed_.front() = fixed_.back() = 1;
    for (const std::size_t i : options.passed) fixed_[i] = 1;
  }

  Result<PathMotion> run() {
    Result<Trajectory> sharp = stop_at_corners();
    if (!sharp) return fail(sharp.error());
    PathMotion out{std::move(*sharp), 0};
    out.stopping = out.trajectory.duration();
    if (corners_.size() <= 2) return out;
    keep(round_corners(), out.trajectory);
    if (std::optional<LedMotion> led = swing_round_fewer()) {
      improve(*led);
      keep(std::move(led->trajectory), out.trajectory);
    }
    return out;
  }

 private:
  static void keep(std::optional<Trajectory> motion, Trajectory& best) {
    if (motion && motion->duration() < best.duration()) best = std::move(*motion);
  }

  Result<Trajectory> stop_at_corners() const {
    if (corners_.size() == 1) return Trajectory::through({0.0}, {JointState::at_rest(corners_[0])});
    std::vector<Trajectory> edges;
    for (std::size_t i = 1; i < corners_.size(); ++i) {
      Result<Trajectory> edge =
          time_joint_move(as_span(corners_[i - 1]), as_span(corners_[i]), limits_);
      if (!edge) return edge;
      edges.push_back(std::move(*edge));
    }
    return Trajectory::chain(edges);
  }

  bool is_proved(const Trajectory& motion) const {
    return prover_.is_proved(sampled(motion, limits_));
  }

  /// The widest blend of corner `i` that is proved free, 0: none.
  double blend_at(std::size_t i) const {
    if (fixed_[i] != 0) return 0;
    const double before = (corners_[i] - corners_[i - 1]).norm();
    const double after = (corners_[i + 1] - corners_[i]).norm();
    const double max =
        std::min((i == 1 ? 1 : 0.5) * before, (i + 2 == corners_.size() ? 1 : 0.5) * after);
    for (const double share : {1.0, 0.7, 0.5, 0.35, 0.25, 0.15, 0.1, 0.05, 0.02}) {
      const double blend = share * max;
      const auto line = joint_polyline(corners_.subspan(i - 1, 3),
                                       {.blend = blend, .step = 2 * blend / kBendSamples});
      if (line && prover_.is_proved(line->path.q)) return blend;
    }
    return 0;
  }

  /// Along the edges, each corner rounded as far as it can be.
  std::optional<Trajectory> round_corners() const {
    constexpr double kSample = 0.03;  // [rad or m, L2]
    std::vector<double> blends;
    for (std::size_t i = 1; i + 1 < corners_.size(); ++i) blends.push_back(blend_at(i));
    const auto line = joint_polyline(corners_, {.blends = blends, .step = kSample});
    if (!line) return std::nullopt;
    std::vector<Trajectory> parts;
    std::size_t first = 0;
    for (std::size_t i = 1; i < line->path.s.size(); ++i) {
      if (!std::ranges::binary_search(line->corners, line->path.s[i])) continue;
      const std::span<const JointVec> part(line->path.q.data() + first, i - first + 1);
      Result<Trajectory> motion = time_waypoint_path(part, limits_);
      if (!motion) return std::nullopt;
      parts.push_back(std::move(*motion));
      first = i;
    }
    Result<Trajectory> motion = Trajectory::chain(parts);
    if (!motion || !is_proved(*motion)) return std::nullopt;
    return std::move(*motion);
  }

  /// The fastest of motions led through all corners, and through ever fewer of them: those go that
  /// are nearest to the straight way between their neighbours.
  std::optional<LedMotion> swing_round_fewer() const {
    constexpr int kFewLoose = 4;
    LedMotion led{{}, {corners_.begin(), corners_.end()}, fixed_};
    std::optional<LedMotion> best = swing_round(led);
    for (std::size_t i = flattest(led); i > 0; i = flattest(led)) {
      remove_point(i, led);
      if (std::ranges::count(led.fixed, 0) > kFewLoose) continue;
      std::optional<LedMotion> other = swing_round(led);
      const bool faster =
          other && (!best || other->trajectory.duration() < best->trajectory.duration());
      if (faster) best = std::move(other);
    }
    return best;
  }

  /// The point that need not be met and is nearest to the straight way between its neighbours; 0:
  /// none is left.
  static std::size_t flattest(const LedMotion& led) {
    std::size_t out = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i + 1 < led.points.size(); ++i) {
      if (led.fixed[i] != 0) continue;
      const double off =
          (nearest_on(led.points[i - 1], led.points[i + 1], led.points[i]) - led.points[i]).norm();
      if (off >= least) continue;
      least = off;
      out = i;
    }
    return out;
  }

  /// The place of the edge from `a` to `b` that is nearest to `q`.
  static JointVec nearest_on(const JointVec& a, const JointVec& b, const JointVec& q) {
    const JointVec edge = b - a;
    const double along = (q - a).dot(edge) / std::max(edge.squaredNorm(), 1e-18);
    return a + std::clamp(along, 0.0, 1.0) * edge;
  }

  static void remove_point(std::size_t i, LedMotion& led) {
    led.points.erase(led.points.begin() + static_cast<std::ptrdiff_t>(i));
    led.fixed.erase(led.fixed.begin() + static_cast<std::ptrdiff_t>(i));
  }

  /// Through the points, free to swing out between them; where that is not free, through more
  /// points on the path.
  std::optional<LedMotion> swing_round(LedMotion led) const {
    for (int turn = 0; turn < kMaxTurns && !is_stopped(options_.stop); ++turn) {
      const std::size_t i = lead(led);
      if (led.trajectory.dof() == 0) return std::nullopt;
      if (i == 0) return led;
      const JointVec middle = on_path(0.5 * (led.points[i - 1] + led.points[i]));
      if (!add_point(i, middle, led)) return std::nullopt;
    }
    return std::nullopt;
  }

  /// The place of the path that is nearest to `q`.
  JointVec on_path(const JointVec& q) const {
    JointVec nearest = corners_.front();
    for (std::size_t i = 1; i < corners_.size(); ++i) {
      const JointVec p = nearest_on(corners_[i - 1], corners_[i], q);
      if ((p - q).norm() < (nearest - q).norm()) nearest = p;
    }
    return nearest;
  }

  /// Times the motion through the points; an empty one where that fails.
  /// @return the point after the first stretch that is not proved; 0: all of it is.
  std::size_t lead(LedMotion& led) const {
    led.trajectory = {};
    Result<ViaMotion> motion = time_via_points(led.points, limits_);
    if (!motion) return 0;
    led.trajectory = std::move(motion->trajectory);
    const std::vector<JointVec> way = sampled(led.trajectory, limits_);
    const std::size_t pieces = way.size() - 1, first = prover_.first_unproved(way);
    if (first == pieces) return 0;
    std::size_t last = first;
    while (last < pieces && !prover_.is_proved(std::span(way).subspan(last, 2))) ++last;
    const double share = 0.5 * static_cast<double>(first + last) / static_cast<double>(pieces);
    const double middle = share * led.trajectory.duration();
    const auto after = std::ranges::upper_bound(motion->times, middle) - motion->times.begin();
    return std::clamp<std::size_t>(static_cast<std::size_t>(after), 1, led.points.size() - 1);
  }

  /// False where there are too many points, or one is there already.
  static bool add_point(std::size_t i, const JointVec& q, LedMotion& led) {
    constexpr double kLeastApart = 2e-3;  // [rad or m, L2]
    if (led.points.size() >= kMaxPoints) return false;
    for (const std::size_t k : {i - 1, i}) {
      if ((led.points[k] - q).norm() < kLeastApart) return false;
    }
    led.points.insert(led.points.begin() + static_cast<std::ptrdiff_t>(i), q);
    led.fixed.insert(led.fixed.begin() + static_cast<std::ptrdiff_t>(i), 0);
    return true;
  }

  /// Takes the motion through other points if it is faster and proved.
  bool try_points(LedMotion changed, LedMotion& led) const {
    Result<ViaMotion> motion = time_via_points(changed.points, limits_);
    if (!motion || !(motion->times.back() < led.trajectory.duration())) return false;
    if (!is_proved(motion->trajectory)) return false;
    changed.trajectory = std::move(motion->trajectory);
    led = std::move(changed);
    return true;
  }

  /// Points of the motion itself near both ends: its jerk is constant in parts of what lies between
  /// points, and short parts let it speed up and slow down better.
  void add_helpers(LedMotion& led) const {
    constexpr double kLong = 0.2;  // [s]
    const double duration = led.trajectory.duration(), at = std::min(kLong, 0.1 * duration);
    LedMotion changed = led;
    if (add_point(1, led.trajectory.at(at).q, changed) &&
        add_point(changed.points.size() - 1, led.trajectory.at(duration - at).q, changed)) {
      try_points(std::move(changed), led);
    }
  }

  /// Leaves out points, moves others at random, or the other way; keeps what makes the motion
  /// faster.
  void improve(LedMotion& led) const {
    for (std::size_t i = led.points.size() - 1; i-- > 1;) {
      if (led.fixed[i] != 0) continue;
      LedMotion changed = led;
      remove_point(i, changed);
      try_points(std::move(changed), led);
    }
    add_helpers(led);
    if (std::ranges::count(led.fixed, 0) == 0) return;
    Rng rng(1, 9);
    double step = kFirstMove;
    for (int k = 0; k < options_.changes && !is_stopped(options_.stop);) {
      const auto i = static_cast<std::size_t>(rng.below(led.points.size()));
      if (led.fixed[i] != 0) continue;
      JointVec way(led.points[i].size());
      for (double& x : way) x = rng.uniform() < 0.5 ? rng.normal() : 0.0;
      way *= step / std::max(way.norm(), 1e-9);
      bool better = false;
      for (const double side : {1.0, -1.0}) {
        LedMotion changed = led;
        changed.points[i] += side * way;
        ++k;
        better = try_points(std::move(changed), led);
        if (better) break;
      }
      step *= better ? kLonger : kShorter;
      if (step < kLastMove || step > kFirstMove) step = kFirstMove;
    }
  }

  std::span<const JointVec> corners_;
  const JointLimits& limits_;
  const WayProver& prover_;
  const PathMotionOptions& options_;
  std::vector<char> fixed_;
};

}  // namespace

Result<PathMotion> time_path(std::span<const JointVec> corners, const JointLimits& limits,
                             const WayProver& prover, const PathMotionOptions& options) {
  return MotionSearch(corners, limits, prover, options).run();
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
    if (!prover.is_proved(sampled(way.tail, limits))) continue;
    const Result<Trajectory> front = part_of(motion, 0, way.first);
    if (!front) continue;
    Result<Trajectory> whole = Trajectory::chain(std::vector{*front, way.tail});
    if (whole) return std::move(*whole);
  }
  return std::nullopt;
}

}  // namespace mjarm
