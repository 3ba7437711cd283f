#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/planning/problem_file.hpp"
#include "mjarm/planning/sampler_internal.hpp"
#include "tests/support/test_data.hpp"

namespace mjarm {
namespace {

/// Two hinges that are free everywhere; the first turns by 0.25 rad only.
FastChecker free_hinges() {
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const Arm arm = testing::make_arm(
      "hinges", {{{0, 0, 0}, {0, 0, 0}, z, -0.25, 0.25}, {{0.5, 0, 0}, {0, 0, 0}, z, -3, 3}},
      {{0.5, 0, 0}, Eigen::Matrix3d::Identity()});
  SphereSet set;
  set.links.push_back({"hand", 1, {{{0.1, 0, 0}, 0.02}}});
  return FastChecker::create(FastRobot::create(arm, set).value(), {}).value();
}

TEST(Sampler, BesideANodeIsWithinTheLimitsAndOftenAtThem) {
  const FastChecker checker = free_hinges();
  const std::vector<double> start{0.25, 3};
  const detail::SearchProblem problem{checker, start, {start}, {0}};
  Rng rng(3);
  detail::Sampler sampler(problem, rng);
  std::array<int, 2> at_limit{};
  double first = 0, widest = 0;
  for (int k = 0; k < 2000; ++k) {
    std::array<double, 2> q;
    sampler.beside(start, q);
    ASSERT_LE(std::abs(q[0]), 0.25);
    ASSERT_LE(std::abs(q[1]), 3);
    for (std::size_t i = 0; i < 2; ++i) at_limit[i] += q[i] == start[i] ? 1 : 0;
    if (k < 10) first = std::max(first, 3 - q[1]);
    widest = std::max(widest, 3 - q[1]);
  }
  for (const int count : at_limit) EXPECT_NEAR(count, 1000, 150);
  EXPECT_LT(first, 0.8);  // 0.7 rad and 0.01 a sample
  EXPECT_GT(widest, 1.9);
  EXPECT_LE(widest, 2);
}

TEST(RrtConnect, GetsOutOfNarrowCagesWithFewSamples) {
  MJARM_TEST_FILE(path, "motionbenchmaker/mbm_ur5_public.json.gz");
  const auto file = read_problem_file(path.string());
  ASSERT_TRUE(file) << file.error().what;
  const FastRobot robot = FastRobot::create(file->arm, file->spheres).value();
  std::vector<int> samples;
  for (const PlanProblem& problem : file->problems) {
    if (problem.scene != "cage") continue;
    const FastChecker checker = FastChecker::create(robot, problem.obstacles).value();
    const auto found = find_path(checker, problem.start, problem.goals);
    ASSERT_TRUE(found) << problem.id;
    samples.push_back(found->counts.samples);
    // Nearly all steps fail; only what seems free is proved.
    EXPECT_LT(found->counts.edges, found->counts.samples) << problem.id;
  }
  ASSERT_EQ(samples.size(), 50U);
  std::ranges::sort(samples);
  EXPECT_LT(samples[25], 900);
  EXPECT_LT(samples.back(), 5000);
}

}  // namespace
}  // namespace mjarm
