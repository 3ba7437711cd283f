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

struct SolidTally {
  int free = 0, hit = 0, narrow = 0;  // narrow: free in MuJoCo, but by less than is asked
};

std::string place_of(const JointVec& q) {
  std::string out = "q";
  for (const double value : q) out += ' ' + std::to_string(value);
  return out;
}

void compare_states(const CoveredRobot& robot, double bound, int states, Rng& rng,
                    SolidTally& tally) {
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

void compare_edges(const CoveredRobot& robot, double bound, int edges, Rng& rng,
                   SolidTally& tally) {
  constexpr double kStep = 0.02;  // [rad or m]
  const FastChecker checker = closer_checker(robot, bound);
  ExactChecker exact(robot.model, robot.arm, {.margin = kSolidClearance});
  for (int k = 0; k < edges; ++k) {
    const JointVec from = testing::random_q(robot.arm, rng);
    const JointVec way = 0.3 * (testing::random_q(robot.arm, rng) - from);
    const EdgeResult found = check_edge(checker, as_span(from), as_span(from + way));
    const auto at = [&](double t) { return exact.check(as_span(from + t * way)).value(); };
    if (found.verdict != EdgeVerdict::free) {
      const CollisionReport truth = at(found.t);
      ASSERT_TRUE(!truth.free || truth.nearest.has_value())
          << place_of(from) << " to " << place_of(from + way) << " is refused at " << found.t;
      ++(truth.free ? tally.narrow : tally.hit);
      continue;
    }
    const int steps = 1 + static_cast<int>(way.norm() / kStep);
    for (int i = 0; i <= steps; ++i) {
      const CollisionReport truth = at(static_cast<double>(i) / steps);
      ASSERT_TRUE(truth.free) << place_of(from) << " to " << place_of(from + way) << ": "
                              << describe(truth);
    }
    ++tally.free;
  }
}

/// Short edges with room beside them, and configurations in that room.
void compare_beside(const CoveredRobot& robot, double bound, int edges, Rng& rng,
                    SolidTally& tally) {
  constexpr int kPlaces = 8;
  const FastChecker checker = closer_checker(robot, bound);
  ExactChecker exact(robot.model, robot.arm);
  for (int k = 0; k < edges; ++k) {
    const JointVec from = testing::random_q(robot.arm, rng);
    const JointVec way = 0.03 * (testing::random_q(robot.arm, rng) - from);
    JointVec beside = from;
    for (double& off : beside) off = rng.uniform(0, 0.02);
    const EdgeOptions options{.resolution = 0.25 * way.norm(), .beside = as_span(beside)};
    if (check_edge(checker, as_span(from), as_span(from + way), options).verdict !=
        EdgeVerdict::free) {
      ++tally.hit;
      continue;
    }
    for (int i = 0; i < kPlaces; ++i) {
      JointVec q = from + rng.uniform() * way;
      for (Eigen::Index j = 0; j < q.size(); ++j)
        q[j] += rng.uniform() < 0.5 ? beside[j] : -beside[j];
      const CollisionReport truth = exact.check(as_span(q)).value();
      ASSERT_TRUE(truth.free) << place_of(q) << ": " << describe(truth);
    }
    ++tally.free;
  }
}

void expect_both(const SolidTally& tally) {
  std::printf("%d free, %d in collision, %d nearly\n", tally.free, tally.hit, tally.narrow);
  EXPECT_GT(tally.free, (tally.free + tally.hit) / 50);
  EXPECT_GT(tally.hit, (tally.free + tally.hit) / 50);
}

void compare_solids(const CoveredRobot& robot, std::uint64_t seed) {
  Rng rng(seed);
  SolidTally states, edges, beside;
  compare_states(robot, 0.03, testing::rounds(5'000, 1'000'000, 1'000), rng, states);
  ASSERT_FALSE(::testing::Test::HasFatalFailure());
  compare_edges(robot, 0.03, testing::rounds(200, 100'000, 60), rng, edges);
  ASSERT_FALSE(::testing::Test::HasFatalFailure());
  compare_beside(robot, 0.03, testing::rounds(300, 100'000, 60), rng, beside);
  expect_both(states);
  expect_both(edges);
  expect_both(beside);
}

TEST(SolidScene, Ur5eAsMujocoSeesIt) { compare_solids(testing::covered_robot("ur5e"), 401); }
TEST(SolidScene, PandaAsMujocoSeesIt) { compare_solids(testing::covered_robot("panda"), 402); }

TEST(SolidScene, RandomTreesAsMujocoSeesThem) {
  const support::TempFolder folder;
  Rng rng(403);
  SolidTally states, edges;
  for (int round = 0; round < testing::rounds(25, 400, 5); ++round) {
    const CoveredRobot robot =
        testing::covered_file(folder.write("tree.xml", testing::random_tree(rng)), "tip");
    compare_states(robot, 0.05, testing::rounds(400, 2'500, 100), rng, states);
    ASSERT_FALSE(HasFatalFailure()) << "round " << round;
    compare_edges(robot, 0.05, testing::rounds(20, 250), rng, edges);
    ASSERT_FALSE(HasFatalFailure()) << "round " << round;
  }
  expect_both(states);
  expect_both(edges);
}

/// Three slides carry a box, turned somehow, over hills: MuJoCo cuts each cell into two prisms.
TEST(SolidScene, HillsAsMujocoSeesThem) {
  const support::TempFolder folder;
  Rng rng(404);
  SolidTally states;
  for (int round = 0; round < 10; ++round) {
    const CoveredRobot robot = testing::covered_file(
        folder.write(
            "hills.xml",
            R"(<mujoco><compiler angle="radian"/><asset><hfield name="hills" nrow="5" ncol="7"
        size="0.6 0.5 0.3 0.1" elevation=")" +
                testing::numbers(rng, 35, 0, 1) + R"("/></asset><worldbody>
        <geom name="hills" type="hfield" hfield="hills" pos="0.1 0 -0.2" euler="0.1 0.2 0.3"/>
        <body><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/><joint name="x" type="slide" axis="1 0 0" range="-0.7 0.7" limited="true"/>
        <body><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/><joint name="y" type="slide" axis="0 1 0" range="-0.6 0.6" limited="true"/>
        <body><joint name="z" type="slide" axis="0 0 1" range="-0.3 0.4" limited="true"/>
        <geom name="box" type="box" size="0.05 0.08 0.02" euler=")" +
                testing::numbers(rng, 3, -3, 3) +
                R"("/><site name="tip"/></body></body></body></worldbody></mujoco>)"),
        "tip");
    const FastChecker checker = closer_checker(robot, 0.03);
    ExactChecker exact(robot.model, robot.arm, {.margin = 0});
    for (int k = 0; k < 500; ++k) {
      const JointVec q = testing::random_q(robot.arm, rng);
      const bool free = exact.is_free(as_span(q));
      if (checker.is_free(as_span(q))) {
        ASSERT_TRUE(free) << round << ": " << place_of(q);
        ++states.free;
      } else if (!free) {
        ++states.hit;
      } else {
        bool touches = false;  // a little to the side, in each direction
        for (int i = 0; i < 6; ++i) {
          JointVec beside = q;
          beside[i / 2] += (i % 2 == 0 ? 1 : -1) * 2 * kSolidClearance;
          touches |= !exact.is_free(as_span(beside));
        }
        ASSERT_TRUE(touches) << round << ": " << place_of(q) << " is refused";
        ++states.narrow;
      }
    }
  }
  expect_both(states);
}

}  // namespace
}  // namespace mjarm
