#include <algorithm>
#include <cmath>
#include <queue>

#include "mjarm/collision/edge_march_internal.hpp"
#include "mjarm/core/messages/collision.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm::detail {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kTurnError = 1e-5;  // an obstacle's rotation may be off by 1e-6
constexpr double kShare = 0.999;     // of a step that is taken, for the rounding of the step

struct LaterWatch {
  bool operator()(const Watch& a, const Watch& b) const { return a.until > b.until; }
};

/// The largest h with d + slope h - bend h^2 / 2 >= 0.
double safe_step(double d, double slope, double bend) {
  if (d <= 0) return 0;
  const double root = std::sqrt(slope * slope + 2 * bend * d);
  if (slope <= 0) return root > slope ? 2 * d / (root - slope) : kNever;
  return bend > 0 ? (slope + root) / bend : kNever;
}

constexpr long kLooksUnasked = 64;  // between two questions whether to stop

class EdgeMarch {
 public:
  EdgeMarch(const Arm& arm, MarchGeometry& geometry, std::span<const double> q0,
            std::span<const double> q1, const VerifyOptions& options)
      : arm_(arm),
        geometry_(geometry),
        options_(options),
        q0_(q0.begin(), q0.end()),
        way_(q0.size()),
        X_WJ_(q0.size()) {
    double squares = 0;
    for (std::size_t i = 0; i < q0.size(); ++i) {
      way_[i] = q1[i] - q0[i];
      squares += way_[i] * way_[i];
    }
    least_ = options.least_step / std::max(std::sqrt(squares), options.least_step);
  }

  Result<VerifyResult> run() {
    VerifyResult nearest;
    nearest.distance = kNever;
    watch_all();
    for (long looks = 0; !watches_.empty(); ++looks) {
      Watch watch = watches_.top();
      watches_.pop();
      if (looks % kLooksUnasked == 0 && is_stopped(options_.stop)) return fail(stopped());
      const Look now = look(watch, watch.until);
      if (now.clearance < nearest.distance) {
        nearest = result_of(EdgeVerdict::free, watch, watch.until, now);
      }
      if (now.overlaps) return result_of(EdgeVerdict::hit, watch, watch.until, now);
      if (looks == options_.max_looks) {
        return result_of(EdgeVerdict::undecided, watch, watch.until, now);
      }
      const double next = watch.until + kShare * now.step;
      if (next >= 1 || watch.until >= 1) continue;
      if (kShare * now.step < least_) return refuse(watch, now);
      watch.until = next;
      watches_.push(watch);
    }
    return nearest;
  }

 private:
  /// Something is about to touch: it overlaps a little further on, or nothing is known.
  VerifyResult refuse(const Watch& watch, const Look& now) {
    for (double step = least_; step < 1000 * least_; step *= 2) {
      const double next = std::min(watch.until + step, 1.0);
      const Look then = look(watch, next);
      if (then.overlaps) return result_of(EdgeVerdict::hit, watch, next, then);
    }
    return result_of(EdgeVerdict::undecided, watch, watch.until, now);
  }

  static VerifyResult result_of(EdgeVerdict verdict, const Watch& watch, double t,
                                const Look& look) {
    return {verdict, t, look.clearance, watch.link, watch.obstacle, watch.other_link, -1};
  }

  void watch_all() {
    for (int link = 0; link < geometry_.links(); ++link) {
      const double bend = bend_of(link, -1), keep = joint_of(link) >= 0 ? options_.keep : 0;
      for (int k = 0; k < geometry_.obstacles(); ++k) {
        if (geometry_.is_held(link, k)) watches_.push({0, bend, link, -1, k, -1, keep});
      }
    }
    for (const auto& pair : geometry_.pairs()) {
      // Seen from the link nearer to the base, only the joints between the two count.
      const bool in_order = joint_of(pair[0]) <= joint_of(pair[1]);
      const int near = in_order ? pair[0] : pair[1];
      const int far = in_order ? pair[1] : pair[0];
      const int base = joint_of(near);
      watches_.push({0, bend_of(far, base), far, base, -1, near, options_.keep});
    }
  }

  int joint_of(int link) const { return geometry_.joint_of(link); }
  bool is_slide(int joint) const {
    return arm_.joints[static_cast<std::size_t>(joint)].type == JointType::slide;
  }
  double rate(int joint) const { return std::abs(way_[static_cast<std::size_t>(joint)]); }

  /// Bound of |p''| on the whole edge, for the places of a link seen from joint `base`. For joints
  /// i < k the mixed derivative is axis_i x (axis_k x (p - o_k)), no longer than the way from o_k
  /// to p along the chain; axis_i x axis_k where k is a slide; none where i is one.
  double bend_of(int link, int base) const {
    double reach = geometry_.reach_of(link);  // of a place from the origin of joint k
    double turns = 0;                         // rates of the hinges from base to k
    for (int k = base + 1; k <= joint_of(link); ++k) turns += is_slide(k) ? 0 : rate(k);
    double bend = 0;
    for (int k = joint_of(link); k > base; --k) {
      const auto i = static_cast<std::size_t>(k);
      if (is_slide(k)) {
        bend += 2 * turns * rate(k);
        reach += std::max(std::abs(q0_[i]), std::abs(q0_[i] + way_[i]));
      } else {
        turns -= rate(k);
        bend += reach * rate(k) * (rate(k) + 2 * std::max(turns, 0.0));
      }
      reach += arm_.joints[i].X_PJ.p.norm();
    }
    return bend * (1 + kTurnError);
  }

  void place(double t) {
    if (t == t_) return;
    t_ = t;
    std::vector<double> q(q0_);
    for (std::size_t i = 0; i < q.size(); ++i) q[i] += t * way_[i];
    fk_all(arm_, q, X_WJ_);
  }

  /// How joints after `base` move a link.
  Twist twist_of(int link, int base) const {
    Twist twist;
    for (int k = base + 1; k <= joint_of(link); ++k) {
      const auto i = static_cast<std::size_t>(k);
      const Eigen::Vector3d axis_W = way_[i] * (X_WJ_[i].R * arm_.joints[i].axis);
      if (is_slide(k)) {
        twist.shift += axis_W;
      } else {
        twist.turn += axis_W;
        twist.shift -= axis_W.cross(X_WJ_[i].p);
      }
    }
    return twist;
  }

  Look look(const Watch& watch, double t) {
    place(t);
    Look out;
    geometry_.look(watch, X_WJ_, twist_of(watch.link, watch.base),
                   watch.keep - options_.allow_depth, out);
    return out;
  }

  const Arm& arm_;
  MarchGeometry& geometry_;
  const VerifyOptions& options_;
  std::vector<double> q0_, way_;
  std::vector<Pose> X_WJ_;  // at t_
  double t_ = -1;
  double least_ = 0;  // step in t
  std::priority_queue<Watch, std::vector<Watch>, LaterWatch> watches_;
};

Result<void> check_request(const Arm& arm, std::span<const double> q0, std::span<const double> q1,
                           const VerifyOptions& options) {
  const auto dof = static_cast<std::size_t>(arm.dof());
  if (q0.size() != dof || q1.size() != dof) {
    return fail(Errc::bad_input,
                text(msg::collision_edge_shape, dof, q0.size() != dof ? q0.size() : q1.size()));
  }
  const auto fits = [](double value) { return value >= 0 && std::isfinite(value); };
  if (!fits(options.allow_depth) || !fits(options.keep) || !fits(options.limit_slack) ||
      !fits(options.least_step) || options.least_step == 0 || options.max_looks < 1) {
    return fail(Errc::bad_input, text(msg::collision_verify_options));
  }
  return {};
}

/// The first joint that is outside of its limits (NaN is); -1 where none is.
int outside_joint(const Arm& arm, std::span<const double> q, double slack) {
  for (int i = 0; i < arm.dof(); ++i) {
    const double value = q[static_cast<std::size_t>(i)];
    const bool inside = std::isfinite(value) && value >= arm.limits.lower[i] - slack &&
                        value <= arm.limits.upper[i] + slack;
    if (!inside) return i;
  }
  return -1;
}

}  // namespace

void Look::add(double distance, double need, double rounding, double slope, double bend) {
  clearance = std::min(clearance, distance);
  if (distance - need < -rounding) overlaps = true;
  step = std::min(step, safe_step(distance - need - rounding, slope, bend));
}

Result<VerifyResult> march(const Arm& arm, MarchGeometry& geometry, std::span<const double> q0,
                           std::span<const double> q1, const VerifyOptions& options) {
  if (auto fits = check_request(arm, q0, q1, options); !fits) return fail(std::move(fits.error()));
  for (const double t : {0.0, 1.0}) {
    VerifyResult out{.verdict = EdgeVerdict::outside, .t = t};
    out.joint = outside_joint(arm, t == 0 ? q0 : q1, options.limit_slack);
    if (out.joint >= 0) return out;
  }
  return EdgeMarch(arm, geometry, q0, q1, options).run();
}

}  // namespace mjarm::detail
