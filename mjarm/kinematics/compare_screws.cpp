#include <cmath>
#include <numbers>
#include <optional>

#include "mjarm/core/linear_algebra.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/compare_internal.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The line in the world about or along which a joint moves when all joints are at zero.
struct Screw {
  Vector3d p;  ///< [m] the origin of the joint's frame
  Vector3d w;  ///< unit
  bool slide;  ///< then the point does not matter
};

/// Poses of all joint frames at zero, and of the tool.
struct ZeroPose {
  std::vector<Pose> X_WJ;
  std::vector<Screw> screws;
  Pose X_WT;

  explicit ZeroPose(const Arm& arm) : X_WJ(arm.joints.size()) {
    const JointVec zero = JointVec::Zero(arm.dof());
    X_WT = fk_all(arm, as_span(zero), X_WJ);
    for (std::size_t i = 0; i < X_WJ.size(); ++i) {
      screws.push_back(
          {X_WJ[i].p, X_WJ[i].R * arm.joints[i].axis, arm.joints[i].type == JointType::slide});
    }
  }
};

/// How far `to` lies from `from`, square to its direction.
Vector3d gap(const Screw& from, const Screw& to) {
  if (from.slide) return Vector3d::Zero();
  const Vector3d d = to.p - from.p;
  return d - to.w * to.w.dot(d);
}

bool same(const Screw& a, const Screw& b, double tolerance) {
  return (a.w - b.w).norm() < tolerance && gap(a, b).norm() < tolerance;
}

Screw moved(const Pose& X, const Screw& screw) { return {X * screw.p, X.R * screw.w, screw.slide}; }

Pose about_line(const Screw& line, double angle) {
  const Matrix3d R = rotation_exp(angle * line.w);
  return {line.p - R * line.p, R};
}

/// Angle about the unit vector `w` from `from` to `to`, both seen along `w`; none where either has
/// no length there.
std::optional<double> angle_about(const Vector3d& w, const Vector3d& from, const Vector3d& to) {
  const Vector3d a = from - w * w.dot(from);
  const Vector3d b = to - w * w.dot(to);
  if (a.norm() < 1e-6 || b.norm() < 1e-6) return std::nullopt;
  return std::atan2(w.dot(a.cross(b)), a.dot(b));
}

/// The zero offset of `joint` that brings `from` onto `to`, if there is one.
std::optional<double> zero_offset(const Screw& joint, const Screw& from, const Screw& to,
                                  double tolerance) {
  if (joint.slide) {
    const Vector3d along = joint.w - to.w * to.w.dot(joint.w);
    if (along.norm() < 1e-6) return std::nullopt;
    const double offset = along.dot(gap(from, to)) / along.squaredNorm();
    const Screw shifted{from.p + offset * joint.w, from.w, from.slide};
    return same(shifted, to, tolerance) ? std::optional(offset) : std::nullopt;
  }
  std::optional<double> angle = angle_about(joint.w, from.w, to.w);
  if (!angle) angle = angle_about(joint.w, from.p - joint.p, to.p - joint.p);
  if (!angle || !same(moved(about_line(joint, *angle), from), to, tolerance)) return std::nullopt;
  return angle;
}

Cause base_cause(const Pose& X) {
  return {.code = CauseCode::base, .shift = X.p, .turn = rotation_log(X.R)};
}

/// Finds, joint after joint from the base, what brings the screws of the first arm onto those of
/// the second.
class ScrewWalk {
 public:
  ScrewWalk(const Arm& first, const Arm& second, double tolerance)
      : arm_(first), target_(second), tolerance_(tolerance) {}

  std::vector<Cause> run(const Pose& X_base) {
    const bool stays = X_base.p.norm() < tolerance_ && rotation_log(X_base.R).norm() < tolerance_;
    if (!stays) add(base_cause(X_base));
    for (int i = 0; i < arm_.dof(); ++i) mend(i);
    return causes_;
  }

 private:
  void add(Cause cause) {
    arm_ = with_causes(arm_, {cause});
    if (cause.code == CauseCode::base && !causes_.empty() &&
        causes_.front().code == CauseCode::base) {
      const Cause& old = causes_.front();
      const Pose X =
          Pose{cause.shift, rotation_exp(cause.turn)} * Pose{old.shift, rotation_exp(old.turn)};
      causes_.front() = base_cause(X);
    } else if (cause.code == CauseCode::base) {
      causes_.insert(causes_.begin(), std::move(cause));
    } else {
      causes_.push_back(std::move(cause));
    }
  }

  static Screw reversed(Screw screw) {
    screw.w = -screw.w;
    return screw;
  }

  void mend(int i) {
    const ZeroPose now(arm_);
    const Screw from = now.screws[static_cast<std::size_t>(i)];
    const Screw to = target_.screws[static_cast<std::size_t>(i)];
    if (same(from, to, tolerance_)) return;
    const Cause sign{.code = CauseCode::joint_sign, .joint = i};
    if (same(reversed(from), to, tolerance_)) return add(sign);
    for (const bool flip : {false, true}) {
      if (i == 0) break;
      const Screw before = now.screws[static_cast<std::size_t>(i - 1)];
      const auto offset = zero_offset(before, flip ? reversed(from) : from, to, tolerance_);
      if (!offset) continue;
      add_offset(i - 1, before, *offset);
      if (flip) add(sign);
      return;
    }
    const bool flip = from.w.dot(to.w) < -0.7;
    place(i, now, flip ? reversed(from) : from, to);
    if (flip) add(sign);
  }

  /// The zero of the first joint cannot be told from a turned base: it is told as the latter.
  void add_offset(int joint, const Screw& screw, double offset) {
    if (joint > 0) {
      Cause cause{.code = CauseCode::zero_offset, .joint = joint};
      cause.offset = offset;
      return add(cause);
    }
    const Pose X =
        screw.slide ? Pose{offset * screw.w, Matrix3d::Identity()} : about_line(screw, offset);
    Cause cause = base_cause(X);
    const bool first_cause = causes_.empty() || causes_.front().code != CauseCode::base;
    add(cause);
    if (first_cause) causes_.front().same_as_zero_of = 0;
  }

  /// The smallest move of joint `i` on the link before it that brings its screw onto `to`.
  void place(int i, const ZeroPose& now, const Screw& from, const Screw& to) {
    const Matrix3d R = rotation_between(from.w, to.w);
    const Matrix3d R_WP =
        i == 0 ? Matrix3d::Identity() : now.X_WJ[static_cast<std::size_t>(i - 1)].R;
    const Vector3d shift = R_WP.transpose() * gap(from, to);
    const Vector3d turn = R_WP.transpose() * rotation_log(R);
    add({.code = CauseCode::link, .joint = i, .shift = shift, .turn = turn});
  }

  Arm arm_;  ///< the first arm with the causes so far
  ZeroPose target_;
  double tolerance_;
  std::vector<Cause> causes_;
};

/// A frame that two lines define: x along the first one, z square to both, the origin where they
/// come closest; none for parallel lines.
std::optional<Pose> frame_of(const Screw& a, const Screw& b) {
  const Vector3d z = a.w.cross(b.w);
  if (z.norm() < 1e-3 || a.slide || b.slide) return std::nullopt;
  const Vector3d n = z.normalized();
  const double along = (b.p - a.p).dot(b.w.cross(n)) / a.w.dot(b.w.cross(n));
  Pose X;
  X.p = a.p + along * a.w;
  X.R << a.w, n.cross(a.w), n;
  return X;
}

/// The base that brings the first two lines that are not parallel onto their partners.
std::optional<Pose> base_of_lines(const ZeroPose& first, const ZeroPose& second) {
  for (std::size_t i = 1; i < first.screws.size(); ++i) {
    const auto A = frame_of(first.screws[0], first.screws[i]);
    const auto B = frame_of(second.screws[0], second.screws[i]);
    if (A && B) return *B * A->inverse();
  }
  return std::nullopt;
}

/// The base X of X_B(q) = X X_A(q) Y, fitted in closed form: relative rotations of both tools are
/// the same in turned frames, which gives Y's rotation (Park and Martin); the rest is linear.
Pose fitted_base(const Arm& first, const Arm& second) {
  constexpr int kPoses = 40;
  Rng rng(7);
  std::vector<Pose> A(kPoses), B(kPoses);
  for (int k = 0; k < kPoses; ++k) {
    JointVec q(first.dof());
    for (double& value : q) value = rng.uniform(-1, 1);
    A[k] = fk(first, as_span(q));
    B[k] = fk(second, as_span(q));
  }
  Matrix3d H = Matrix3d::Zero();
  for (int k = 1; k < kPoses; ++k) {
    const Vector3d a = rotation_log(A[0].R.transpose() * A[k].R);
    const Vector3d b = rotation_log(B[0].R.transpose() * B[k].R);
    if (std::max(a.norm(), b.norm()) < 3) H += a * b.transpose();
  }
  const SingularValues svd = singular_values(H);
  const Matrix3d U = svd.U, V = svd.V;
  const double hand = (U * V.transpose()).determinant() < 0 ? -1 : 1;
  const Matrix3d R_Y = U * Vector3d(1, 1, hand).asDiagonal() * V.transpose();
  Pose X;
  X.R = B[0].R * (A[0].R * R_Y).transpose();
  Eigen::MatrixXd M(3 * kPoses, 6);
  Eigen::VectorXd rest(3 * kPoses);
  for (int k = 0; k < kPoses; ++k) {
    M.block<3, 3>(3 * k, 0) = X.R * A[k].R;
    M.block<3, 3>(3 * k, 3).setIdentity();
    rest.segment<3>(3 * k) = B[k].p - X.R * A[k].p;
  }
  X.p = least_squares(M, rest).tail<3>();
  return X;
}

}  // namespace

void add_tool(const Arm& first, const Arm& second, CauseTolerance tolerance,
              std::vector<Cause>& causes) {
  const ZeroPose now(with_causes(first, causes));
  const ZeroPose target(second);
  const Pose Y = now.X_WT.inverse() * target.X_WT;
  Cause tool{.code = CauseCode::tool, .shift = Y.p, .turn = rotation_log(Y.R)};
  if (tool.shift.norm() < tolerance.value && tool.turn.norm() < tolerance.value) return;
  const Screw& last = now.screws.back();
  const Pose X = target.X_WT * now.X_WT.inverse();
  const double angle = rotation_log(X.R).dot(last.w);
  const Pose turned = about_line(last, angle);
  const bool as_zero = !last.slide && (turned.p - X.p).norm() < tolerance.value &&
                       angle_between(turned.R, X.R) < tolerance.value;
  if (as_zero) tool.same_as_zero_of = first.dof() - 1;
  causes.push_back(std::move(tool));
}

std::vector<std::vector<Cause>> explain_by_screws(const Arm& first, const Arm& second,
                                                  CauseTolerance tolerance) {
  std::vector<Pose> bases = {fitted_base(first, second), Pose()};
  if (const auto base = base_of_lines(ZeroPose(first), ZeroPose(second))) bases.push_back(*base);
  std::vector<std::vector<Cause>> all;
  for (const Pose& X : bases) {
    std::vector<Cause> causes = ScrewWalk(first, second, tolerance.value).run(X);
    add_tool(first, second, tolerance, causes);
    all.push_back(std::move(causes));
  }
  return all;
}

}  // namespace mjarm
