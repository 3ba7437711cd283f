#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/path/path_cause_internal.hpp"
#include "mjarm/path/path_speed_internal.hpp"

namespace mjarm::detail {
namespace {

/// How one track would go on to the pose that none reaches.
struct Onward {
  PathErrc code = PathErrc::branch_flip;
  double amount = 0;
  int joint = -1;
  JointVec q;  ///< where the tool would be there
};

/// The joint farthest beyond its limit.
struct Beyond {
  int joint = -1;
  double amount = 0;  ///< [rad or m] > 0 where `joint` is one
};

Beyond beyond_limits(const JointLimits& limits, const JointVec& q) {
  Beyond out;
  for (int i = 0; i < q.size(); ++i) {
    const double amount = std::max(limits.lower[i] - q[i], q[i] - limits.upper[i]);
    if (amount > std::max(out.amount, 1e-9)) out = {i, amount};
  }
  return out;
}

/// The joint too fast for the speed asked for, if one is.
Overspeed too_fast(const PathLayers& layers, const Pose& X0, const Pose& X1, const JointVec& step) {
  const double speed = layers.options().tool_speed;
  if (speed == 0) return {};
  return overspeed(layers.ik().arm(), step, time_at_speed(X0, X1, speed));
}

Onward step_on(const PathLayers& layers, const Pose& X0, const Pose& X_WT, const JointVec& q_from) {
  Onward out;
  const auto q = layers.onward(X_WT, q_from);
  if (!q) return out;
  out.q = *q;
  Eigen::Index joint = 0;
  out.amount = (*q - q_from).cwiseAbs().maxCoeff(&joint);
  out.joint = static_cast<int>(joint);
  if (out.amount > layers.options().max_step) return out;
  const Beyond beyond = beyond_limits(layers.ik().arm().limits, *q);
  const Overspeed fast = too_fast(layers, X0, X_WT, *q - q_from);
  out.code = PathErrc::collision;
  if (beyond.joint >= 0) {
    out.code = PathErrc::joint_limit;
    out.joint = beyond.joint;
    out.amount = beyond.amount;
  } else if (fast.joint >= 0) {
    out.code = PathErrc::joint_speed;
    out.joint = fast.joint;
    out.amount = fast.amount;
  }
  return out;
}

/// How far beyond its limit `joint` would be taken if the arm went on from `q` to the end.
double farthest_beyond(const PathLayers& layers, std::span<const Pose> rest, JointVec q,
                       int joint) {
  constexpr std::size_t kMax = 10000;  // poses
  const JointLimits& limits = layers.ik().arm().limits;
  double worst = 0;
  for (const Pose& X_WT : rest.first(std::min(rest.size(), kMax))) {
    if (is_stopped(layers.options().stop)) break;
    const auto next = layers.onward(X_WT, q);
    if (!next || (*next - q).cwiseAbs().maxCoeff() > layers.options().max_step) break;
    q = *next;
    worst = std::max({worst, limits.lower[joint] - q[joint], q[joint] - limits.upper[joint]});
  }
  return worst;
}

/// How far above its speed limit that joint would get on the way to the end.
void tell_speed(const PathLayers& layers, std::span<const Pose> poses, const Onward& onward,
                PathFailure& out) {
  constexpr std::size_t kMax = 10000;  // poses
  out.joint = onward.joint;
  out.amount = onward.amount;
  JointVec q = onward.q;
  const std::size_t end = std::min(poses.size(), out.at + kMax);
  for (std::size_t i = out.at + 1; i < end && !is_stopped(layers.options().stop); ++i) {
    const auto next = layers.onward(poses[i], q);
    if (!next || (*next - q).cwiseAbs().maxCoeff() > layers.options().max_step) break;
    const double step = std::abs((*next - q)[out.joint]);
    const double time = time_at_speed(poses[i - 1], poses[i], layers.options().tool_speed);
    if (time > 0) {
      out.amount = std::max(out.amount, step / time - layers.ik().arm().limits.velocity[out.joint]);
    }
    q = *next;
  }
}

/// The least singular value on the way from one pose to the next, without limits.
struct Passage {
  bool whole = false;  ///< the branch leads all the way
  double smallest = std::numeric_limits<double>::infinity();
  JointVec q;  ///< where that is
};

/// Follows the branch of `q` from X0 to X1 in steps that shrink where the joints race.
Passage pass(const PathLayers& layers, const Pose& X0, const Pose& X1, JointVec q) {
  constexpr double kStep = 0.2;                            // [rad or m]
  constexpr double kLongest = 1 / 16.0, kShortest = 1e-7;  // shares of the way
  Passage out;
  double t = 0, dt = kLongest;
  while (t < 1 && dt >= kShortest) {
    const double next = std::min(t + dt, 1.0);
    const auto answer = layers.onward(interpolate(X0, X1, next), q);
    if (!answer || (*answer - q).cwiseAbs().maxCoeff() > kStep) {
      dt /= 2;
      continue;
    }
    q = *answer;
    t = next;
    dt = std::min(2 * dt, kLongest);
    const double smallest = layers.smallest_singular_value(q);
    if (smallest < out.smallest) {
      out.smallest = smallest;
      out.q = q;
    }
  }
  out.whole = t >= 1;
  return out;
}

PathErrc code_of(IkErrc code) {
  switch (code) {
    case IkErrc::out_of_reach:
      return PathErrc::out_of_reach;
    case IkErrc::inner_void:
      return PathErrc::inner_void;
    case IkErrc::joint_limit:
      return PathErrc::joint_limit;
    case IkErrc::collision:
      return PathErrc::collision;
    case IkErrc::too_far:
      return PathErrc::branch_flip;
    case IkErrc::bad_input:
      return PathErrc::bad_input;
    case IkErrc::no_convergence:
      break;
  }
  return PathErrc::no_convergence;
}

void tell(const IkFailure& ik, PathFailure& out) {
  out.code = code_of(ik.code);
  out.ik = ik;
  out.amount = ik.amount;
  out.joint = ik.joint;
}

/// How much worse it gets beyond the pose at which it begins, as far as the reason is the same: at
/// the border itself there is nothing to tell.
void tell_deepest(const PathLayers& layers, std::span<const Pose> rest, const JointVec& q,
                  PathFailure& out) {
  constexpr std::size_t kMax = 256;  // poses looked at
  const bool exact = layers.ik().six_axis() || layers.ik().seven_axis();
  const std::size_t stride = std::max<std::size_t>(1, rest.size() / kMax);
  // The amount by which a wrist cannot turn is no length.
  const auto is_length = [](const IkFailure& ik) { return ik.shape != ReachShape::wrist_cone; };
  for (std::size_t i = stride; i < rest.size() && is_length(out.ik); i += stride) {
    if (is_stopped(layers.options().stop)) return;
    // Where only a search would answer, geometry alone is asked.
    if (!exact && !layers.ik().reach().check(rest[i])) return;
    const auto answer = layers.boundless().solve(rest[i], as_span(q));
    if (answer || answer.error().code != out.ik.code || !is_length(answer.error())) return;
    if (answer.error().amount > out.ik.amount) tell(answer.error(), out);
  }
}

void tell_collision(const PathLayers& layers, const JointVec& q, PathFailure& out) {
  out.code = PathErrc::collision;
  out.amount = 0;
  if (!layers.options().clearance) return;
  const Clearance clearance = layers.options().clearance(as_span(q));
  out.amount = std::max(0.0, -clearance.distance);
  out.pair = clearance.pair;
}

/// How deep the arm would be in what it touches at `q` if it went on from there.
void tell_deepest_contact(const PathLayers& layers, std::span<const Pose> rest, JointVec q,
                          PathFailure& out) {
  constexpr std::size_t kMax = 256;  // postures looked at
  if (!layers.options().clearance) return;
  const std::size_t stride = std::max<std::size_t>(1, rest.size() / kMax);
  for (std::size_t i = stride; i < rest.size(); i += stride) {
    if (is_stopped(layers.options().stop)) return;
    const auto next = layers.onward(rest[i], q);
    if (!next || (*next - q).cwiseAbs().maxCoeff() > layers.options().max_step) return;
    q = *next;
    const Clearance clearance = layers.options().clearance(as_span(q));
    if (clearance.distance >= 0) return;
    if (-clearance.distance <= out.amount) continue;
    out.amount = -clearance.distance;
    out.pair = clearance.pair;
  }
}

/// The first pose has no answer at all that will do.
void tell_start(const PathLayers& layers, const Pose& X_WT, const JointVec& q_start,
                PathFailure& out) {
  const auto answer = layers.ik().solve(X_WT, as_span(q_start));
  if (!answer && answer.error().code != IkErrc::collision) return tell(answer.error(), out);
  const JointVec q = answer ? answer->q : answer.error().best.q;
  out.ik.code = IkErrc::collision;
  out.ik.best.q = q;
  tell_collision(layers, q, out);
}

/// Only a longer step would go on: the joints race near a singularity, or the branch ends.
void tell_step(const PathLayers& layers, std::span<const Pose> poses, const Track& track,
               const Onward& onward, PathFailure& out) {
  constexpr double kNear = 0.05;  // smallest singular value
  constexpr double kFair = 0.3;   // one that needs no long step for a short way
  out.amount = onward.amount;
  out.joint = onward.joint;
  const Pose &X0 = poses[track.size() - 1], &X1 = poses[track.size()];
  const double way = std::hypot((X1.p - X0.p).norm(), angle_between(X0.R, X1.R));
  if (way > kFair * layers.options().max_step) return;  // the poses themselves are far apart
  const Passage passage = pass(layers, X0, X1, track.last.front().q);
  if (!passage.whole || passage.smallest > kNear) return;
  out.code = PathErrc::singularity;
  out.smallest = passage.smallest;
  out.kind = singularity(layers.ik(), as_span(passage.q), kNear).kind;
}

}  // namespace

PathFailure find_cause(const PathLayers& layers, std::span<const Pose> poses, const Track& track,
                       const JointVec& q_start) {
  constexpr std::size_t kMaxTracks = 64;
  PathFailure out;
  out.at = track.size();
  out.fraction = static_cast<double>(out.at) / static_cast<double>(poses.size());
  const Pose& X_WT = poses[out.at];
  if (out.at == 0) {
    tell_start(layers, X_WT, q_start, out);
    return out;
  }
  const auto free = layers.boundless().solve(X_WT, as_span(track.q.back()));
  if (!free) {
    // Limits may turn "too far" into a proof of more.
    const auto bound = layers.ik().solve(X_WT, as_span(track.q.back()));
    tell(bound ? free.error() : bound.error(), out);
    const bool reach = out.ik.code == IkErrc::out_of_reach || out.ik.code == IkErrc::inner_void;
    if (reach) tell_deepest(layers, poses.subspan(out.at), track.q.back(), out);
    return out;
  }
  std::optional<Onward> best;
  const std::size_t count = std::min(track.last.size(), kMaxTracks);
  for (std::size_t i = 0; i < count; ++i) {
    const Onward onward = step_on(layers, poses[out.at - 1], X_WT, track.last[i].q);
    if (!best || (best->code == PathErrc::branch_flip && onward.code != best->code)) best = onward;
  }
  out.code = best->code;
  switch (best->code) {
    case PathErrc::joint_limit:
      out.joint = best->joint;
      out.amount = std::max(best->amount,
                            farthest_beyond(layers, poses.subspan(out.at), best->q, best->joint));
      break;
    case PathErrc::collision:
      tell_collision(layers, best->q, out);
      tell_deepest_contact(layers, poses.subspan(out.at), best->q, out);
      break;
    case PathErrc::joint_speed:
      tell_speed(layers, poses, *best, out);
      break;
    default:
      tell_step(layers, poses, track, *best, out);
  }
  return out;
}

}  // namespace mjarm::detail
