#include "mjarm/core/rotation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mjarm/core/rng.hpp"
#include "tests/support/constants.hpp"
#include "tests/support/test_data.hpp"

namespace mjarm {
namespace {

using support::kPi;

double entry_of(const nlohmann::json& list, int i) {
  return list.at(static_cast<std::size_t>(i)).get<double>();
}
Eigen::Vector3d vector(const nlohmann::json& list) {
  return {entry_of(list, 0), entry_of(list, 1), entry_of(list, 2)};
}
Eigen::Matrix3d matrix(const nlohmann::json& rows) {
  Eigen::Matrix3d R;
  for (int i = 0; i < 3; ++i) R.row(i) = vector(rows.at(static_cast<std::size_t>(i)));
  return R;
}
Quat quat(const nlohmann::json& wxyz) {
  return {entry_of(wxyz, 0), entry_of(wxyz, 1), entry_of(wxyz, 2), entry_of(wxyz, 3)};
}

double distance(const Eigen::Matrix3d& A, const Eigen::Matrix3d& B) {
  return (A - B).cwiseAbs().maxCoeff();
}
double distance(const Quat& a, const Quat& b) {
  return std::min((a.coeffs() - b.coeffs()).cwiseAbs().maxCoeff(),
                  (a.coeffs() + b.coeffs()).cwiseAbs().maxCoeff());
}

Quat random_quat(Rng& rng) {
  return Quat(rng.normal(), rng.normal(), rng.normal(), rng.normal()).normalized();
}

/// Rotation about a unit axis by Rodrigues' formula in another form: cos I + sin [u] + (1-cos) u
/// u^T.
Eigen::Matrix3d about(const Eigen::Vector3d& axis, double angle) {
  Eigen::Matrix3d U;
  U << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  return std::cos(angle) * Eigen::Matrix3d::Identity() + std::sin(angle) * U +
         (1 - std::cos(angle)) * axis * axis.transpose();
}

TEST(Rotation, ConversionsMatchGroundTruth) {
  MJARM_TEST_FILE(file, "ground_truth/rotations.json.gz");
  const nlohmann::json data = support::load_json(file);
  int random = 0, gimbal = 0;
  for (const auto& entry : data.at("cases")) {
    const Eigen::Vector3d euler = vector(entry.at("euler"));
    SCOPED_TRACE(::testing::Message() << euler.transpose());
    const Eigen::Matrix3d R = matrix(entry.at("mat_xyz_extrinsic"));
    const Quat q = quat(entry.at("quat_xyz_extrinsic"));
    EXPECT_LT(distance(from_euler(euler), R), 1e-12);
    EXPECT_LT(distance(to_quat(R), q), 1e-12);
    EXPECT_LT(distance(to_matrix(q), R), 1e-12);
    EXPECT_LT(distance(to_quat(matrix(entry.at("t3_sxyz_mat"))), q), 1e-12);
    EXPECT_LT(distance(to_quat(from_euler(euler)), quat(entry.at("mju_XYZ_quat"))), 1e-12);
    EXPECT_LT(distance(rotation_exp(vector(entry.at("rotvec"))), R), 1e-12);
    EXPECT_LT(distance(rotation_exp(rotation_log(R)), R), 1e-12);
    EXPECT_LT(distance(from_euler(to_euler(R)), R), 1e-12);
    // Angles about moving axes are the inverse of the negative angles about fixed ones.
    const Eigen::Matrix3d intrinsic = matrix(entry.at("mat_xyz_intrinsic"));
    EXPECT_LT(distance(from_euler({-euler.x(), -euler.y(), -euler.z()}).transpose(), intrinsic),
              1e-12);
    if (entry.at("tag") == "random") {
      ++random;
      EXPECT_LT((to_euler(R) - vector(entry.at("back_xyz_extrinsic"))).norm(), 1e-12);
    }
    gimbal += entry.at("tag") == "gimbal";
  }
  EXPECT_GE(random, 100);
  EXPECT_GE(gimbal, 12);
}

TEST(Rotation, SlerpMatchesGroundTruth) {
  MJARM_TEST_FILE(file, "ground_truth/slerp.json.gz");
  const nlohmann::json data = support::load_json(file);
  ASSERT_GE(data.at("cases").size(), 25u);
  for (const auto& entry : data.at("cases")) {
    const double angle = entry.at("angle_deg");
    SCOPED_TRACE(::testing::Message() << entry.at("kind") << " " << angle << " degrees");
    const Quat q0 = quat(entry.at("q0")), q1 = quat(entry.at("q1"));
    const double from_half_turn = 180 - angle;
    for (std::size_t i = 0; i < entry.at("t").size(); ++i) {
      const double t = entry.at("t")[i];
      const Quat q = slerp(q0, q1, t);
      EXPECT_NEAR(q.norm(), 1, 1e-15);
      if (from_half_turn > 1e-9) {
        const double tolerance = from_half_turn < 1e-3 ? 1e-6 : 1e-9;
        EXPECT_LT(distance(q, quat(entry.at("quats")[i])), tolerance) << "t " << t;
        EXPECT_LT(distance(to_matrix(q), matrix(entry.at("mats")[i])), 2 * tolerance) << "t " << t;
      }
      // Constant speed from q0 to q1, whichever way was taken.
      const Eigen::Matrix3d R = to_matrix(q);
      EXPECT_NEAR(angle_between(to_matrix(q0), R), t * angle * kPi / 180, 1e-9);
      EXPECT_NEAR(angle_between(R, to_matrix(q1)), (1 - t) * angle * kPi / 180, 1e-9);
    }
  }
}

TEST(Rotation, RandomRoundTrips) {
  Rng rng(1);
  for (int i = 0; i < 20000; ++i) {
    const Quat q = random_quat(rng);
    const Eigen::Matrix3d R = to_matrix(q);
    ASSERT_LT(distance(R * R.transpose(), Eigen::Matrix3d::Identity()), 1e-15 * 4);
    ASSERT_NEAR(R.determinant(), 1, 1e-14);
    const Quat back = to_quat(R);
    ASSERT_LT(distance(back, q), 1e-15 * 4);
    ASSERT_GE(back.w(), 0);
    ASSERT_LT(distance(from_euler(to_euler(R)), R), 1e-14);
    ASSERT_LE(std::abs(to_euler(R).y()), kPi / 2);
    ASSERT_LT(distance(rotation_exp(rotation_log(R)), R), 1e-14);
  }
}

TEST(Rotation, LogIsExactForTinyAnglesAndNearHalfATurn) {
  Rng rng(2);
  const double angles[] = {1e-12, 1e-9,       1e-6,       1e-4,       0.99e-4,     1.01e-4, 1e-2,
                           3.0,   kPi - 1e-4, kPi - 1e-7, kPi - 1e-9, kPi - 1e-12, kPi};
  for (const double angle : angles) {
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector3d axis =
          Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
      const Eigen::Matrix3d R = about(axis, angle);
      const Eigen::Vector3d w = rotation_log(R);
      // At half a turn both directions of the axis are right.
      const double error = std::min((w - angle * axis).norm(), (w + angle * axis).norm());
      ASSERT_LT(error, 2e-15 + 2e-15 * angle) << angle;
      ASSERT_LT(distance(rotation_exp(angle * axis), R), 1e-15) << angle;
      ASSERT_NEAR(angle_between(Eigen::Matrix3d::Identity(), R), angle, 2e-15) << angle;
    }
  }
  EXPECT_EQ(rotation_log(Eigen::Matrix3d::Identity()), Eigen::Vector3d::Zero());
}

TEST(Rotation, QuaternionOfExactHalfTurns) {
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Matrix3d R = -Eigen::Matrix3d::Identity();
    R(axis, axis) = 1;
    const Quat q = to_quat(R);
    EXPECT_EQ(q.w(), 0);
    EXPECT_EQ(q.vec()(axis), 1);  // first non-zero component is positive
    EXPECT_NEAR(rotation_log(R).norm(), kPi, 1e-15);
  }
}

TEST(Rotation, TurnsOneDirectionToTheOtherByTheSmallestAngle) {
  Rng rng(9);
  for (int i = 0; i < 1000; ++i) {
    Eigen::Vector3d from(rng.normal(), rng.normal(), rng.normal()), to = -from;
    if (i % 4 == 0) to = from;
    if (i % 4 > 1) to += std::pow(10, rng.uniform(-15, 1)) * Eigen::Vector3d::Unit(i % 3);
    from.normalize();
    to.normalize();
    const Eigen::Matrix3d R = rotation_between(2 * from, rng.uniform(0.1, 3) * to);
    ASSERT_LT((R * from - to).norm(), 1e-11) << i;
    ASSERT_TRUE((R.transpose() * R).isIdentity(1e-12)) << i;
    const double angle = std::atan2(from.cross(to).norm(), from.dot(to));
    ASSERT_NEAR(rotation_log(R).norm(), angle, 1e-11) << i;
  }
}

TEST(Rotation, GimbalLockRebuildsTheMatrix) {
  Rng rng(3);
  for (const double sign : {-1.0, 1.0}) {
    for (const double off : {0.0, 1e-16, 1e-14, 1e-13, 1e-12, 1e-10, 1e-8, 1e-6, 1e-3}) {
      for (int i = 0; i < 100; ++i) {
        const Eigen::Matrix3d R =
            from_euler({rng.uniform(-kPi, kPi), sign * (kPi / 2 - off), rng.uniform(-kPi, kPi)});
        const Eigen::Vector3d euler = to_euler(R);
        ASSERT_LT(distance(from_euler(euler), R), 1e-12) << off;
        ASSERT_LE(std::abs(euler.y()), kPi / 2);
        if (off == 0) {
          ASSERT_EQ(euler.z(), 0);
        }
      }
    }
  }
}

TEST(Rotation, SlerpTakesTheShortWayAtConstantSpeed) {
  Rng rng(4);
  for (int i = 0; i < 2000; ++i) {
    const Quat q0 = random_quat(rng), q1 = random_quat(rng);
    const Eigen::Matrix3d R0 = to_matrix(q0), R1 = to_matrix(q1);
    const double t = rng.uniform(), angle = angle_between(R0, R1);
    const Quat q = slerp(q0, q1, t);
    ASSERT_NEAR(angle_between(R0, to_matrix(q)), t * angle, 1e-14);
    ASSERT_NEAR(angle_between(to_matrix(q), R1), (1 - t) * angle, 1e-14);
    // The path does not depend on signs, and reversed it is the same.
    ASSERT_LT(distance(slerp(q0, Quat(-q1.coeffs()), t), q), 1e-14);
    ASSERT_LT(distance(slerp(q1, q0, 1 - t), q), 1e-14);
  }
  const Quat q = random_quat(rng);
  EXPECT_LT(distance(slerp(q, q, 0.3), q), 1e-15);
}

TEST(Rotation, InterpolateMovesStraight) {
  Rng rng(5);
  const Pose X0{{1, 2, 3}, to_matrix(random_quat(rng))},
      X1{{-1, 0, 5}, to_matrix(random_quat(rng))};
  EXPECT_LT(distance(interpolate(X0, X1, 0).R, X0.R), 1e-15);
  EXPECT_LT(distance(interpolate(X0, X1, 1).R, X1.R), 1e-15);
  const Pose X = interpolate(X0, X1, 0.25);
  EXPECT_LT((X.p - Eigen::Vector3d(0.5, 1.5, 3.5)).norm(), 1e-15);
  EXPECT_NEAR(angle_between(X0.R, X.R), 0.25 * angle_between(X0.R, X1.R), 1e-14);
}

TEST(Pose, ComposesAndInverts) {
  Rng rng(6);
  for (int i = 0; i < 1000; ++i) {
    const Pose X_AB{{rng.normal(), rng.normal(), rng.normal()}, to_matrix(random_quat(rng))};
    const Pose X_BC{{rng.normal(), rng.normal(), rng.normal()}, to_matrix(random_quat(rng))};
    const Eigen::Vector3d p_C(rng.normal(), rng.normal(), rng.normal());
    ASSERT_LT(((X_AB * X_BC) * p_C - X_AB * (X_BC * p_C)).norm(), 1e-14);
    const Pose unit = X_AB * X_AB.inverse();
    ASSERT_LT(unit.p.norm(), 1e-14);
    ASSERT_LT(distance(unit.R, Eigen::Matrix3d::Identity()), 1e-14);
  }
}

}  // namespace
}  // namespace mjarm
