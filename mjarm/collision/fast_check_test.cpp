#include "mjarm/collision/fast_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mjarm/collision/fast_oracle_test.hpp"
#include "mjarm/collision/problems_test.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/long_tests_test.hpp"

namespace mjarm {
namespace {

using testing::compare;
using testing::kLevels;
using testing::random_rows;
using testing::Tally;

TEST(FastChecker, NeverFreeWhereRandomRobotsCollide) {
  Rng rng(11);
  Tally tally;
  const int worlds = testing::rounds(50, 15'000, 15);
  for (int round = 0; round < worlds; ++round) {
    const Arm arm = testing::random_arm(1 + round % 9, rng);
    const SphereSet set = testing::random_spheres(arm, rng);
    const Obstacles world = testing::random_world(rng, static_cast<int>(rng.below(12)));
    for (const SimdLevel level : kLevels) compare(arm, set, world, level, rng, 225, tally);
    if (::testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(tally.free, worlds * 20);
  EXPECT_GT(tally.blocked, worlds * 20);
  RecordProperty("padded", tally.padded);
}

TEST(FastChecker, AllAreFreeWhereEachIs) {
  Rng rng(15);
  int free_lists = 0, blocked_lists = 0;
  const int worlds = testing::rounds(300, 300, 30);
  for (int round = 0; round < worlds; ++round) {
    const Arm arm = testing::random_arm(1 + round % 9, rng);
    const FastRobot robot = FastRobot::create(arm, testing::random_spheres(arm, rng)).value();
    const Obstacles world = testing::random_world(rng, static_cast<int>(rng.below(4)));
    for (const SimdLevel level : kLevels) {
      const FastChecker checker = FastChecker::create(robot, world, level).value();
      for (int i = 0; i < 20; ++i) {
        const int count = static_cast<int>(rng.below(40));
        const std::vector<double> q = random_rows(arm, rng, count);
        std::vector<std::uint8_t> free(static_cast<std::size_t>(count));
        checker.check(q, free);
        const bool all = std::ranges::all_of(free, [](std::uint8_t one) { return one != 0; });
        ASSERT_EQ(checker.all_free(q), all) << count << " states";
        ++(all ? free_lists : blocked_lists);
      }
    }
  }
  EXPECT_GT(free_lists, worlds * 20 / 3);
  EXPECT_GT(blocked_lists, worlds * 20 / 3);
}

TEST(FastChecker, LargeAndFarSolidsStaySafe) {
  Rng rng(12);
  Tally tally;
  const int worlds = testing::rounds(60, 60, 8);
  for (int round = 0; round < worlds; ++round) {
    const Arm arm = testing::panda();
    const SphereSet set = testing::random_spheres(arm, rng);
    Obstacles world;
    const Eigen::Vector3d away = testing::random_vector(rng, 1).normalized();
    const Eigen::Matrix3d R = rotation_between(Eigen::Vector3d::UnitZ(), away);
    const double size = std::pow(10, rng.uniform(1, 3.9));
    const double gap = rng.uniform(0.2, 0.8);
    const ObstacleShape shapes[] = {BallShape{size}, BoxShape{{size, size, size}},
                                    CylinderShape{size, size}, CapsuleShape{size, 1}};
    const double up = round % 4 == 3 ? size + 1 : size;
    world.solids.push_back({"huge", {(gap + up) * away, R}, shapes[round % 4]});
    compare(arm, set, world, kLevels[round % 3], rng, 200, tally, {.extent = 4 * size});
    if (::testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(tally.free, worlds * 50 / 3);
  EXPECT_GT(tally.blocked, worlds * 50 / 3);
}

TEST(FastChecker, WhatIsAskedDoesNotDependOnNeighboursOrRuns) {
  Rng rng(13);
  const Arm arm = testing::panda();
  const SphereSet set = testing::random_spheres(arm, rng);
  const Obstacles world = testing::random_world(rng, 8);
  const auto robot = FastRobot::create(arm, set).value();
  const std::vector<double> rows = random_rows(arm, rng, 333);
  for (const SimdLevel level : kLevels) {
    const auto checker = FastChecker::create(robot, world, level).value();
    const auto again =
        FastChecker::create(FastRobot::create(arm, set).value(), world, level).value();
    std::vector<std::uint8_t> free(333), once(333);
    checker.check(rows, free);
    again.check(rows, once);
    EXPECT_EQ(free, once);
    for (std::size_t i = 0; i < 333; ++i) {
      const std::span<const double> q(&rows[7 * i], 7);
      EXPECT_EQ(checker.is_free(q), free[i] != 0);
      const SphereClearance a = checker.clearance(q), b = again.clearance(q);
      EXPECT_EQ(a.distance, b.distance);
      EXPECT_EQ(a.obstacle, b.obstacle);
    }
  }
}

TEST(FastChecker, NearestPairIsNamed) {
  Rng rng(14);
  const Arm arm = testing::panda();
  const SphereSet set = testing::random_spheres(arm, rng);
  const Obstacles world = testing::random_world(rng, 12);
  const std::vector<double> rows = random_rows(arm, rng, 500);
  const auto robot = FastRobot::create(arm, set).value();
  for (const SimdLevel level : kLevels) {
    const auto checker = FastChecker::create(robot, world, level).value();
    for (std::size_t i = 0; i < 500; ++i) {
      const std::span<const double> q(&rows[7 * i], 7);
      const SphereClearance found = checker.clearance(q);
      const double truth = testing::true_clearance(arm, set, world, q, true);
      if (truth < 0 || truth > 0.9) continue;
      EXPECT_NEAR(found.distance, truth, 1e-4);
      ASSERT_GE(found.link, 0);
      ASSERT_NE(found.obstacle < 0, found.other_link < 0);
      SphereSet links;
      links.links = {set.links[static_cast<std::size_t>(found.link)]};
      Obstacles one;
      if (found.obstacle >= 0) {
        one.solids = {world.solids[static_cast<std::size_t>(found.obstacle)]};
      } else {
        links.links.push_back(set.links[static_cast<std::size_t>(found.other_link)]);
        links.pairs = {{0, 1}};
      }
      EXPECT_NEAR(testing::true_clearance(arm, links, one, q), found.distance, 1e-4);
    }
  }
}

TEST(FastChecker, LimitsAndNumbers) {
  const Arm arm = testing::panda();
  SphereSet set;
  set.links = {{"hand", 6, {{Eigen::Vector3d::Zero(), 0.05}}}};
  const auto checker = FastChecker::create(FastRobot::create(arm, set).value(), {}).value();
  std::vector<double> q(arm.home.data(), arm.home.data() + 7);
  EXPECT_TRUE(checker.is_free(q));
  q[3] = arm.limits.upper[3] + 1e-4;
  EXPECT_TRUE(checker.is_free(q));
  for (const double bad : {arm.limits.upper[3] + 3e-4, std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity(), -1e300}) {
    q[3] = bad;
    EXPECT_FALSE(checker.is_free(q)) << bad;
  }
  EXPECT_EQ(checker.clearance(as_span(arm.home)).link, -1);
}

TEST(FastChecker, PieceAtRestInAnObstacle) {
  const Arm arm = testing::panda();
  SphereSet set;
  set.links = {{"base", -1, {{{0, 0, 0.05}, 0.08}}}, {"hand", 6, {{{0, 0, 0.1}, 0.02}}}};
  Obstacles world;
  world.solids = {{"far", {{5, 5, 5}, Eigen::Matrix3d::Identity()}, BallShape{0.1}},
                  {"table", {{0, 0, -0.2}, Eigen::Matrix3d::Identity()}, BoxShape{{1, 1, 0.18}}}};
  const auto checker = FastChecker::create(FastRobot::create(arm, set).value(), world).value();
  ASSERT_TRUE(checker.fixed_overlap().has_value());
  EXPECT_EQ(checker.fixed_overlap()->link, 0);
  EXPECT_EQ(checker.fixed_overlap()->obstacle, 1);
  EXPECT_FALSE(checker.is_free(as_span(arm.home)));
}

/// Starts and goals of the public problems are what their file says.
void check_problem_states(const std::filesystem::path& file, int expected_valid) {
  const testing::PlanningProblems all = testing::read_problems(file);
  const auto robot = FastRobot::create(all.arm, all.set).value();
  int valid = 0;
  for (const testing::PlanningProblem& problem : all.problems) {
    const auto checker = FastChecker::create(robot, problem.obstacles).value();
    EXPECT_EQ(checker.is_free(problem.start), problem.start_free) << problem.id;
    for (std::size_t i = 0; i < problem.goals.size(); ++i) {
      EXPECT_EQ(checker.is_free(problem.goals[i]), problem.goals_free[i]) << problem.id;
    }
    valid += problem.valid ? 1 : 0;
  }
  EXPECT_EQ(valid, expected_valid);
}

TEST(FastChecker, StatesOfThePublicPandaProblems) {
  MJARM_TEST_FILE(file, "motionbenchmaker/mbm_panda_public.json.gz");
  check_problem_states(file, 350);
}

TEST(FastChecker, StatesOfThePublicUr5Problems) {
  MJARM_TEST_FILE(file, "motionbenchmaker/mbm_ur5_public.json.gz");
  check_problem_states(file, 342);
}

TEST(FastChecker, RandomStatesOfThePublicProblems) {
  for (const char* const name : {"panda", "ur5"}) {
    MJARM_TEST_FILE(file, std::string("motionbenchmaker/mbm_") + name + "_public.json.gz");
    const testing::PlanningProblems all = testing::read_problems(file);
    Rng rng(15);
    Tally tally;
    const int states = testing::rounds(120, 30'000, 6);
    for (std::size_t i = 0; i < all.problems.size(); i += 10) {
      compare(all.arm, all.set, all.problems[i].obstacles, kLevels[i / 10 % 3], rng, states, tally);
    }
    EXPECT_GT(tally.free, states * 25 / 6);
    EXPECT_GT(tally.blocked, states * 25 / 6);
  }
}

TEST(FastRobot, WhatItRefuses) {
  Arm arm = testing::panda();
  SphereSet set;
  set.links = {{"hand", 6, {{Eigen::Vector3d::Zero(), 0.05}}}};
  EXPECT_TRUE(FastRobot::create(arm, set).has_value());
  arm.joints.clear();
  EXPECT_EQ(FastRobot::create(arm, set).error().code, Errc::bad_input);
}

}  // namespace
}  // namespace mjarm
