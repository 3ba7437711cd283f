#pragma once

#include <gtest/gtest.h>

#include <span>
#include <vector>

#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/path/solve_path.hpp"

namespace mjarm::testing {

/// A posture of the UR5e in front of its base, with the tool down.
inline const std::vector<double> kSeed{-1.57, -1.34, 2.65, -1.3, 1.55, 0};

inline Eigen::Vector3d random_vec(Rng& rng, double size) {
  return {rng.uniform(-size, size), rng.uniform(-size, size), rng.uniform(-size, size)};
}

inline Pose at_point(double x, double y, double z) {
  return {Eigen::Vector3d(x, y, z), Eigen::Matrix3d::Identity()};
}

/// A posture for every pose, within the limits and without a leap.
inline void expect_on_poses(const Arm& arm, const JointPath& path, std::span<const Pose> poses,
                            double rot_tol = 1e-6) {
  ASSERT_EQ(path.q.size(), poses.size());
  ASSERT_EQ(path.s.size(), poses.size());
  EXPECT_LE(path.max_step(), 0.5);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Pose X = fk(arm, as_span(path.q[i]));
    EXPECT_LT((X.p - poses[i].p).norm(), 1e-6);
    EXPECT_LT(angle_between(X.R, poses[i].R), rot_tol);
    EXPECT_TRUE(within_limits(arm, as_span(path.q[i])));
  }
}

}  // namespace mjarm::testing
