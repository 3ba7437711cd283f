#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/link_chain.hpp"
#include "mjarm/path/path_layers_internal.hpp"
#include "mjarm/path/path_speed_internal.hpp"
#include "mjarm/path/refine_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr int kDeepest = 24;  // halvings of one stretch
// [rad or m] Joints moving straight by less stray less than the answers themselves.
constexpr double kShortest = 1e-5;

/// A cubic from one answer to the next. A redundant arm has many answers between: along a straight
/// one its motion within itself would turn off at each waypoint, and be slow there once it is
/// timed.
struct Cubic {
  double s0 = 0, s1 = 0;
  JointVec q0, q1;
  JointVec bend0, bend1;  ///< what the slopes at the ends, times s1 - s0, have more than q1 - q0

  [[nodiscard]] JointVec at(double s) const {
    const double t = (s - s0) / (s1 - s0);
    return q0 + t * (q1 - q0) + t * (1 - t) * ((1 - t) * bend0 - t * bend1);
  }
};

/// dq/ds at waypoint k: that of the parabola through it and its neighbours.
JointVec slope(const JointPath& path, std::size_t k) {
  const auto chord = [&](std::size_t i) {
    return JointVec((path.q[i + 1] - path.q[i]) / (path.s[i + 1] - path.s[i]));
  };
  if (k == 0) return chord(0);
  if (k + 1 == path.q.size()) return chord(k - 1);
  const double share = (path.s[k] - path.s[k - 1]) / (path.s[k + 1] - path.s[k - 1]);
  return (1 - share) * chord(k - 1) + share * chord(k);
}

/// The cubic from waypoint i to the next.
Cubic cubic_after(const JointPath& path, std::size_t i) {
  const double s0 = path.s[i], s1 = path.s[i + 1];
  const JointVec step = path.q[i + 1] - path.q[i];
  return {s0,
          s1,
          path.q[i],
          path.q[i + 1],
          (s1 - s0) * slope(path, i) - step,
          (s1 - s0) * slope(path, i + 1) - step};
}

class Refiner {
 public:
  Refiner(const IkSolver& ik, const Curve& curve, const CurveOptions& options)
      : ik_(ik.with(seeded(ik.options(), options.path.max_step))),
        chain_(ik.chain()),
        curve_(curve),
        options_(options) {}

  Refined run(const JointPath& path) {
    append(path.s[0], path.q[0]);
    for (std::size_t i = 1; i < path.q.size() && !is_stopped(options_.path.stop); ++i) {
      cubic_ = cubic_after(path, i - 1);
      tilt_ = std::max(tilt(path, i - 1), tilt(path, i));
      stretch(path.s[i - 1], path.q[i - 1], path.s[i], path.q[i], 0);
      append(path.s[i], path.q[i]);
    }
    return std::move(out_);
  }

 private:
  /// Answers near a seed only.
  static IkOptions seeded(IkOptions options, double max_step) {
    options.max_step = max_step;
    options.restarts = 0;
    return options;
  }

  void append(double s, const JointVec& q) {
    out_.path.s.push_back(s);
    out_.path.q.push_back(q);
  }

  /// What the tool does at a share `t` of the stretch against what it should.
  [[nodiscard]] bool keeps(double s0, const JointVec& q0, double s1, const JointVec& q1,
                           double t) const {
    const Pose X = fk(chain_, as_span(JointVec((1 - t) * q0 + t * q1)));
    const Pose X_goal = options_.change(curve_.at((1 - t) * s0 + t * s1));
    return (X.p - X_goal.p).norm() <= options_.pos_tol &&
           turned(X, X_goal) <= options_.rot_tol + tilt_;
  }

  /// How far the tool is turned aside at a waypoint.
  [[nodiscard]] double tilt(const JointPath& path, std::size_t i) const {
    const double tol = options_.path.orientation_tol;
    if (tol == 0) return 0;
    const Pose X = fk(chain_, as_span(path.q[i])), X_goal = options_.change(curve_.at(path.s[i]));
    const double angle = angle_between(X.R, X_goal.R);
    return angle > 2 * ik_.options().rot_tol ? std::min(angle, tol) : 0;
  }

  /// The angle between two poses, as far as the task is about it.
  [[nodiscard]] double turned(const Pose& X, const Pose& X_goal) const {
    switch (ik_.options().task) {
      case IkTask::position:
        return 0;
      case IkTask::axis: {
        const Eigen::Vector3d z = X.R.col(2), z_goal = X_goal.R.col(2);
        return std::atan2(z.cross(z_goal).norm(), z.dot(z_goal));
      }
      case IkTask::pose:
        break;
    }
    return angle_between(X.R, X_goal.R);
  }

  /// The answer between two others; none where the branch is lost.
  [[nodiscard]] std::optional<JointVec> between(double s, const JointVec& q0,
                                                const JointVec& q1) const {
    const JointVec seed = cubic_.at(s);
    const Pose X_WT = turned_to(options_.change(curve_.at(s)), fk(chain_, as_span(seed)).R, tilt_);
    const auto answer = ik_.solve(X_WT, as_span(seed));
    if (!answer) return std::nullopt;
    const auto step = [&](const JointVec& q) { return (answer->q - q).cwiseAbs().maxCoeff(); };
    if (step(q0) > options_.path.max_step || step(q1) > options_.path.max_step) return std::nullopt;
    const ClearanceCheck& clearance = options_.path.clearance;
    if (clearance && !clearance.is_free(as_span(answer->q))) return std::nullopt;
    return answer->q;
  }

  void check_speed(double s0, const JointVec& q0, double s1, const JointVec& q1) {
    constexpr double kFine = 1e-3;  // so much faster is taken for the error of the stretches
    const double speed = options_.path.tool_speed;
    if (speed == 0) return;
    const Overspeed fast = overspeed(ik_.arm(), q1 - q0, (1 + kFine) * (s1 - s0) / speed);
    if (fast.joint >= 0) out_.lost.push_back({0.5 * (s0 + s1), fast.joint, fast.amount});
  }

  /// Appends the waypoints that are needed between two others. An error that changes its sign in
  /// the middle shows at the quarters.
  void stretch(double s0, const JointVec& q0, double s1, const JointVec& q1, int depth) {
    const bool shortest = (q1 - q0).cwiseAbs().maxCoeff() < kShortest;
    if (shortest || (keeps(s0, q0, s1, q1, 0.5) && keeps(s0, q0, s1, q1, 0.25) &&
                     keeps(s0, q0, s1, q1, 0.75))) {
      check_speed(s0, q0, s1, q1);
      return;
    }
    if (is_stopped(options_.path.stop)) return;
    const double s = 0.5 * (s0 + s1);
    const auto q = depth < kDeepest ? between(s, q0, q1) : std::nullopt;
    if (!q) {
      out_.lost.push_back({s});
      return;
    }
    stretch(s0, q0, s, *q, depth + 1);
    append(s, *q);
    stretch(s, *q, s1, q1, depth + 1);
  }

  IkSolver ik_;
  LinkChain chain_;
  const Curve& curve_;
  const CurveOptions& options_;
  Cubic cubic_;      // of the stretch at hand
  double tilt_ = 0;  // [rad] how far the tool may be turned aside there: as at its ends
  Refined out_;
};

}  // namespace

Refined refine(const IkSolver& ik, const Curve& curve, const JointPath& path,
               const CurveOptions& options) {
  return Refiner(ik, curve, options).run(path);
}

}  // namespace mjarm::detail
