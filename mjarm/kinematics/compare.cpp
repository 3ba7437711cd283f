#include "mjarm/kinematics/compare.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "mjarm/core/messages/check.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/compare_internal.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm {
namespace {

Pose motion(const ArmJoint& joint, double q) {
  if (joint.type == JointType::slide) return {q * joint.axis, Eigen::Matrix3d::Identity()};
  return {Eigen::Vector3d::Zero(), rotation_exp(q * joint.axis)};
}

JointVec random_joints(const Arm& arm, Rng& rng) {
  JointVec q(arm.dof());
  for (int i = 0; i < arm.dof(); ++i) {
    const bool hinge = arm.joints[static_cast<std::size_t>(i)].type == JointType::hinge;
    const double max = hinge ? std::numbers::pi : 0.5;
    const double lower = std::isfinite(arm.limits.lower[i]) ? arm.limits.lower[i] : -max;
    const double upper = std::isfinite(arm.limits.upper[i]) ? arm.limits.upper[i] : max;
    q[i] = rng.uniform(lower, std::max(lower, upper));
  }
  return q;
}

/// Largest differences of two arms.
struct Worst {
  double position = 0, rotation = 0;
  JointVec q_position, q_rotation;
};

/// @param order  for each joint of `second` the joint of `first` with the same value.
Worst measure(const Arm& first, const Arm& second, const std::vector<int>& order,
              const CompareOptions& options) {
  Rng rng(options.seed);
  Worst worst;
  worst.q_position = worst.q_rotation = JointVec::Zero(first.dof());
  for (int k = 0; k < options.configurations; ++k) {
    const JointVec q = random_joints(first, rng);
    JointVec p(second.dof());
    for (int i = 0; i < second.dof(); ++i) p[i] = q[order[static_cast<std::size_t>(i)]];
    const Pose A = fk(first, as_span(q));
    const Pose B = fk(second, as_span(p));
    if (const double d = (A.p - B.p).norm(); d > worst.position) {
      worst.position = d;
      worst.q_position = q;
    }
    if (const double d = angle_between(A.R, B.R); d > worst.rotation) {
      worst.rotation = d;
      worst.q_rotation = q;
    }
  }
  return worst;
}

/// Parts that an explanation needs: a shift and a turn count one each.
int size_of(const std::vector<Cause>& causes, double tolerance) {
  int size = 0;
  for (const Cause& cause : causes) {
    const int parts = (cause.shift.norm() > tolerance) + (cause.turn.norm() > tolerance);
    size += std::max(1, parts);
  }
  return size;
}

bool in_order(const std::vector<int>& order) { return std::is_sorted(order.begin(), order.end()); }

}  // namespace

std::string_view name(CauseCode code) noexcept {
  switch (code) {
    case CauseCode::joint_order:
      return "joint_order";
    case CauseCode::base:
      return "base";
    case CauseCode::link:
      return "link";
    case CauseCode::zero_offset:
      return "zero_offset";
    case CauseCode::joint_sign:
      return "joint_sign";
    case CauseCode::tool:
      break;
  }
  return "tool";
}

std::vector<int> match_joints(const Arm& first, const Arm& second, bool& by_name) {
  std::vector<int> order;
  for (const ArmJoint& joint : second.joints) {
    const auto found = std::find_if(first.joints.begin(), first.joints.end(),
                                    [&](const ArmJoint& j) { return j.name == joint.name; });
    if (found == first.joints.end()) break;
    order.push_back(static_cast<int>(found - first.joints.begin()));
  }
  by_name = order.size() == second.joints.size();
  if (by_name) return order;
  order.clear();
  for (int i = 0; i < second.dof(); ++i) order.push_back(i);
  return order;
}

Arm with_causes(const Arm& arm, const std::vector<Cause>& causes) {
  Arm result = arm;
  for (const Cause& cause : causes) {
    const Pose X{cause.shift, rotation_exp(cause.turn)};
    const std::size_t i = static_cast<std::size_t>(std::max(0, cause.joint));
    ArmJoint& joint = result.joints[i];
    switch (cause.code) {
      case CauseCode::joint_order:
        break;
      case CauseCode::base:
        result.joints.front().X_PJ = X * result.joints.front().X_PJ;
        break;
      case CauseCode::link:
        joint.X_PJ = {joint.X_PJ.p + X.p, X.R * joint.X_PJ.R};
        break;
      case CauseCode::zero_offset: {
        Pose& next = i + 1 < result.joints.size() ? result.joints[i + 1].X_PJ : result.X_JT;
        next = motion(joint, cause.offset) * next;
        break;
      }
      case CauseCode::joint_sign:
        joint.axis = -joint.axis;
        break;
      case CauseCode::tool:
        result.X_JT = result.X_JT * X;
        break;
    }
  }
  return result;
}

Result<Comparison> compare_arms(const Arm& first, const Arm& second,
                                const CompareOptions& options) {
  if (first.dof() != second.dof()) {
    return fail(Errc::impossible, text(msg::against_other_joints, first.dof(), second.dof()));
  }
  Comparison result;
  std::vector<int> order = match_joints(first, second, result.by_name);
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (first.joints[i].type == second.joints[i].type) continue;
    return fail(Errc::impossible, text(msg::against_other_kinds, first.joints[i].name));
  }
  const Worst worst = measure(first, second, order, options);
  result.position = result.position_left = worst.position;
  result.rotation = result.rotation_left = worst.rotation;
  result.q = worst.position > 1e-9 ? worst.q_position : worst.q_rotation;
  const double size = std::max(worst.position, worst.rotation);
  if (size < 1e-9) return result;

  std::vector<Cause> always;
  if (!in_order(order)) {
    always.push_back({.code = CauseCode::joint_order});
    std::sort(order.begin(), order.end());
  }
  const CauseTolerance tolerance{std::clamp(1e-3 * size, 1e-10, 1e-7)};
  std::vector<std::vector<Cause>> candidates = explain_by_screws(first, second, tolerance);
  candidates.insert(candidates.begin(), explain_as_written(first, second, tolerance));
  int fewest = 1 << 20;
  for (std::vector<Cause>& causes : candidates) {
    const int parts = size_of(causes, tolerance.value);
    const Worst left = measure(with_causes(first, causes), second, order, options);
    const bool explains = std::max(left.position, left.rotation) < std::max(1e-3 * size, 1e-9);
    if (!explains || parts >= fewest) continue;
    fewest = parts;
    result.causes = always;
    result.causes.insert(result.causes.end(), causes.begin(), causes.end());
    result.position_left = left.position;
    result.rotation_left = left.rotation;
  }
  return result;
}

}  // namespace mjarm
