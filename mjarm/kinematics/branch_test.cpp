#include "mjarm/kinematics/branch.hpp"

#include <gtest/gtest.h>

#include <set>

#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik_all.hpp"
#include "tests/support/constants.hpp"

namespace mjarm {
namespace {

using support::kPi;

/// Six hinges with a spherical wrist and no offset at the shoulder.
Arm industrial() {
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const double half = kPi / 2;
  return testing::make_arm("industrial",
                           {{{0, 0, 0.4}, {0, 0, 0}, z, -3, 3},
                            {{0.1, 0, 0.1}, {-half, 0, 0}, z, -3, 3},
                            {{0.45, 0, 0}, {0, 0, 0}, z, -3, 3},
                            {{0.04, -0.43, 0}, {half, 0, 0}, z, -3, 3},
                            {{0, 0, 0}, {-half, 0, 0}, z, -3, 3},
                            {{0, 0, 0}, {half, 0, 0}, z, -3, 3}},
                           {{0, 0, 0.08}, Eigen::Matrix3d::Identity()});
}

/// The words of every answer to a pose are others than those of the others.
void expect_words_tell_branches_apart(const Arm& arm) {
  const IkSolver ik(arm);
  ASSERT_TRUE(ik.six_axis().has_value());
  Rng rng(31);
  int whole = 0;
  for (int i = 0; i < 300; ++i) {
    const JointVec q = testing::random_q(arm, rng);
    const auto all = solve_all(ik, fk(arm, as_span(q)), as_span(q));
    ASSERT_TRUE(all.has_value()) << i;
    std::set<std::string> words;
    for (const IkSolution& answer : *all) {
      const Branch branch = branch_of(ik, as_span(answer.q));
      for (const int way : branch.way) EXPECT_GE(way, 0);
      EXPECT_TRUE(words.insert(describe(branch)).second) << i << ' ' << describe(branch);
    }
    if (all->size() == 8) ++whole;
  }
  EXPECT_GT(whole, 50);
}

TEST(Branch, WordsTellTheBranchesOfAUr5eApart) {
  expect_words_tell_branches_apart(testing::ur5e());
}

TEST(Branch, WordsTellTheBranchesOfASphericalWristApart) {
  expect_words_tell_branches_apart(industrial());
}

TEST(Branch, WordsMeanWhatTheySay) {
  const Arm arm = testing::ur5e();
  const IkSolver ik(arm);
  // The upper arm rises, the forearm falls: the elbow is on top.
  const JointVec up = joint_vec(std::vector<double>{0.0, -0.8, 1.5, -2.2, -1.57, 0.0});
  std::array<Pose, kMaxDof> X_WJ;
  fk_all(arm, as_span(up), X_WJ);
  ASSERT_GT(X_WJ[2].p.z(), X_WJ[1].p.z());
  ASSERT_GT(X_WJ[2].p.z(), X_WJ[3].p.z());
  EXPECT_EQ(branch_of(ik, as_span(up)).way[1], 0);
  const JointVec down = joint_vec(std::vector<double>{0.0, 0.5, -1.5, -2.2, -1.57, 0.0});
  fk_all(arm, as_span(down), X_WJ);
  ASSERT_LT(X_WJ[2].p.z(), X_WJ[3].p.z());
  EXPECT_EQ(branch_of(ik, as_span(down)).way[1], 1);
  // Turning the whole arm about its base changes none of the words.
  JointVec turned = up;
  turned[0] += 2;
  EXPECT_EQ(branch_of(ik, as_span(turned)), branch_of(ik, as_span(up)));
}

TEST(Branch, LeftAndRightAreThoseOfAnObserverAtTheBase) {
  const Arm arm = testing::ur5e();
  const IkSolver ik(arm);
  const Eigen::Vector3d goal(0.5, 0, 0.4);
  const Pose X_WT{goal, testing::ur5e().X_JT.R};
  const auto all = solve_all(ik, X_WT, as_span(arm.home));
  ASSERT_TRUE(all.has_value());
  std::set<int> sides;
  for (const IkSolution& answer : *all) {
    std::array<Pose, kMaxDof> X_WJ;
    fk_all(arm, as_span(answer.q), X_WJ);
    // The observer looks along x: left is y. The upper arm begins beside the base axis.
    const bool left = X_WJ[1].p.y() > 0;
    EXPECT_EQ(branch_of(ik, as_span(answer.q)).way[0], left ? 0 : 1);
    sides.insert(left ? 0 : 1);
  }
  EXPECT_EQ(sides.size(), 2U);
}

TEST(Branch, OnlyTheElbowIsKnownWithoutAClosedForm) {
  Rng rng(5);
  const Arm five = testing::random_arm(5, rng);
  const IkSolver ik(five, {.task = task_for(five)});
  const Branch branch = branch_of(ik, as_span(five.home));
  EXPECT_EQ(branch.way[0], -1);
  EXPECT_GE(branch.way[1], 0);
  EXPECT_EQ(branch.way[2], -1);
  EXPECT_TRUE(check_branch(ik, *parse_branch("elbow=up")).has_value());
  const auto refused = check_branch(ik, *parse_branch("wrist=flip"));
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().what.find("wrist"), std::string::npos);
  const Arm three = testing::random_arm(3, rng);
  EXPECT_TRUE(branch_of(IkSolver(three), as_span(three.home)).empty());
  EXPECT_TRUE(check_branch(IkSolver(testing::panda()), *parse_branch("shoulder=left,elbow=up")));
}

TEST(Branch, WordsAreReadAndWritten) {
  const auto branch = parse_branch("shoulder=left, wrist=flip");
  ASSERT_TRUE(branch.has_value());
  EXPECT_EQ(branch->way, (std::array<int, 3>{0, -1, 1}));
  EXPECT_EQ(describe(*branch), "shoulder=left,wrist=flip");
  EXPECT_TRUE(branch->allows(*parse_branch("shoulder=left,elbow=down,wrist=flip")));
  EXPECT_FALSE(branch->allows(*parse_branch("shoulder=left,elbow=down,wrist=no_flip")));
  const std::pair<const char*, const char*> bad[] = {
      {"elbow=upp", "did you mean \"up\"?"},
      {"elbw=up", "did you mean \"elbow\"?"},
      {"elbow", "expected PART=WORD"},
      {"elbow=up,elbow=down", "elbow is given twice"},
      {"", "expected PART=WORD"},
      {"wrist=noflip", "did you mean \"no_flip\"?"},
      {"shoulder=left,,elbow=up", "PART=WORD"}};
  for (const auto& [words, says] : bad) {
    const auto read = parse_branch(words);
    ASSERT_FALSE(read.has_value()) << words;
    EXPECT_NE(read.error().what.find(says), std::string::npos) << read.error().what;
  }
}

}  // namespace
}  // namespace mjarm
