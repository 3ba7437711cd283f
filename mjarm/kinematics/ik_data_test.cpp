#include <gtest/gtest.h>

#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/compare_test.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "tests/support/test_data.hpp"

namespace mjarm {
namespace {

void expect_all_solved(const Arm& arm, const std::filesystem::path& file) {
  const IkSolver ik(arm);
  for (const auto& entry : support::load_json_lines(file)) {
    const Pose X_goal = testing::pose_of(entry);
    const auto answer = ik.solve(X_goal, entry.at("seed").get<std::vector<double>>());
    ASSERT_TRUE(answer.has_value()) << describe(answer.error(), arm);
    const Pose X = fk(arm, as_span(answer->q));
    EXPECT_LT((X.p - X_goal.p).norm(), 1.01e-7);
    EXPECT_LT(angle_between(X.R, X_goal.R), 1.01e-7);
    EXPECT_TRUE(within_limits(arm, as_span(answer->q)));
  }
}

void expect_none_reachable(const Arm& arm, const std::filesystem::path& file) {
  const IkSolver ik(arm);
  for (const auto& entry : support::load_json_lines(file)) {
    const auto answer = ik.solve(testing::pose_of(entry), as_span(arm.home));
    ASSERT_FALSE(answer.has_value());
    EXPECT_EQ(answer.error().code, IkErrc::out_of_reach);
    EXPECT_GT(answer.error().amount, 0);
    EXPECT_GT(answer.error().bound, 0);
    EXPECT_EQ(answer.error().best.restarts, 0);
  }
}

TEST(IkData, Ur5eReachable) {
  MJARM_TEST_FILE(file, "ik/ur5e_reachable.jsonl");
  expect_all_solved(testing::ur5e(), file);
}
TEST(IkData, PandaReachable) {
  MJARM_TEST_FILE(file, "ik/panda_reachable.jsonl");
  expect_all_solved(testing::panda(), file);
}
TEST(IkData, Ur5eUnreachable) {
  MJARM_TEST_FILE(file, "ik/ur5e_unreachable.jsonl");
  expect_none_reachable(testing::ur5e(), file);
}
TEST(IkData, PandaUnreachable) {
  MJARM_TEST_FILE(file, "ik/panda_unreachable.jsonl");
  expect_none_reachable(testing::panda(), file);
}

TEST(IkData, TheEllipseCrossesTheCylinderAtPoints37To62) {
  MJARM_TEST_FILE(file, "ik/ur5e_ellipse.jsonl");
  const IkSolver ik(testing::ur5e());
  JointVec seed = joint_vec(std::vector<double>{-1.57, -1.34, 2.65, -1.3, 1.55, 0});
  const nlohmann::json poses = support::load_json_lines(file).at(0).at("poses");
  ASSERT_EQ(poses.size(), 200U);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto answer = ik.solve(testing::pose_of(poses[i]), as_span(seed));
    const bool inside = i >= 37 && i <= 62;
    ASSERT_EQ(answer.has_value(), !inside) << i;
    if (answer) {
      seed = answer->q;
    } else {
      EXPECT_EQ(answer.error().code, IkErrc::inner_void);
      EXPECT_NEAR(answer.error().bound, 0.134, 1e-8);
      EXPECT_GT(answer.error().amount, 0);
      EXPECT_LT(answer.error().amount, 0.134);
    }
  }
}

TEST(IkData, TheEllipseFartherOutIsReachable) {
  MJARM_TEST_FILE(file, "ik/ur5e_ellipse_far.jsonl");
  const IkSolver ik(testing::ur5e());
  JointVec seed = joint_vec(std::vector<double>{-1.57, -1.34, 2.65, -1.3, 1.55, 0});
  const nlohmann::json poses = support::load_json_lines(file).at(0).at("poses");
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto answer = ik.solve(testing::pose_of(poses[i]), as_span(seed));
    ASSERT_TRUE(answer.has_value()) << i;
    if (i > 0) {
      EXPECT_LT((answer->q - seed).cwiseAbs().maxCoeff(), 0.2) << i;
    }
    seed = answer->q;
  }
}

}  // namespace
}  // namespace mjarm
