#include "mjarm/collision/exact_watch.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "mjarm/collision/exact_arm_bodies_internal.hpp"
#include "mjarm/collision/exact_data_internal.hpp"
#include "mjarm/collision/exact_gaps_internal.hpp"
#include "mjarm/collision/exact_watch_internal.hpp"
#include "mjarm/core/finite.hpp"
#include "mjarm/core/messages/collision.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm {
namespace {

using detail::WatchPair;
using detail::WatchShape;

constexpr double kMeasured = 0.15;  // [m] farther apart a ball round a geom will do
constexpr double kNear = 0.1;       // [m] of nearest()
constexpr double kSlack = 0.2;      // share of the margin that is lost between two looks
constexpr double kHardShare = 0.5;  // share of the margin below which nothing may come nearer
constexpr double kAlong = 0.02;     // of the way, by which a pair along each other may come nearer
constexpr double kMeasureSure = 1e-7;  // [m] by which a distance is uncertain
constexpr int kMaxLooks = 60;          // of one pair on one way
constexpr double kWatchInfinity = std::numeric_limits<double>::infinity();

using JointPoses = std::array<Pose, kMaxDof>;

/// [m] No point of a body that is within `radius` of its origin was moved by more.
double moved_by(const Pose& from, const Pose& to, double radius) {
  // |(R - R') x| <= 2 sin(angle / 2) |x|, and the Frobenius norm of R - R' is 2 sqrt(2) sin(..).
  return (to.p - from.p).norm() + std::sqrt(0.5) * (to.R - from.R).norm() * radius;
}

/// A pair and what is known of its distance.
struct WatchGap {
  WatchPair shapes;
  double distance = -kWatchInfinity;  ///< [m] not less, when both had been moved by `moved`
  double moved = 0;                   ///< [m] by both together
  bool exact = false;                 ///< measured where the arm is now
};

}  // namespace

struct SceneWatch::Impl {
  Impl(Model of, const Arm& whose, const WatchOptions& chosen, detail::WatchPairs from)
      : model(std::move(of)),
        m(*model.raw()),
        arm(whose),
        options(chosen),
        bodies(m, arm),
        shapes(std::move(from.shapes)),
        d(mj_makeData(&m)) {
    // The arrays are those of the shared model; only the options of this head differ.
    m.opt.disableflags &= ~(mjDSBL_CONTACT | mjDSBL_CONSTRAINT | mjDSBL_NATIVECCD);
    for (const WatchPair& pair : from.pairs) gaps.push_back({pair});
    poses.resize(shapes.size());
    moved.assign(shapes.size(), 0);
    levers.resize(shapes.size());
    travel.resize(shapes.size());
  }

  const WatchShape& shape(int index) const { return shapes[static_cast<std::size_t>(index)]; }
  bool is_held(const WatchShape& one) const { return one.object >= 0 && one.object == held; }
  /// The joint that moves it now, what is held like the hand.
  int joint_of(const WatchShape& one) const { return is_held(one) ? arm.dof() - 1 : one.joint; }

  bool counts(const WatchPair& pair) const {
    const WatchShape &a = shape(pair.a), &b = shape(pair.b);
    if (a.object < 0 && b.object < 0) return true;
    return joint_of(a) != joint_of(b);  // not the hand with what it holds, nor two that stand
  }

  double margin_of(const WatchPair& pair) const {
    return is_held(shape(pair.a)) || is_held(shape(pair.b)) ? options.held_margin : options.margin;
  }

  Pose place(int index, const JointPoses& X_WJ) const {
    const WatchShape& one = shape(index);
    const auto i = static_cast<std::size_t>(index);
    if (is_held(one)) return X_WJ[static_cast<std::size_t>(arm.dof() - 1)] * held_in_hand[i];
    return one.joint < 0 ? poses[i] : X_WJ[static_cast<std::size_t>(one.joint)] * one.X_LG;
  }

  void take(std::span<const double> qpos, const JointVec& q, int what) {
    std::ranges::copy(qpos, d->qpos);
    mj_kinematics(&m, d.get());
    JointVec q_sim(arm.dof());
    for (int k = 0; k < arm.dof(); ++k) {
      q_sim[k] = qpos[static_cast<std::size_t>(bodies.addresses[static_cast<std::size_t>(k)])];
    }
    JointPoses X_sim;
    (void)fk_all(arm, as_span(q_sim), X_sim);
    (void)fk_all(arm, as_span(q), X_ref);
    if (what != held) forget();
    held = what;
    q_ref = q;
    held_in_hand.resize(shapes.size());
    const Pose X_hand = X_sim[static_cast<std::size_t>(arm.dof() - 1)].inverse();
    off = 0;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      const WatchShape& one = shapes[i];
      if (one.joint < 0 && (one.still && !fresh)) continue;
      const Pose before = poses[i];
      if (is_held(one)) held_in_hand[i] = X_hand * detail::geom_pose(*d, one.geom);
      if (one.joint < 0 && !is_held(one)) {
        poses[i] = detail::geom_pose(*d, one.geom);
      } else {
        poses[i] = place(static_cast<int>(i), X_ref);
        const Pose there = is_held(one) ? detail::geom_pose(*d, one.geom)
                                        : X_sim[static_cast<std::size_t>(one.joint)] * one.X_LG;
        off = std::max(off, moved_by(there, poses[i], one.radius));
      }
      moved[i] += fresh ? 0 : moved_by(before, poses[i], one.radius);
    }
    fresh = false;
    find_levers();
    for (WatchGap& gap : gaps) gap.exact = false;
  }

  void forget() {
    for (WatchGap& gap : gaps) gap.distance = -kWatchInfinity;
  }

  /// [m a radian or metre] By how much each joint moves any point of a shape where the arm is.
  void find_levers() {
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      const int joint = joint_of(shapes[i]);
      for (int k = 0; k <= joint; ++k) {
        const ArmJoint& one = arm.joints[static_cast<std::size_t>(k)];
        const Pose& X = X_ref[static_cast<std::size_t>(k)];
        const Eigen::Vector3d axis = X.R * one.axis;
        levers[i][static_cast<std::size_t>(k)] =
            one.type == JointType::slide ? 1.0
                                         : axis.cross(poses[i].p - X.p).norm() + shapes[i].radius;
      }
    }
  }

  /// Bounds of how far points of each shape go where the joints go by `by` (absolute values), all
  /// along the way: of those that the joints up to each one move.
  void find_travel(const JointVec& by) {
    double first = 0;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      double sum = 0;
      for (int k = 0; k <= joint_of(shapes[i]); ++k) {
        sum += by[k] * levers[i][static_cast<std::size_t>(k)];
      }
      first = std::max(first, sum);
    }
    // Levers grow on the way, by no more than points are moved against the joint: D <= first +
    // |by| D; and the chain is only so long.
    const double turn = by.sum();
    const double more = turn < 0.5 ? first / (1 - turn) : kWatchInfinity;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      const double reach = is_held(shapes[i]) ? kWatchInfinity : shapes[i].reach;
      double sum = 0;
      for (int k = 0; k <= joint_of(shapes[i]); ++k) {
        const auto at = static_cast<std::size_t>(k);
        const bool slides = arm.joints[at].type == JointType::slide;
        const double lever =
            slides ? 1 : std::min(levers[i][at] + more, std::max(reach, levers[i][at]));
        sum += by[k] > 0 ? by[k] * lever : 0;
        travel[i][at] = sum;
      }
    }
  }

  /// [m] By how much the distance of a pair can change on the way of find_travel().
  double change_of(const WatchPair& pair) const {
    int far = pair.a, near = pair.b;
    if (joint_of(shape(far)) < joint_of(shape(near))) std::swap(far, near);
    const auto& row = travel[static_cast<std::size_t>(far)];
    const int to = joint_of(shape(far)), from = joint_of(shape(near));
    if (to < 0) return 0;
    return row[static_cast<std::size_t>(to)] - (from < 0 ? 0 : row[static_cast<std::size_t>(from)]);
  }

  double moved_of(const WatchPair& pair) const {
    return moved[static_cast<std::size_t>(pair.a)] + moved[static_cast<std::size_t>(pair.b)];
  }

  /// [m] Not more than the distance of a pair at these poses; exact below kMeasured.
  double measure(const WatchPair& pair, const Pose& X_a, const Pose& X_b, bool& exact) {
    const WatchShape &a = shape(pair.a), &b = shape(pair.b);
    exact = false;
    if (a.radius > 0 && b.radius > 0) {
      const double least = (X_a.p - X_b.p).norm() - a.radius - b.radius;
      if (least > kMeasured) return least;
    }
    detail::GeomIds ids{a.geom, b.geom};
    detail::put_geom(*d, ids.geom1, X_a);
    detail::put_geom(*d, ids.geom2, X_b);
    if (m.geom_type[ids.geom1] > m.geom_type[ids.geom2]) std::swap(ids.geom1, ids.geom2);
    const double distance = detail::geom_distance(m, d.get(), ids, 2 * kMeasured);
    exact = distance < 2 * kMeasured;
    return distance;
  }

  /// What is known where the arm is; measured if that is less than `enough`.
  double known(WatchGap& gap, double enough) {
    const double total = moved_of(gap.shapes);
    const double least = gap.distance - (total - gap.moved);
    if (gap.exact || least >= enough) return least;
    gap.distance = measure(gap.shapes, poses[static_cast<std::size_t>(gap.shapes.a)],
                           poses[static_cast<std::size_t>(gap.shapes.b)], gap.exact);
    gap.moved = total;
    return gap.distance;
  }

  /// Whether one pair keeps its distance along the corners; `distance` tells the one that it does
  /// not keep.
  bool keeps(const WatchPair& pair, double here, double change, std::span<const JointVec> corners,
             std::span<const double> shares, double& distance) {
    const double margin = margin_of(pair), need = margin + off;
    const double hard = kHardShare * margin;
    int looks = 0;
    double gone = 0, last = here;  // [m] of the way; distance at the last look
    for (std::size_t leg = 0; leg + 1 < corners.size(); ++leg) {
      const double length = change * shares[leg];
      if (length <= 0) continue;
      for (double t = 0; t < 1;) {
        t = std::min(1.0, t + std::max(kSlack * margin, last - need) / length);
        if (++looks > kMaxLooks) return false;
        const JointVec q = corners[leg] + t * (corners[leg + 1] - corners[leg]);
        JointPoses X_WJ;
        (void)fk_all(arm, as_span(q), X_WJ);
        bool exact = false;
        last = distance = measure(pair, place(pair.a, X_WJ), place(pair.b, X_WJ), exact);
        if (last >= need) continue;
        if (here >= need ||
            last < here - (here > hard ? kAlong * (gone + t * length) : 0) - kMeasureSure) {
          return false;
        }
        if (here > hard && last < hard) return false;
      }
      gone += length;
    }
    return true;
  }

  Verdict check_way(const JointVec& q1, const JointVec& q2) {
    const std::array<JointVec, 3> corners{q_ref, q1, q2};
    const JointVec first = (q1 - q_ref).cwiseAbs(), second = (q2 - q1).cwiseAbs();
    find_travel(first + second);
    // The share of the whole way that a leg has at most, of any joint.
    std::array<double, 2> shares{0, 0};
    for (Eigen::Index k = 0; k < first.size(); ++k) {
      const double sum = first[k] + second[k];
      if (sum <= 0) continue;
      shares[0] = std::max(shares[0], first[k] / sum);
      shares[1] = std::max(shares[1], second[k] / sum);
    }
    Verdict out;
    for (std::size_t i = 0; i < gaps.size(); ++i) {
      if (!counts(gaps[i].shapes)) continue;
      const double change = change_of(gaps[i].shapes);
      if (change <= 0) continue;
      const double need = margin_of(gaps[i].shapes) + off;
      const double here = known(gaps[i], need + change);
      if (here >= need + change) continue;
      double distance = here;
      if (keeps(gaps[i].shapes, here, change, corners, shares, distance)) continue;
      return {false, static_cast<int>(i), std::min(here, distance)};
    }
    return out;
  }

  NearBodies names(const WatchPair& pair, double distance) const {
    const auto body = [&](int index) {
      return detail::body_name(m, m.geom_bodyid[shape(index).geom]);
    };
    const bool swapped = joint_of(shape(pair.a)) < joint_of(shape(pair.b));
    return {body(swapped ? pair.b : pair.a), body(swapped ? pair.a : pair.b), distance};
  }

  Model model;  // keeps the arrays alive
  mjModel m;    // head of the model
  Arm arm;
  WatchOptions options;
  detail::ArmBodies bodies;
  std::vector<WatchShape> shapes;
  detail::MjDataPtr d;
  std::vector<WatchGap> gaps;
  int held = -1;
  double off = 0;  ///< [m] by which any point of the arm is not where it is led
  bool fresh = true;
  JointVec q_ref;
  JointPoses X_ref;
  std::vector<Pose> poses;         ///< X_WG where the arm is led
  std::vector<Pose> held_in_hand;  ///< X_LG of what is held
  std::vector<double> moved;       ///< [m] the way of each shape so far
  std::vector<std::array<double, kMaxDof>> levers, travel;
};

Result<SceneWatch> SceneWatch::create(const Model& model, const Arm& arm,
                                      const WatchOptions& options) {
  const auto fits = [](double length) { return length > 0 && std::isfinite(length); };
  if (!fits(options.margin) || !fits(options.held_margin)) {
    return fail(Errc::bad_input,
                text(msg::collision_watch_margin, options.margin, options.held_margin));
  }
  if (!detail::ArmBodies(*model.raw(), arm).matches) {
    return fail(Errc::bad_input, text(msg::collision_other_arm, arm.name));
  }
  Result<detail::WatchPairs> pairs = detail::watch_pairs(model, arm);
  if (!pairs) return fail(std::move(pairs.error()));
  return SceneWatch(std::make_unique<Impl>(model, arm, options, std::move(*pairs)));
}

SceneWatch::SceneWatch(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SceneWatch::~SceneWatch() = default;
SceneWatch::SceneWatch(SceneWatch&&) noexcept = default;
SceneWatch& SceneWatch::operator=(SceneWatch&&) noexcept = default;

void SceneWatch::take(std::span<const double> qpos, const JointVec& q_ref, int held) {
  impl_->take(qpos, q_ref, held);
}

SceneWatch::Verdict SceneWatch::check_way(const JointVec& q1, const JointVec& q2) {
  return impl_->check_way(q1, q2);
}

NearBodies SceneWatch::near(const Verdict& verdict) const {
  if (verdict.pair < 0) return {};
  return impl_->names(impl_->gaps[static_cast<std::size_t>(verdict.pair)].shapes, verdict.distance);
}

std::optional<NearBodies> SceneWatch::nearest() const {
  const WatchGap* least = nullptr;
  for (const WatchGap& gap : impl_->gaps) {
    if (!gap.exact || gap.distance > kNear || !impl_->counts(gap.shapes)) continue;
    if (least == nullptr || gap.distance < least->distance) least = &gap;
  }
  if (least == nullptr) return std::nullopt;
  return impl_->names(least->shapes, least->distance);
}

std::size_t SceneWatch::pairs() const { return impl_->gaps.size(); }

}  // namespace mjarm
