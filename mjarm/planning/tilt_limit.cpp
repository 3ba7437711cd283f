#include "mjarm/planning/tilt_limit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "mjarm/kinematics/chain.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/planning/search_internal.hpp"
#include "mjarm/planning/tilt_keeper_internal.hpp"

namespace mjarm {
namespace detail {
namespace {

constexpr double kInner = 0.3;       // share of the limit that is aimed at
constexpr int kMaxSteps = 16;        // of Newton's method,
constexpr double kMaxTurn = 0.5;     // [rad] each
constexpr double kDamping = 1e-6;    // of its normal equations
constexpr double kParallel = 1e-12;  // |a x b| of axes that are one
constexpr int kMaxParts = 4096;      // of an edge that are looked at
constexpr double kFinest = 1e-4;     // [rad] L: narrower parts of an edge are not cut again
constexpr double kLeastWay = 0.1;    // share of a step by which the end must come nearer
constexpr double kMaxWay = 2;        // a step that is put back may be so many times as long
constexpr double kRounding = 1e-8;   // share of the limit

}  // namespace

TiltKeeper::TiltKeeper(const TiltLimit& limit, const Arm& arm)
    : chain_(Chain(arm)),
      limits_(arm.limits),
      limit_(limit),
      max_sine_(std::sin(limit.max)),
      last_(arm.dof()) {
  const Eigen::Vector3d e = limit.axis_W.unitOrthogonal();
  across_.row(0) = e;
  across_.row(1) = limit.axis_W.cross(e);
  leave_out_turns(arm);
}

/// Turns about the axis of the world before all others, and about the tool's own after all others,
/// do not change the tilt.
void TiltKeeper::leave_out_turns(const Arm& arm) {
  const auto dof = static_cast<std::size_t>(arm.dof());
  std::array<Pose, kMaxDof> X_WJ;
  const JointVec zero = JointVec::Zero(arm.dof());
  const Pose X_WT = fk_all(arm, mjarm::as_span(zero), X_WJ);
  std::array<Eigen::Vector3d, kMaxDof> axis_W;
  for (std::size_t k = 0; k < dof; ++k) {
    turns_[k] = arm.joints[k].type == JointType::hinge;
    axis_W[k] = X_WJ[k].R * arm.joints[k].axis;
  }
  const auto idle = [&](int k, const Eigen::Vector3d& axis) {
    const auto joint = static_cast<std::size_t>(k);
    return !turns_[joint] || axis_W[joint].cross(axis).norm() < kParallel;
  };
  while (first_ < last_ && idle(first_, limit_.axis_W)) ++first_;
  while (last_ > first_ && idle(last_ - 1, X_WT.R * limit_.axis_T)) --last_;
}

TiltKeeper::Lean TiltKeeper::lean(std::span<const double> q) const {
  const Eigen::Vector3d u = fk(chain_, q).R * limit_.axis_T;
  return {across_ * u, limit_.axis_W.dot(u)};
}

bool TiltKeeper::keeps(const Lean& lean) const {
  return lean.along > 0 && lean.across.norm() <= max_sine_ * (1 + kRounding);
}

bool TiltKeeper::keeps(std::span<const double> q) const { return keeps(lean(q)); }

bool TiltKeeper::project(std::span<double> q) const {
  for (int step = 0; step < kMaxSteps; ++step) {
    const FkJacobian at = fk_jacobian(chain_, q);
    const Eigen::Vector3d u = at.X_WT.R * limit_.axis_T;
    // The turn that would put u upright is about an axis across u, as are all that change it.
    const Eigen::Vector3d way = u.cross(limit_.axis_W);
    const double sine = way.norm(), angle = std::atan2(sine, limit_.axis_W.dot(u));
    if (angle <= kInner * limit_.max) return true;
    const Eigen::Vector3d e1 = sine > kParallel ? Eigen::Vector3d(way / sine) : u.unitOrthogonal();
    Eigen::Matrix<double, 2, 3> across;
    across << e1.transpose(), u.cross(e1).transpose();
    const Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, kMaxDof> J =
        across * at.J_W.bottomRows<3>();
    const Eigen::Matrix2d A = J * J.transpose() + kDamping * Eigen::Matrix2d::Identity();
    const Eigen::Vector2d turn(std::min(angle - 0.5 * kInner * limit_.max, kMaxTurn), 0);
    const JointVec move = J.transpose() * A.inverse() * turn;
    for (int k = 0; k < chain_.dof; ++k) {
      double& value = q[static_cast<std::size_t>(k)];
      value = std::clamp(value + move[k], limits_.lower[k], limits_.upper[k]);
    }
  }
  return false;
}

std::optional<double> TiltKeeper::step(std::span<const double> from, std::span<const double> to,
                                       double range, std::span<double> out) const {
  const double left = distance(from, to);
  between(from, to, range / left, out);
  if (!project(out)) return std::nullopt;
  const double length = distance(from, out);
  const bool nearer = distance(out, to) < left - kLeastWay * range;
  if (!nearer || length > kMaxWay * range) return std::nullopt;
  return length;
}

TiltKeeper::EdgeTilt TiltKeeper::look(std::span<const double> q0,
                                      std::span<const double> q1) const {
  double whole = 0;
  for (int k = first_; k < last_; ++k) {
    const auto joint = static_cast<std::size_t>(k);
    if (turns_[joint]) whole += std::abs(q1[joint] - q0[joint]);
  }
  EdgeTilt out;
  double done = 0, part = 1, sine = 0;
  Lean from = lean(q0);
  if (!keeps(from)) return out;
  std::array<double, kMaxDof> row;
  const std::span<double> q(row.data(), q0.size());
  // From the left, each part as wide as it can be proved, at most twice the one before.
  for (int parts = 0; done < 1; ++parts) {
    const double end = std::min(1.0, done + part);
    between(q0, q1, end, q);
    const Lean to = lean(end < 1 ? q : q1);
    const double L = whole * (end - done), bulge = L * L / 8;
    const double max = std::max(from.across.norm(), to.across.norm()) + bulge;
    if (std::min(from.along, to.along) > bulge && max <= max_sine_ * (1 + kRounding)) {
      sine = std::max(sine, max);
      done = end;
      from = to;
      part *= 2;
    } else if (L > kFinest && parts < kMaxParts) {
      part = 0.5 * (end - done);
    } else {
      out.t = done;
      return out;
    }
  }
  out.kept = true;
  out.largest = std::asin(std::min(sine, 1.0));
  return out;
}

}  // namespace detail

bool is_sound(const TiltLimit& limit) noexcept {
  const auto is_unit = [](const Eigen::Vector3d& v) { return std::abs(v.norm() - 1) < 1e-9; };
  return limit.max >= kLeastTilt && limit.max < std::numbers::pi / 2 && is_unit(limit.axis_T) &&
         is_unit(limit.axis_W);
}

TiltLimit keep_upright(const Arm& arm, std::span<const double> q, double max) {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  return {max, (fk(arm, q).R.transpose() * up).normalized(), up};
}

double tilt(const TiltLimit& limit, const Arm& arm, std::span<const double> q) {
  const Eigen::Vector3d u = fk(arm, q).R * limit.axis_T;
  return std::atan2(u.cross(limit.axis_W).norm(), u.dot(limit.axis_W));
}

}  // namespace mjarm
