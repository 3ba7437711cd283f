#include <gtest/gtest.h>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/path/failing_paths_test.hpp"
#include "mjarm/path/path_fix.hpp"
#include "mjarm/path/poses_test.hpp"
#include "mjarm/path/solve_path.hpp"
#include "tests/support/rounds.hpp"

namespace mjarm {
namespace {

/// Poses of a straight joint motion within the limits: a track that completes them is known.
std::vector<Pose> known_path(const Arm& arm, int n, double size, Rng& rng) {
  const JointVec q0 = testing::random_q(arm, rng);
  JointVec q1 = q0;
  for (int i = 0; i < arm.dof(); ++i) q1[i] += rng.uniform(-size, size);
  q1 = clamp_to_limits(arm, as_span(q1));
  std::vector<Pose> poses;
  for (int i = 0; i < n; ++i) {
    poses.push_back(fk(arm, as_span(JointVec(q0 + (q1 - q0) * i / (n - 1)))));
  }
  return poses;
}

/// Of `count` paths that are known to be possible, those that are solved.
int solved(const IkSolver& ik, int count, std::uint64_t seed) {
  Rng rng(seed);
  int done = 0;
  for (int i = 0; i < count; ++i) {
    const std::vector<Pose> poses = known_path(ik.arm(), 60, 1.2, rng);
    const auto path = solve_path(ik, poses, as_span(ik.arm().home));
    if (path) testing::expect_on_poses(ik.arm(), *path, poses);
    done += path.has_value();
  }
  return done;
}

TEST(SolvePathArms, WithAClosedFormOfSixAxesNoTrackIsMissed) {
  EXPECT_EQ(solved(IkSolver(testing::ur5e()), 40, 1), 40);
  EXPECT_EQ(solved(IkSolver(testing::industrial()), 40, 2), 40);
}

TEST(SolvePathArms, RedundantOnesAreFollowedFromManyPostures) {
  EXPECT_GE(solved(IkSolver(testing::panda()), 20, 3), 19);
}

TEST(SolvePathArms, AnyOtherIsFollowedFromRandomStarts) {
  EXPECT_GE(solved(IkSolver(testing::ur5e(), {.closed_form = false}), 10, 4), 9);
}

TEST(SolvePathArms, LongPathsAreKeptInPieces) {
  const bool thorough = testing::is_long();
  const int n = thorough ? 100'000 : 1'500;
  const Arm arm = testing::ur5e();
  Rng rng(5);
  const std::vector<Pose> poses = known_path(arm, n, 2, rng);
  const auto path = solve_path(IkSolver(arm), poses, as_span(arm.home));
  ASSERT_TRUE(path.has_value());
  testing::expect_on_poses(arm, *path, poses);
  EXPECT_LT(path->max_step(), 20.0 / n);
}

TEST(SolvePathArms, TheSameTwice) {
  for (const Arm& arm : {testing::ur5e(), testing::panda()}) {
    Rng rng(6);
    const std::vector<Pose> poses = known_path(arm, 40, 0.6, rng);
    const auto one = solve_path(IkSolver(arm), poses, as_span(arm.home));
    const auto two = solve_path(IkSolver(arm), poses, as_span(arm.home));
    ASSERT_EQ(one.has_value(), two.has_value());
    if (one) {
      EXPECT_EQ(one->q, two->q);
    }
  }
}

TEST(SolvePathArms, ATolerancePassesAWristSingularity) {
  Rng rng(7);
  const testing::FailingPath path = testing::singularity(rng, 0.01);
  const IkSolver ik(path.arm);
  const auto strict = solve_path(ik, path.poses, as_span(path.arm.home));
  ASSERT_FALSE(strict.has_value());
  EXPECT_EQ(strict.error().code, PathErrc::singularity);
  EXPECT_EQ(strict.error().kind, SingularKind::wrist);
  const auto loose = solve_path(ik, path.poses, as_span(path.arm.home), {.orientation_tol = 0.06});
  ASSERT_TRUE(loose.has_value()) << describe(loose.error(), path.arm);
  testing::expect_on_poses(path.arm, *loose, path.poses, 0.06 + 1e-6);
  // The tool turns aside little by little, not by all of it from one pose to the next.
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  double largest = 0;
  for (std::size_t i = 0; i < path.poses.size(); ++i) {
    const Eigen::Matrix3d R = fk(path.arm, as_span(loose->q[i])).R;
    const Eigen::Vector3d tilt = rotation_log(path.poses[i].R.transpose() * R);
    if (i > 0) largest = std::max(largest, (tilt - before).norm());
    before = tilt;
  }
  EXPECT_LT(largest, 0.03);
}

TEST(SolvePathArms, AToleranceThatIsNotNeededChangesNothing) {
  Rng rng(8);
  int unturned = 0;
  for (const Arm& arm : {testing::ur5e(), testing::panda()}) {
    const IkSolver ik(arm);
    for (int n = 0; n < 5; ++n) {
      const std::vector<Pose> poses = known_path(arm, 60, 0.5, rng);
      const auto exact = solve_path(ik, poses, as_span(arm.home));
      const auto loose = solve_path(ik, poses, as_span(arm.home), {.orientation_tol = 0.1});
      ASSERT_TRUE(exact && loose);
      double turned = 0;
      for (std::size_t i = 0; i < poses.size(); ++i) {
        turned = std::max(turned, angle_between(fk(arm, as_span(loose->q[i])).R, poses[i].R));
      }
      unturned += turned < 1e-6 && loose->q == exact->q;
    }
  }
  EXPECT_GE(unturned, 9);  // one comes too near to a limit
}

TEST(SolvePathArms, AnotherStartMendsAPathFromAPostureThatCannotGoOn) {
  // The last joint stands at its stop and the tool is to turn on.
  const Arm arm = testing::ur5e();
  const IkSolver ik(arm);
  const std::vector<double> q{-1.57, -1.34, 2.2, -1.3, 1.55, 6.2};
  const Pose X = fk(arm, q);
  std::vector<Pose> poses;
  for (int i = 0; i <= 20; ++i) poses.push_back({X.p, X.R * from_euler({0, 0, 0.05 * i})});
  PathOptions options{.keep_start = true};
  const auto kept = solve_path(ik, poses, q, options);
  ASSERT_FALSE(kept.has_value());
  EXPECT_EQ(kept.error().code, PathErrc::joint_limit);
  EXPECT_EQ(kept.error().joint, 5);
  EXPECT_NEAR(kept.error().amount, 6.2 + 1 - 2 * std::numbers::pi, 1e-6);
  const auto fixes = find_fixes(ik, poses, q, options, kept.error());
  ASSERT_FALSE(fixes.empty());
  EXPECT_EQ(fixes.front().kind, FixKind::start);
  const auto mended = solve_path(ik, poses, as_span(fixes.front().start), options);
  ASSERT_TRUE(mended.has_value());
  EXPECT_LT((mended->q.front() - fixes.front().start).norm(), 1e-6);
  EXPECT_LE(fixes.size(), 3U);
}

}  // namespace
}  // namespace mjarm
