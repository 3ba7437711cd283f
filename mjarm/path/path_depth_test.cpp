// A path that stops is told with how much worse it gets, not with the nothing at the border.
#include <gmock/gmock.h>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/path/path_failure.hpp"
#include "mjarm/path/poses_test.hpp"
#include "mjarm/path/solve_curve.hpp"

namespace mjarm {
namespace {

PathFailure failure_from(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Matrix3d down = from_euler({std::numbers::pi, 0, 0});
  const IkSolver ik(testing::ur5e());
  const Curve line = Curve::line({from, down}, {to, down}).value();
  auto path = solve_curve(ik, line, testing::kSeed);
  EXPECT_FALSE(path.has_value());
  return path ? PathFailure{} : std::move(path.error());
}

TEST(PathDepth, OfAWayThroughTheCylinderIsTheDeepestOfIt) {
  const PathFailure failure = failure_from({0.35, -0.05, 0.6}, {-0.35, -0.05, 0.6});
  EXPECT_EQ(failure.code, PathErrc::inner_void);
  EXPECT_NEAR(failure.amount, failure.ik.bound - 0.05, 1e-3);
  EXPECT_GT(failure.amount, 0.08);
  EXPECT_THAT(describe(failure, testing::ur5e()), ::testing::HasSubstr("by 0.084 m"));
  EXPECT_LT(failure.fraction, 0.5);  // where it begins stays where it was
}

TEST(PathDepth, OfAWayOutOfReachIsThatOfItsEnd) {
  const Pose end{{0, -1.5, 0.4}, from_euler({std::numbers::pi, 0, 0})};
  const PathFailure failure = failure_from({0, -0.5, 0.4}, end.p);
  const auto answer = IkSolver(testing::ur5e()).solve(end, testing::kSeed);
  ASSERT_FALSE(answer.has_value());
  EXPECT_EQ(failure.code, PathErrc::out_of_reach);
  EXPECT_NEAR(failure.amount, answer.error().amount, 0.01);
}

}  // namespace
}  // namespace mjarm
