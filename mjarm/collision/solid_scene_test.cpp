#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "mjarm/collision/cover_robots_test.hpp"
#include "mjarm/collision/edge_check.hpp"
#include "mjarm/collision/exact.hpp"
#include "mjarm/collision/fast_check.hpp"
#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/long_tests_test.hpp"

/// A checker that looks closer against MuJoCo, in both directions: what it calls free is never in
/// contact, and what MuJoCo calls free by kSolidClearance is never refused.
namespace mjarm {
namespace {

using testing::CoveredRobot;

FastChecker closer_checker(const CoveredRobot& robot, double bound) {
  const ModelCover cover = cover_model(robot.model, robot.arm, {.bound = bound}).value();
  return FastChecker::create(FastRobot::create(robot.arm, cover.spheres).value(), cover.scene)
      .value()
      .looking_closer(cover.solids);
}

struct Tally {
  int free = 0, hit = 0, narrow = 0;  // narrow: free in MuJoCo, but by less than is asked
};

std::string place_of(const JointVec& q) {
  std::string out = "q";
  for (const double value : q) out += ' ' + std::to_string(value);
  return out;
}

void compare_states(const CoveredRobot& robot, double bound, int states, Rng& rng, Tally& tally) {
  const FastChecker checker = closer_checker(robot, bound);
  ExactChecker exact(robot.model, robot.arm, {.margin = kSolidClearance});
  for (int k = 0; k < states; ++k) {
    const JointVec q = testing::random_q(robot.arm, rng);
    const CollisionReport truth = exact.check(as_span(q)).value();
    if (checker.is_free(as_span(q))) {
      ASSERT_TRUE(truth.free) << place_of(q) << ": " << describe(truth);
      ++tally.free;
    } else if (!truth.free) {
      ++tally.hit;
    } else {
      const SphereClearance near = checker.clearance(as_span(q));
      ASSERT_TRUE(truth.nearest.has_value())
          << place_of(q) << " is refused: " << near.link << " and " << near.obstacle << " or "
          << near.other_link << " at " << near.distance;
      ++tally.narrow;
    }
  }
}

void compare_edges(const CoveredRobot& robot, double bound, int edges, Rng& rng, Tally& tally) {
  constexpr double kStep = 2e-3;  // [rad or m]
  const FastChecker checker = closer_checker(robot, bound);
  ExactChecker exact(robot.model, robot.arm, {.margin = 2e-3});
  for (int k = 0; k < edges; ++k) {
    const JointVec from = testing::random_q(robot.arm, rng);
    const JointVec way = 0.3 * (testing::random_q(robot.arm, rng) - from);
    const EdgeResult found = check_edge(checker, as_span(from), as_span(from + way));
    const int steps = 1 + static_cast<int>(way.norm() / kStep);
    double least = 1;
    for (int i = 0; i <= steps && least > 0; ++i) {
      const JointVec q = from + static_cast<double>(i) / steps * way;
      const CollisionReport truth = exact.check(as_span(q)).value();
      if (!truth.free) least = -1;
      if (truth.nearest) least = std::min(least, truth.nearest->distance);
    }
    if (found.verdict == EdgeVerdict::free) {
      ASSERT_GE(least, 0) << place_of(from) << " to " << place_of(from + way);
      ++tally.free;
    } else if (least <= 0) {
      ++tally.hit;
    } else {
      // Between samples it may come nearer.
      ASSERT_LT(least, 2e-3) << place_of(from) << " to " << place_of(from + way) << " t "
                             << found.t;
      ++tally.narrow;
    }
  }
}

void expect_both(const Tally& tally) {
  std::printf("%d free, %d in collision, %d nearly\n", tally.free, tally.hit, tally.narrow);
  EXPECT_GT(tally.free, (tally.free + tally.hit) / 50);
  EXPECT_GT(tally.hit, (tally.free + tally.hit) / 50);
}

void compare_robot(const CoveredRobot& robot, std::uint64_t seed) {
  Rng rng(seed);
  Tally states, edges;
  compare_states(robot, 0.03, testing::rounds(5'000, 1'000'000), rng, states);
  ASSERT_FALSE(::testing::Test::HasFatalFailure());
  compare_edges(robot, 0.03, testing::rounds(200, 100'000), rng, edges);
  expect_both(states);
  expect_both(edges);
}

TEST(SolidScene, Ur5eAsMujocoSeesIt) { compare_robot(testing::covered_robot("ur5e"), 401); }
TEST(SolidScene, PandaAsMujocoSeesIt) { compare_robot(testing::covered_robot("panda"), 402); }

TEST(SolidScene, RandomTreesAsMujocoSeesThem) {
  const support::TempFolder folder;
  Rng rng(403);
  Tally states, edges;
  for (int round = 0; round < testing::rounds(25, 400); ++round) {
    const CoveredRobot robot =
        testing::covered_file(folder.write("tree.xml", testing::random_tree(rng)), "tip");
    compare_states(robot, 0.05, testing::rounds(400, 2'500), rng, states);
    ASSERT_FALSE(HasFatalFailure()) << "round " << round;
    compare_edges(robot, 0.05, testing::rounds(20, 250), rng, edges);
    ASSERT_FALSE(HasFatalFailure()) << "round " << round;
  }
  expect_both(states);
  expect_both(edges);
}

}  // namespace
}  // namespace mjarm
