// What rotations must keep whatever they are: group laws, metrics, derivatives, ends of the range.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "tests/support/constants.hpp"

namespace mjarm {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d random_axis(Rng& rng) {
  return Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
}

Matrix3d random_rotation(Rng& rng) {
  return rotation_exp(rng.uniform(0, support::kPi) * random_axis(rng));
}

double gap(const Matrix3d& A, const Matrix3d& B) { return (A - B).cwiseAbs().maxCoeff(); }

/// [w]_x, so that [w]_x p = w x p.
Matrix3d skew(const Vector3d& w) {
  Matrix3d W;
  for (int i = 0; i < 3; ++i) W.col(i) = w.cross(Vector3d::Unit(i));
  return W;
}

TEST(RotationProperties, TheVectorComesBackForEveryAngleBelowHalfATurn) {
  Rng rng(21);
  for (int i = 0; i < 2000; ++i) {
    // Small angles as often as large ones.
    const double angle = i % 2 == 0 ? rng.uniform(0, support::kPi - 1e-6)
                                    : std::ldexp(1.0, -static_cast<int>(rng.below(60)));
    const Vector3d w = angle * random_axis(rng);
    ASSERT_LT((rotation_log(rotation_exp(w)) - w).norm(), 4e-15 * (1 + angle)) << angle;
  }
}

TEST(RotationProperties, WholeTurnsMoreAreTheSameRotation) {
  Rng rng(22);
  for (int i = 0; i < 500; ++i) {
    const Vector3d axis = random_axis(rng);
    const double angle = rng.uniform(-support::kPi, support::kPi);
    const Matrix3d R = rotation_exp(angle * axis);
    for (const int turns : {-3, -1, 1, 3}) {
      ASSERT_LT(gap(rotation_exp((angle + 2 * support::kPi * turns) * axis), R), 5e-15 * 10);
    }
    ASSERT_LE(rotation_log(R).norm(), support::kPi + 1e-15);
  }
}

TEST(RotationProperties, TurnsAboutOneAxisAddAndTurnedAxesTurnWithTheFrame) {
  Rng rng(23);
  for (int i = 0; i < 1000; ++i) {
    const Vector3d axis = random_axis(rng);
    const double a = rng.uniform(-3, 3), b = rng.uniform(-3, 3);
    ASSERT_LT(gap(rotation_exp(a * axis) * rotation_exp(b * axis), rotation_exp((a + b) * axis)),
              1e-14);
    const Matrix3d R = random_rotation(rng);
    ASSERT_LT(gap(R * rotation_exp(a * axis) * R.transpose(), rotation_exp(a * (R * axis))), 1e-14);
    ASSERT_LT(gap(rotation_exp(-a * axis), rotation_exp(a * axis).transpose()), 1e-15);
  }
}

TEST(RotationProperties, TheDerivativeOfTheExponentialIsItsAngularVelocity) {
  Rng rng(24);
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 200; ++i) {
    const Vector3d w = rng.uniform(0.01, 3) * random_axis(rng);
    const double t = rng.uniform(-1, 1);
    const Matrix3d slope =
        (rotation_exp((t + kStep) * w) - rotation_exp((t - kStep) * w)) / (2 * kStep);
    ASSERT_LT(gap(slope, skew(w) * rotation_exp(t * w)), 1e-8);
  }
}

TEST(RotationProperties, AnglesAreAMetricThatNoTurnOfBothChanges) {
  Rng rng(25);
  for (int i = 0; i < 1000; ++i) {
    const Matrix3d A = random_rotation(rng), B = random_rotation(rng), C = random_rotation(rng);
    const double angle = angle_between(A, B);
    ASSERT_EQ(angle_between(A, A) < 1e-7, true);
    ASSERT_GE(angle, 0);
    ASSERT_LE(angle, support::kPi);
    ASSERT_NEAR(angle, angle_between(B, A), 1e-14);
    ASSERT_LE(angle, angle_between(A, C) + angle_between(C, B) + 1e-14);
    ASSERT_NEAR(angle, angle_between(C * A, C * B), 2e-14);
    ASSERT_NEAR(angle, angle_between(A * C, B * C), 2e-14);
    // trace R = 1 + 2 cos angle.
    ASSERT_NEAR((A.transpose() * B).trace(), 1 + 2 * std::cos(angle), 1e-14);
  }
}

TEST(RotationProperties, QuaternionsMultiplyAsMatricesDoAndTheirLengthDoesNotMatter) {
  Rng rng(26);
  for (int i = 0; i < 1000; ++i) {
    const Quat a = to_quat(random_rotation(rng)), b = to_quat(random_rotation(rng));
    ASSERT_LT(gap(to_matrix(a * b), to_matrix(a) * to_matrix(b)), 1e-14);
    const double length = std::ldexp(1.0, static_cast<int>(rng.below(200)) - 100);
    const Quat scaled(length * a.w(), length * a.x(), length * a.y(), length * a.z());
    ASSERT_LT(gap(to_matrix(scaled), to_matrix(a)), 1e-15);
    const Quat turned(-a.w(), -a.x(), -a.y(), -a.z());
    ASSERT_EQ(to_matrix(turned), to_matrix(a));
    ASSERT_NEAR(to_quat(to_matrix(a)).norm(), 1, 1e-15);
  }
}

TEST(RotationProperties, EulerAnglesAreThreeTurnsAboutFixedAxesInTheirOrder) {
  Rng rng(27);
  for (int i = 0; i < 1000; ++i) {
    const Vector3d e(rng.uniform(-7, 7), rng.uniform(-7, 7), rng.uniform(-7, 7));
    const Matrix3d turns = rotation_exp(e.z() * Vector3d::UnitZ()) *
                           rotation_exp(e.y() * Vector3d::UnitY()) *
                           rotation_exp(e.x() * Vector3d::UnitX());
    ASSERT_LT(gap(from_euler(e), turns), 3e-15);
    const Vector3d back = to_euler(turns);
    ASSERT_LE(std::abs(back.x()), support::kPi);
    ASSERT_LE(std::abs(back.y()), support::kPi / 2);
    ASSERT_LE(std::abs(back.z()), support::kPi);
    // The other name of the same rotation.
    const Vector3d other(back.x() + support::kPi, support::kPi - back.y(), back.z() + support::kPi);
    ASSERT_LT(gap(from_euler(other), turns), 1e-14);
  }
}

TEST(RotationProperties, SlerpEndsWhereItShouldAndTakesAWayAtHalfATurn) {
  Rng rng(28);
  for (int i = 0; i < 500; ++i) {
    const Matrix3d A = random_rotation(rng);
    const Vector3d axis = random_axis(rng);
    for (const double angle : {0.0, 1e-12, 1e-7, 1.0, 3.0, support::kPi}) {
      const Matrix3d B = A * rotation_exp(angle * axis);
      const Quat a = to_quat(A), b = to_quat(B);
      ASSERT_LT(gap(to_matrix(slerp(a, b, 0)), A), 1e-14) << angle;
      ASSERT_LT(gap(to_matrix(slerp(a, b, 1)), B), 1e-14) << angle;
      const Matrix3d middle = to_matrix(slerp(a, b, 0.5));
      ASSERT_TRUE(middle.allFinite()) << angle;
      ASSERT_NEAR(angle_between(A, middle), angle / 2, 1e-7) << angle;
      ASSERT_NEAR(angle_between(middle, B), angle / 2, 1e-7) << angle;
    }
  }
}

TEST(RotationProperties, AWayBetweenPosesIsTheSameBackwardsAndMovesWithItsFrame) {
  Rng rng(29);
  const auto pose = [&rng] {
    return Pose{{rng.normal(), rng.normal(), rng.normal()}, random_rotation(rng)};
  };
  for (int i = 0; i < 500; ++i) {
    const Pose X0 = pose(), X1 = pose(), X_WF = pose();
    const double t = rng.uniform();
    const Pose there = interpolate(X0, X1, t), back = interpolate(X1, X0, 1 - t);
    ASSERT_LT((there.p - back.p).norm(), 1e-14);
    ASSERT_LT(gap(there.R, back.R), 1e-13);
    const Pose seen = interpolate(X_WF * X0, X_WF * X1, t), moved = X_WF * there;
    ASSERT_LT((seen.p - moved.p).norm(), 1e-14);
    ASSERT_LT(gap(seen.R, moved.R), 1e-13);
  }
}

}  // namespace
}  // namespace mjarm
