// Poses of public arms, each from a random seed. The descriptions come from the package
// example-robot-data of PyPI; the environment variable MJARM_ARMS_DATA names the folder that holds
// its `example-robot-data`.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/model/find_arm.hpp"

namespace mjarm {
namespace {

struct PublicArm {
  const char* label;
  const char* file;
  const char* tip;  // the longest chain where empty
};

class PublicArms : public ::testing::TestWithParam<PublicArm> {};

JointVec random_q(const Arm& arm, Rng& rng) {
  JointVec q(arm.dof());
  for (int i = 0; i < arm.dof(); ++i) {
    q[i] = rng.uniform(arm.limits.lower[i], arm.limits.upper[i]);
  }
  return q;
}

/// How many of `count` poses are solved; every miss is listed with its reason.
int count_solved(const Arm& arm, const IkSolver& ik, int count) {
  Rng rng(61);
  int solved = 0;
  for (int i = 0; i < count; ++i) {
    const Pose X_goal = fk(arm, view(random_q(arm, rng)));
    const auto answer = ik.solve(X_goal, view(random_q(arm, rng)));
    if (!answer) {
      std::cout << arm.name << ", pose " << i << ": " << describe(answer.error(), arm) << '\n';
      continue;
    }
    ++solved;
    const Pose X = fk(arm, view(answer->q));
    EXPECT_LT((X.p - X_goal.p).norm(), 1.01e-7);
    EXPECT_LT(angle_between(X.R, X_goal.R), 1.01e-7);
    EXPECT_TRUE(within_limits(arm, view(answer->q)));
  }
  return solved;
}

TEST_P(PublicArms, PosesAreFoundAgain) {
  const char* data = std::getenv("MJARM_ARMS_DATA");
  if (data == nullptr || *data == '\0') {
    GTEST_SKIP() << "MJARM_ARMS_DATA is not set; it names the folder of the public arms";
  }
  const std::filesystem::path file =
      std::filesystem::path(data) / "example-robot-data/robots" / GetParam().file;
  ASSERT_TRUE(std::filesystem::exists(file)) << file;
  const auto model = Model::load(file);
  ASSERT_TRUE(model.has_value()) << model.error().what;
  const auto arm = find_arm(*model, {.tip = GetParam().tip});
  ASSERT_TRUE(arm.has_value()) << arm.error().what;
  EXPECT_GE(count_solved(*arm, IkSolver(*arm), 1000), 999);
  EXPECT_GE(count_solved(*arm, IkSolver(*arm, {.closed_form = false}), 1000), 999);
}

INSTANTIATE_TEST_SUITE_P(
    Public, PublicArms,
    ::testing::Values(PublicArm{"Ur5", "ur_description/urdf/ur5_robot.urdf", ""},
                      PublicArm{"XArm7", "xarm_description/urdf/xarm7.urdf", ""},
                      PublicArm{"So100", "so_arm_description/urdf/so100.urdf", ""},
                      PublicArm{"Z1", "z1_description/urdf/z1.urdf", ""}),
    [](const auto& arm) { return std::string(arm.param.label); });

}  // namespace
}  // namespace mjarm
