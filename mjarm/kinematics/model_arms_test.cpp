#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <array>
#include <memory>

#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/compare_test.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/model/find_arm.hpp"
#include "tests/support/test_data.hpp"

/// Kinematics of arms that come out of files, against MuJoCo.
namespace mjarm {
namespace {

struct Loaded {
  Model model;
  Arm arm;
};

Loaded load(const std::filesystem::path& file) {
  auto model = Model::load(file);
  EXPECT_TRUE(model.has_value()) << model.error().what;
  auto arm = find_arm(model.value());  // throws, and so fails the test, where there is none
  EXPECT_TRUE(arm.has_value()) << arm.error().what;
  return {model.value(), arm.value()};
}

/// Pose and Jacobian of a site by MuJoCo, row-major as MuJoCo has them.
void compare_with_mujoco(const Loaded& robot, Rng& rng) {
  const mjModel& m = *robot.model.raw();
  const Arm& arm = robot.arm;
  const int site = mj_name2id(&m, mjOBJ_SITE, arm.tip.c_str());
  ASSERT_GE(site, 0) << arm.tip;
  const std::unique_ptr<mjData, void (*)(mjData*)> d(mj_makeData(&m), mj_deleteData);
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Rows linear(3, m.nv), angular(3, m.nv);
  for (int round = 0; round < 1000; ++round) {
    const JointVec q = testing::random_q(arm, rng);
    for (int i = 0; i < arm.dof(); ++i) {
      d->qpos[arm.joints[static_cast<std::size_t>(i)].qpos] = q[i];
    }
    mj_kinematics(&m, d.get());
    mj_comPos(&m, d.get());
    mj_jacSite(&m, d.get(), linear.data(), angular.data(), site);
    const FkJacobian got = fk_jacobian(arm, as_span(q));
    const Eigen::Map<const Eigen::Vector3d> p(d->site_xpos + 3 * site);
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(d->site_xmat + 9 * site);
    EXPECT_LT((got.X_WT.p - p).norm(), 1e-12);
    EXPECT_LT((got.X_WT.R - R).norm(), 1e-12);
    for (int i = 0; i < arm.dof(); ++i) {
      const int dof = arm.joints[static_cast<std::size_t>(i)].dof;
      EXPECT_LT((got.J_W.col(i).head<3>() - linear.col(dof)).norm(), 1e-12);
      EXPECT_LT((got.J_W.col(i).tail<3>() - angular.col(dof)).norm(), 1e-12);
    }
  }
}

TEST(ModelArms, FkAndJacobianAreMujocosOnTheShippedArms) {
  Rng rng(91);
  for (const char* name : {"ur5e", "panda"}) {
    const auto file = find_model_file(name);
    ASSERT_TRUE(file.has_value()) << file.error().what;
    compare_with_mujoco(load(*file), rng);
  }
}

/// Where the shoulder is straight, joints 1 and 3 have nothing to keep but their sum, while the
/// last joint rests; where elbow and wrist stand at stops as well, nothing else is left to move.
TEST(ModelArms, AStraightShoulderOfThePandaIsReachedWithOtherJointsAtStops) {
  const Arm arm = load(find_model_file("panda").value()).arm;
  const IkSolver ik(arm);
  Rng rng(92);
  for (int round = 0; round < 400; ++round) {
    JointVec q = testing::random_q(arm, rng);
    q[1] = 0;
    for (const int i : {0, 2, 4, 6}) {
      const double side = rng.uniform();
      q[i] = side < 0.3 ? 0 : side < 0.65 ? arm.limits.lower[i] : arm.limits.upper[i];
    }
    q[3] = arm.limits.lower[3];
    q[5] = rng.uniform() < 0.8 ? arm.limits.upper[5] : arm.limits.lower[5];
    const Pose X_WT = fk(arm, as_span(q));
    const auto answer = ik.solve(X_WT, as_span(testing::random_q(arm, rng)));
    ASSERT_TRUE(answer) << describe(answer.error(), arm) << " at\n" << q.transpose();
    const Pose X = fk(arm, as_span(answer->q));
    EXPECT_LT((X.p - X_WT.p).norm(), 1.01e-7);
    EXPECT_LT(angle_between(X.R, X_WT.R), 1.01e-7);
    EXPECT_TRUE(within_limits(arm, as_span(answer->q)));
  }
}

TEST(ModelArms, Ur5eStandsWhereTheControllerHasIt) {
  const Loaded robot = load(find_model_file("ur5e").value());
  const Pose home = fk(robot.arm, as_span(robot.arm.home));
  EXPECT_LT((home.p - Eigen::Vector3d(-0.134, 0.492, 0.488)).norm(), 1e-5);
}

/// With the hand's own tip, too, every pose the arm can take is found again.
TEST(ModelArms, IkFindsRandomPosesOfTheShippedArms) {
  Rng rng(92);
  for (const char* name : {"ur5e", "panda"}) {
    const Loaded robot = load(find_model_file(name).value());
    const IkSolver ik(robot.arm);
    for (int i = 0; i < 1000; ++i) {
      const Pose X_goal = fk(robot.arm, as_span(testing::random_q(robot.arm, rng)));
      const auto answer = ik.solve(X_goal, as_span(testing::random_q(robot.arm, rng)));
      ASSERT_TRUE(answer.has_value()) << describe(answer.error(), robot.arm);
      const Pose X = fk(robot.arm, as_span(answer->q));
      EXPECT_LT((X.p - X_goal.p).norm(), 1.01e-7);
      EXPECT_LT(angle_between(X.R, X_goal.R), 1.01e-7);
      EXPECT_TRUE(within_limits(robot.arm, as_span(answer->q)));
    }
  }
}

TEST(ModelArms, IkSolvesTheCasesOfTheUrdfs) {
  for (const std::string name : {"ur5e", "panda"}) {
    MJARM_TEST_FILE(urdf, "ik/" + name + ".urdf");
    MJARM_TEST_FILE(reachable, "ik/" + name + "_reachable.jsonl");
    MJARM_TEST_FILE(unreachable, "ik/" + name + "_unreachable.jsonl");
    const Loaded robot = load(urdf);
    const IkSolver ik(robot.arm);
    for (const auto& entry : support::load_json_lines(reachable)) {
      const auto answer =
          ik.solve(testing::pose_of(entry), entry.at("seed").get<std::vector<double>>());
      ASSERT_TRUE(answer.has_value()) << describe(answer.error(), robot.arm);
    }
    for (const auto& entry : support::load_json_lines(unreachable)) {
      const auto answer = ik.solve(testing::pose_of(entry), as_span(robot.arm.home));
      ASSERT_FALSE(answer.has_value());
      EXPECT_EQ(answer.error().code, IkErrc::out_of_reach);
    }
  }
}

}  // namespace
}  // namespace mjarm
