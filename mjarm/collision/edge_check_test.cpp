#include "mjarm/collision/edge_check.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "mjarm/collision/edge_samples_test.hpp"
#include "mjarm/collision/problems_test.hpp"
#include "mjarm/collision/prove_edge.hpp"
#include "mjarm/collision/random_scene_test.hpp"
#include "mjarm/kinematics/long_tests_test.hpp"

namespace mjarm {
namespace {

constexpr std::array kEdgeLevels{SimdLevel::baseline, SimdLevel::avx2, SimdLevel::avx512};

struct EdgeTally {
  int free = 0, hit = 0, undecided = 0;
};

/// One random edge against the oracle.
void compare_edge(const FastChecker& checker, const Obstacles& world, std::span<const double> q0,
                  std::span<const double> q1, EdgeTally& tally) {
  const Arm& arm = checker.robot().arm();
  const SphereSet& set = checker.robot().spheres();
  const EdgeResult result = check_edge(checker, q0, q1);
  const std::vector<double> at = testing::on_edge(q0, q1, result.t);
  switch (result.verdict) {
    case EdgeVerdict::free:
      ++tally.free;
      ASSERT_GT(testing::least_clearance(arm, set, world, q0, q1, testing::rounds(60, 400)), 0)
          << "false certificate";
      break;
    case EdgeVerdict::hit:
      ++tally.hit;
      ASSERT_LT(testing::true_clearance(arm, set, world, at), 2 * checker.robot().padding() + 2e-6);
      break;
    case EdgeVerdict::undecided:
      ++tally.undecided;
      ASSERT_LT(testing::true_clearance(arm, set, world, at), 0.01);
      break;
    case EdgeVerdict::outside:
      FAIL() << "both ends are within the limits";
  }
}

TEST(CheckEdge, NoFalseCertificateAmongPlatesAndWires) {
  Rng rng(21);
  EdgeTally tally;
  const int worlds = testing::rounds(60, 2500, 25);
  for (int round = 0; round < worlds; ++round) {
    const Arm arm = testing::random_arm(2 + round % 6, rng);
    SphereSet set = testing::random_spheres(arm, rng);
    for (LinkSpheres& link : set.links) {
      for (Sphere& sphere : link.spheres) sphere.radius *= 0.3;
    }
    const Obstacles world = testing::random_world(rng, 5, true);
    const auto robot = FastRobot::create(arm, set).value();
    const auto checker = FastChecker::create(robot, world, kEdgeLevels[round % 3]).value();
    if (checker.fixed_overlap()) continue;
    for (int k = 0; k < 40; ++k) {
      const JointVec q0 = testing::random_q(arm, rng);
      const JointVec q1 = q0 + rng.uniform(0.02, 1) * (testing::random_q(arm, rng) - q0);
      compare_edge(checker, world, as_span(q0), as_span(q1), tally);
      if (::testing::Test::HasFatalFailure()) return;
    }
  }
  EXPECT_GT(tally.free, worlds * 10);
  EXPECT_GT(tally.hit, worlds);
  EXPECT_LT(tally.undecided, worlds);
}

/// What is called free with room beside an edge is so for whatever leaves it by no more.
TEST(CheckEdge, WhatLiesBesideIsProvedAsWell) {
  Rng rng(24);
  int proved = 0, narrow = 0;
  const int worlds = testing::rounds(30, 2000, 25);
  for (int round = 0; round < worlds; ++round) {
    const Arm arm = testing::random_arm(2 + round % 6, rng);
    SphereSet set = testing::random_spheres(arm, rng);
    for (LinkSpheres& link : set.links) {
      for (Sphere& sphere : link.spheres) sphere.radius *= 0.3;
    }
    const Obstacles world = testing::random_world(rng, 5, true);
    const auto robot = FastRobot::create(arm, set).value();
    const auto checker = FastChecker::create(robot, world, kEdgeLevels[round % 3]).value();
    if (checker.fixed_overlap()) continue;
    for (int k = 0; k < 30; ++k) {
      const JointVec q0 = testing::random_q(arm, rng);
      const JointVec q1 = q0 + rng.uniform(0, 0.3) * (testing::random_q(arm, rng) - q0);
      JointVec beside = q0;
      for (double& off : beside) off = rng.uniform(0, 0.02);
      const EdgeOptions wide{.beside = as_span(beside)};
      if (check_edge(checker, as_span(q0), as_span(q1), wide).verdict != EdgeVerdict::free) {
        narrow += check_edge(checker, as_span(q0), as_span(q1)).verdict == EdgeVerdict::free;
        continue;
      }
      ++proved;
      for (int i = 0; i < 20; ++i) {
        JointVec q = q0 + rng.uniform() * (q1 - q0);
        for (Eigen::Index j = 0; j < q.size(); ++j) {
          q[j] += beside[j] * (rng.uniform() < 0.5 ? -1 : 1);
          ASSERT_GE(q[j], arm.limits.lower[j]);
          ASSERT_LE(q[j], arm.limits.upper[j]);
        }
        ASSERT_GT(testing::true_clearance(arm, set, world, as_span(q)), 0) << "false certificate";
      }
    }
  }
  EXPECT_GT(proved, 8 * worlds);
  EXPECT_GT(narrow, worlds / 2);
}

TEST(CheckEdge, CertificatesCoverTheEdge) {
  Rng rng(22);
  const Arm arm = testing::panda();
  const SphereSet set = testing::random_spheres(arm, rng);
  const auto robot = FastRobot::create(arm, set).value();
  int proved = 0;
  for (int round = 0; round < 300; ++round) {
    const Obstacles world = testing::random_world(rng, 3);
    const auto checker = FastChecker::create(robot, world, kEdgeLevels[round % 3]).value();
    const JointVec q0 = testing::random_q(arm, rng);
    const JointVec q1 = testing::random_q(arm, rng);
    const auto proof = certify_edge(checker, as_span(q0), as_span(q1));
    EXPECT_EQ(proof.has_value(),
              check_edge(checker, as_span(q0), as_span(q1)).verdict == EdgeVerdict::free);
    if (!proof) continue;
    ++proved;
    double reached = 0;
    for (const EdgeInterval& interval : proof->intervals) {
      EXPECT_LE(interval.t - interval.half, reached);
      reached = std::max(reached, interval.t + interval.half);
      EXPECT_GE(2 * interval.half * (q1 - q0).norm(), proof->step - 1e-12);
    }
    EXPECT_GE(reached, 1);
    const auto bare = prove_edge(checker, as_span(q0), as_span(q1));  // the same, not measured
    EXPECT_EQ(bare.value().step, proof->step);
    EXPECT_EQ(bare->intervals.size(), proof->intervals.size());
    EXPECT_EQ(bare->nearest.link, -1);
    const auto at = testing::on_edge(as_span(q0), as_span(q1), proof->nearest_t);
    EXPECT_GT(proof->nearest.distance, 0);
    if (proof->nearest.obstacle >= 0) {
      SphereSet link;
      link.links = {set.links[static_cast<std::size_t>(proof->nearest.link)]};
      const Obstacles one{{world.solids[static_cast<std::size_t>(proof->nearest.obstacle)]}};
      EXPECT_NEAR(testing::true_clearance(arm, link, one, at), proof->nearest.distance, 2e-4);
    }
  }
  EXPECT_GT(proved, 20);
}

TEST(CheckEdge, EndsOutsideOfTheLimitsAndEdgesOfNoLength) {
  const Arm arm = testing::panda();
  SphereSet set;
  set.links = {{"hand", 6, {{Eigen::Vector3d::Zero(), 0.05}}}};
  const auto checker = FastChecker::create(FastRobot::create(arm, set).value(), {}).value();
  const JointVec home = arm.home;
  JointVec out = home;
  out[1] = arm.limits.upper[1] + 0.01;
  EXPECT_EQ(check_edge(checker, as_span(home), as_span(home)).verdict, EdgeVerdict::free);
  const EdgeResult end = check_edge(checker, as_span(home), as_span(out));
  EXPECT_EQ(end.verdict, EdgeVerdict::outside);
  EXPECT_EQ(end.t, 1);
  EXPECT_EQ(check_edge(checker, as_span(out), as_span(home)).t, 0);
  out[1] = std::nan("");
  EXPECT_EQ(check_edge(checker, as_span(home), as_span(out)).verdict, EdgeVerdict::outside);
}

TEST(CheckEdge, PublicProblemsAgreeWithDenseSamples) {
  MJARM_TEST_FILE(file, "motionbenchmaker/mbm_panda_public.json.gz");
  const testing::PlanningProblems all = testing::read_problems(file);
  const auto robot = FastRobot::create(all.arm, all.set).value();
  Rng rng(23);
  EdgeTally tally;
  for (std::size_t i = 0; i < all.problems.size(); i += 5) {
    const testing::PlanningProblem& problem = all.problems[i];
    const auto checker =
        FastChecker::create(robot, problem.obstacles, kEdgeLevels[i / 5 % 3]).value();
    compare_edge(checker, problem.obstacles, problem.start, problem.goals.front(), tally);
    for (int k = 0; k < 3; ++k) {
      const JointVec q1 = testing::random_q(all.arm, rng);
      compare_edge(checker, problem.obstacles, problem.start, as_span(q1), tally);
    }
    if (::testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(tally.free, 20);
  EXPECT_GT(tally.hit, 20);
}

}  // namespace
}  // namespace mjarm
