#include "mjarm/kinematics/manipulability_ellipsoid.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "mjarm/core/linear_algebra.hpp"
#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm {
namespace {

/// J J^T of the tool's position by central differences of the forward kinematics.
Eigen::Matrix3d differenced(const Arm& arm, const JointVec& q) {
  constexpr double kStep = 1e-5;
  Eigen::Matrix3d JJt = Eigen::Matrix3d::Zero();
  for (int j = 0; j < arm.dof(); ++j) {
    JointVec ahead = q;
    JointVec behind = q;
    ahead[j] += kStep;
    behind[j] -= kStep;
    const Eigen::Vector3d column =
        (fk(arm, as_span(ahead)).p - fk(arm, as_span(behind)).p) / (2 * kStep);
    JJt += column * column.transpose();
  }
  return JJt;
}

TEST(ManipulabilityEllipsoid, IsTheEigenDecompositionOfJJt) {
  for (const Arm& arm : {testing::ur5e(), testing::panda()}) {
    Rng rng(71);
    for (int i = 0; i < 300; ++i) {
      const JointVec q = testing::random_q(arm, rng);
      const VelocityEllipsoid found = manipulability_ellipsoid(arm, as_span(q));
      const Eigen::Matrix3d JJt = differenced(arm, q);
      const Eigen::Vector3d values = symmetric_eigen(JJt).values;
      EXPECT_LT((found.semi_axes.cwiseAbs2().reverse() - values).norm(), 1e-8);
      EXPECT_LT(
          (found.R_WE * found.semi_axes.cwiseAbs2().asDiagonal() * found.R_WE.transpose() - JJt)
              .norm(),
          1e-8);
      EXPECT_LT((found.R_WE.transpose() * found.R_WE - Eigen::Matrix3d::Identity()).norm(), 1e-12);
      EXPECT_NEAR(found.R_WE.determinant(), 1, 1e-12);
      EXPECT_GE(found.semi_axes[0], found.semi_axes[1]);
      EXPECT_GE(found.semi_axes[1], found.semi_axes[2]);
    }
  }
}

/// One hinge about z, its tool 0.5 m out along x: it can go along y only.
TEST(ManipulabilityEllipsoid, IsFlatWhereTheToolCannotGo) {
  Pose X_JT;
  X_JT.p = {0.5, 0, 0};
  const Arm arm =
      testing::make_arm("one", {{{0, 0, 0}, {0, 0, 0}, Eigen::Vector3d::UnitZ(), -3, 3}}, X_JT);
  const VelocityEllipsoid found = manipulability_ellipsoid(arm, std::vector<double>{0.0});
  EXPECT_NEAR(found.semi_axes[0], 0.5, 1e-12);
  EXPECT_NEAR(found.semi_axes[1], 0, 1e-12);
  EXPECT_NEAR(found.semi_axes[2], 0, 1e-12);
  EXPECT_NEAR(std::abs(found.R_WE(1, 0)), 1, 1e-12);
  EXPECT_NEAR(found.R_WE.determinant(), 1, 1e-12);
}

/// The elbow stretched: with the wrist on the line too, nothing moves the tool along the arm.
TEST(ManipulabilityEllipsoid, LosesADirectionAtASingularity) {
  Pose X_JT;
  X_JT.p = {0.4, 0, 0};
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  const Arm arm = testing::make_arm("three",
                                    {{{0, 0, 0}, {0, 0, 0}, z, -3, 3},
                                     {{0, 0, 0}, {0, 0, 0}, y, -3, 3},
                                     {{0.5, 0, 0}, {0, 0, 0}, y, -3, 3}},
                                    X_JT);
  const VelocityEllipsoid stretched =
      manipulability_ellipsoid(arm, std::vector<double>{0.3, 0.2, 0.0});
  EXPECT_LT(stretched.semi_axes[2], 1e-12);
  const Eigen::Vector3d along = fk(arm, std::vector<double>{0.3, 0.2, 0.0}).p.normalized();
  EXPECT_NEAR(std::abs(stretched.R_WE.col(2).dot(along)), 1, 1e-9);
  const VelocityEllipsoid bent = manipulability_ellipsoid(arm, std::vector<double>{0.3, 0.2, 1.0});
  EXPECT_GT(bent.semi_axes[2], 0.1);
}

}  // namespace
}  // namespace mjarm
