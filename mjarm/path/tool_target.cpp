#include "mjarm/path/tool_target.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "mjarm/core/messages/target.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik_all.hpp"

namespace mjarm {
namespace {

constexpr double kStepWay = 0.01;      ///< [m] between two poses on the way to a target
constexpr double kStepAngle = 0.05;    ///< [rad] likewise
constexpr int kMaxSteps = 64;          ///< at first on one way, so that its time is bounded
constexpr double kStepJoint = 0.35;    ///< [rad or m] a joint may move from pose to pose
constexpr int kMaxSolves = 200;        ///< likewise
constexpr double kShortestPart = 64;   ///< parts of a step at an edge
constexpr double kNearLimit = 0.1;     ///< [rad or m]
constexpr double kSameBranch = 1;      ///< [rad or m] at most, to an answer beyond a gap
constexpr double kSampleJoint = 0.02;  ///< [rad or m] between samples of a straight joint motion
constexpr int kPostureStarts = 30;     ///< of an arm without a closed form
constexpr double kNearlySingular =
    0.01;  ///< smallest singular value that is not another branch yet

IkOptions near_options(IkTask task, const TargetContact& contact) {
  return {.restarts = 0, .task = task, .max_step = kStepJoint, .valid = contact.is_free};
}

IkOptions any_options(IkTask task, const TargetContact& contact) {
  return {.restarts = 20, .task = task, .valid = contact.is_free};
}

int steps_between(const Pose& from, const Pose& to, bool turns) {
  double steps = (to.p - from.p).norm() / kStepWay;
  if (turns) steps = std::max(steps, angle_between(from.R, to.R) / kStepAngle);
  return std::clamp(static_cast<int>(std::ceil(steps)), 1, kMaxSteps);
}

double largest_move(const JointVec& from, const JointVec& to) {
  return (to - from).cwiseAbs().maxCoeff();
}

int farthest_joint(const JointVec& from, const JointVec& to) {
  int joint = 0;
  (to - from).cwiseAbs().maxCoeff(&joint);
  return joint;
}

std::string_view unit_of(const Arm& arm, int joint) {
  const bool hinge = arm.joints[static_cast<std::size_t>(joint)].type == JointType::hinge;
  return hinge ? "rad" : "m";
}

}  // namespace

ToolTarget::ToolTarget(const Arm& arm, TargetContact contact)
    : task_(task_for(arm)),
      contact_(std::move(contact)),
      near_(arm, near_options(task_, contact_)),
      any_(arm, any_options(task_, contact_)) {
  set_goal(arm.home);
}

void ToolTarget::set_goal(const JointVec& q) {
  goal_ = q;
  X_WT_ = fk(arm(), as_span(q));
  standing_ = rate();
  refused_.reset();
}

/// Goes from the goal towards X_to, as far as the joints can follow.
/// @return whether that is to the end.
bool ToolTarget::lead(const Pose& X_to) {
  Pose X_from = fk(arm(), as_span(goal_));
  if (!turns()) X_from.R = X_to.R;
  const int steps = steps_between(X_from, X_to, turns());
  const JointVec q_start = goal_;
  const double longest = 1.0 / steps;
  double fraction = 0;
  double step = longest;
  // Where a step is too long for the joints, or leads out of reach, shorter ones are tried.
  for (int i = 0; i < kMaxSolves && fraction < 1 && step > longest / kShortestPart; ++i) {
    const double next = fraction + step > 1 - 1e-9 ? 1 : fraction + step;
    if (const auto answer = near_.solve(interpolate(X_from, X_to, next), as_span(goal_))) {
      // A short way for the tool shall be none that swings the arm about.
      if (largest_move(q_start, answer->q) > kStepJoint * (steps + 1)) return false;
      goal_ = answer->q;
      fraction = next;
      step = std::min(2 * step, longest);
    } else {
      step /= 2;
    }
  }
  return fraction == 1;
}

/// True where the straight joint motion passes neither contact nor a singularity, beyond which
/// another branch begins.
bool ToolTarget::is_connected(const JointVec& from, const JointVec& to) {
  const double way = largest_move(from, to);
  if (way > kSameBranch) return false;
  const int samples = std::max(1, static_cast<int>(std::ceil(way / kSampleJoint)));
  for (int i = 0; i < samples; ++i) {
    const JointVec q = from + (static_cast<double>(i) / samples) * (to - from);
    if (smallest_singular_value(fk_jacobian(arm(), as_span(q)).J_W) < kNearlySingular) return false;
    // What touches already at the beginning may leave.
    if (i > 0 && contact_.is_free && !contact_.is_free(as_span(q))) return false;
  }
  return true;
}

void ToolTarget::move_to(const Pose& X_WT) {
  const Pose X_before = fk(arm(), as_span(goal_));
  refused_.reset();
  X_WT_ = X_WT;
  const bool led = lead(X_WT);
  if (led) {
    standing_ = rate();
  } else if (auto answer = any_.solve(X_WT, as_span(goal_)); !answer) {
    standing_ = refuse(std::move(answer.error()));
  } else if (steps_between(X_before, X_WT, turns()) > 1 && is_connected(goal_, answer->q)) {
    goal_ = answer->q;
    standing_ = rate();
  } else {
    standing_ = rate();
    standing_.grade = TargetGrade::jump;
    standing_.jump = answer->q;
  }
  turn_with_tool();
}

/// Where the orientation does not count, the target turns with the tool.
void ToolTarget::turn_with_tool() {
  if (!turns()) X_WT_.R = fk(arm(), as_span(goal_)).R;
}

Eigen::Matrix3d ToolTarget::axes(JogFrame frame) const {
  if (frame == JogFrame::tool) return X_WT_.R;
  if (frame == JogFrame::base) return arm().joints.front().X_PJ.R;
  return Eigen::Matrix3d::Identity();
}

bool ToolTarget::jog(JogFrame frame, int axis, double amount) {
  const Pose X_before = X_WT_;
  const JointVec goal_before = goal_;
  const Standing before = standing_;
  // A target out of reach is taken up from where the arm stays.
  if (grade() == TargetGrade::unreachable) X_WT_ = fk(arm(), as_span(goal_));
  const Eigen::Vector3d direction_W = axes(frame).col(axis % 3);
  Pose X_WT = X_WT_;
  if (axis < 3) {
    X_WT.p += amount * direction_W;
  } else {
    X_WT.R = rotation_exp(amount * direction_W) * X_WT.R;
  }
  move_to(X_WT);
  if (grade() != TargetGrade::unreachable) return true;
  refused_ = standing_;
  standing_ = before;
  goal_ = goal_before;
  X_WT_ = X_before;
  return false;
}

void ToolTarget::take_jump() {
  if (jump()) take_posture(*jump());
}

std::vector<JointVec> ToolTarget::postures(int max) const {
  std::vector<JointVec> out;
  const auto answers =
      solve_all(any_, X_WT_, as_span(goal_), {.starts = kPostureStarts, .max = max});
  if (!answers) return out;
  for (const IkSolution& answer : *answers) out.push_back(answer.q);
  return out;
}

void ToolTarget::take_posture(const JointVec& q) {
  goal_ = JointVec(q);
  standing_ = rate();
  refused_.reset();
  turn_with_tool();
}

/// Of the goal, which reaches the target.
ToolTarget::Standing ToolTarget::rate() const {
  Standing out;
  out.room = std::numeric_limits<double>::infinity();
  for (int i = 0; i < arm().dof(); ++i) {
    const double room =
        std::min(goal_[i] - arm().limits.lower[i], arm().limits.upper[i] - goal_[i]);
    if (!(room < out.room)) continue;
    out.room = std::max(room, 0.0);
    out.tightest = i;
  }
  out.singular = singularity(any_, as_span(goal_));
  if (out.singular.kind != SingularKind::none) {
    out.grade = TargetGrade::near_singular;
  } else if (out.room < kNearLimit) {
    out.grade = TargetGrade::near_limit;
  }
  return out;
}

std::string ToolTarget::jump_line(const JointVec& to) const {
  const int joint = farthest_joint(goal_, to);
  return text(msg::target_jump, std::abs(to[joint] - goal_[joint]),
              arm().joints[static_cast<std::size_t>(joint)].name, unit_of(arm(), joint));
}

/// Of a pose that cannot be reached; of a collision also what touches, which the solver does not
/// know.
ToolTarget::Standing ToolTarget::refuse(IkFailure failure) {
  Standing out = rate();
  out.grade = TargetGrade::unreachable;
  if (failure.code == IkErrc::collision && contact_.look) {
    out.contact = contact_.look(as_span(failure.best.q));
    if (out.contact && out.contact->free) out.contact.reset();
  }
  out.failure = std::move(failure);
  return out;
}

std::string ToolTarget::line_of(const Standing& standing) const {
  if (standing.failure) {
    return text(msg::target_not_reachable, standing.contact ? describe(*standing.contact)
                                                            : describe(*standing.failure, arm()));
  }
  if (standing.jump) return jump_line(*standing.jump);
  const double smallest = standing.singular.smallest;
  if (standing.grade == TargetGrade::near_singular) {
    return text(msg::target_near_singular, describe(standing.singular.kind), smallest);
  }
  if (std::isinf(standing.room)) return text(msg::target_reachable_endless, smallest);
  const Msg message =
      standing.grade == TargetGrade::near_limit ? msg::target_near_limit : msg::target_reachable;
  return text(message, standing.room, unit_of(arm(), standing.tightest),
              arm().joints[static_cast<std::size_t>(standing.tightest)].name, smallest);
}

std::string ToolTarget::line() const {
  if (refused_) return text(msg::target_stays, line_of(*refused_));
  return line_of(standing_);
}

}  // namespace mjarm
