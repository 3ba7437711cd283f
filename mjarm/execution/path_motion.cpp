#include "mjarm/execution/path_motion.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "mjarm/core/rng.hpp"
#include "mjarm/path/joint_polyline.hpp"
#include "mjarm/trajectory/path_timing.hpp"
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
    std::optional<LedMotion> led = pull_out(), other = swing_round();
    if (!led || (other && other->trajectory.duration() < led->trajectory.duration())) {
      led = std::move(other);
    }
    if (led) improve(*led);
    if (led) keep(std::move(led->trajectory), out.trajectory);
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

  /// A motion in pieces whose chords no joint leaves by more than kSag.
  std::size_t sampled_size(const Trajectory& motion) const {
    const double step = std::sqrt(8 * kSag / limits_.acceleration.maxCoeff());
    return static_cast<std::size_t>(motion.duration() / step) + 2;
  }
  std::vector<JointVec> sampled(const Trajectory& motion) const {
    const std::size_t count = sampled_size(motion);
    std::vector<JointVec> way;
    way.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(count - 1);
      way.push_back(motion.at(share * motion.duration()).q);
    }
    return way;
  }
  bool is_proved(const Trajectory& motion) const { return prover_.is_proved(sampled(motion)); }

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

  /// Through what must be met alone, and through more points where that is not free: each is taken
  /// from where the motion is in the way and moved towards the path just as far as it has to be.
  std::optional<LedMotion> pull_out() const {
    LedMotion led;
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      if (fixed_[i] == 0) continue;
      led.points.push_back(corners_[i]);
      led.fixed.push_back(1);
    }
    for (int turn = 0; turn < kMaxTurns; ++turn) {
      if (is_stopped(options_.stop)) return std::nullopt;
      const std::optional<Blocked> blocked = lead(led);
      if (!blocked) return led.trajectory.dof() > 0 ? std::optional(std::move(led)) : std::nullopt;
      const JointVec q = led.trajectory.at(blocked->middle).q;
      if (!add_point(blocked->after, beside(q), led)) return std::nullopt;
    }
    return std::nullopt;
  }

  /// Through the corners, free to swing out between them; where that is not free, through more
  /// points of the edges.
  std::optional<LedMotion> swing_round() const {
    LedMotion led{{}, {corners_.begin(), corners_.end()}, fixed_};
    for (int turn = 0; turn < kMaxTurns; ++turn) {
      if (is_stopped(options_.stop)) return std::nullopt;
      const std::optional<Blocked> blocked = lead(led);
      if (!blocked) return led.trajectory.dof() > 0 ? std::optional(std::move(led)) : std::nullopt;
      const JointVec middle = 0.5 * (led.points[blocked->after - 1] + led.points[blocked->after]);
      if (!add_point(blocked->after, middle, led)) return std::nullopt;
    }
    return std::nullopt;
  }

  /// Where a motion is not proved.
  struct Blocked {
    double middle = 0;      ///< [s] of the first stretch
    std::size_t after = 1;  ///< the point that follows there
  };

  /// Times the motion through the points; an empty one where that fails.
  /// @return where it is not proved, none: all of it is.
  std::optional<Blocked> lead(LedMotion& led) const {
    led.trajectory = {};
    Result<ViaMotion> motion = time_via_points(led.points, limits_);
    if (!motion) return std::nullopt;
    led.trajectory = std::move(motion->trajectory);
    const std::vector<JointVec> way = sampled(led.trajectory);
    const std::size_t pieces = way.size() - 1, first = prover_.first_unproved(way);
    if (first == pieces) return std::nullopt;
    std::size_t last = first;
    while (last < pieces && !prover_.is_proved(std::span(way).subspan(last, 2))) ++last;
    const double share = 0.5 * static_cast<double>(first + last) / static_cast<double>(pieces);
    const double middle = share * led.trajectory.duration();
    const auto after = std::ranges::upper_bound(motion->times, middle) - motion->times.begin();
    return Blocked{
        middle, std::clamp<std::size_t>(static_cast<std::size_t>(after), 1, led.points.size() - 1)};
  }

  /// The point nearest to `q` that is free on the straight way from there to the path.
  JointVec beside(const JointVec& q) const {
    constexpr int kHalvings = 6;
    JointVec nearest = corners_.front();
    for (std::size_t i = 1; i < corners_.size(); ++i) {
      const JointVec edge = corners_[i] - corners_[i - 1];
      const double along = (q - corners_[i - 1]).dot(edge) / edge.squaredNorm();
      const JointVec p = corners_[i - 1] + std::clamp(along, 0.0, 1.0) * edge;
      if ((p - q).norm() < (nearest - q).norm()) nearest = p;
    }
    double blocked = 0, free = 1;
    for (int k = 0; k < kHalvings; ++k) {
      const double share = 0.5 * (blocked + free);
      const JointVec p = q + share * (nearest - q);
      (prover_.is_proved(std::vector{p, p}) ? free : blocked) = share;
    }
    return q + free * (nearest - q);
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

  /// Leaves out points and moves them at random; keeps what makes the motion faster.
  void improve(LedMotion& led) const {
    for (std::size_t i = led.points.size() - 1; i-- > 1;) {
      if (led.fixed[i] == 0) leave_out(i, led);
    }
    add_helpers(led);
    Rng rng(1, 9);
    double step = kFirstMove;
    for (int k = 0; k < options_.changes && !is_stopped(options_.stop); ++k) {
      const auto i = static_cast<std::size_t>(rng.below(led.points.size()));
      if (led.fixed[i] != 0) continue;
      LedMotion changed = led;
      JointVec way(led.points[i].size());
      for (double& x : way) x = rng.uniform() < 0.5 ? rng.normal() : 0.0;
      changed.points[i] += way * (step / std::max(way.norm(), 1e-9));
      step *= try_points(std::move(changed), led) ? kLonger : kShorter;
      if (step < kLastMove || step > kFirstMove) step = kFirstMove;
    }
  }

  void leave_out(std::size_t i, LedMotion& led) const {
    LedMotion changed = led;
    changed.points.erase(changed.points.begin() + static_cast<std::ptrdiff_t>(i));
    changed.fixed.erase(changed.fixed.begin() + static_cast<std::ptrdiff_t>(i));
    try_points(std::move(changed), led);
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

}  // namespace mjarm
