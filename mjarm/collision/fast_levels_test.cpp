#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <utility>

#include "mjarm/collision/edge_check.hpp"
#include "mjarm/collision/edge_samples_test.hpp"
#include "mjarm/collision/fast_oracle_test.hpp"
#include "mjarm/collision/verify_edge.hpp"
#include "mjarm/kinematics/long_tests_test.hpp"

/// One question asked at every level of SIMD: the answers may differ by rounding alone.
namespace mjarm {
namespace {

using testing::kLevels;
using testing::random_rows;

struct LevelScene {
  Arm arm;
  SphereSet set;
  Obstacles world;
};

/// Solids in lists, in trees or none, now and then a cloud.
LevelScene level_scene(Rng& rng, int round) {
  LevelScene out{testing::random_arm(2 + round % 6, rng), {}, {}};
  out.set = testing::random_spheres(out.arm, rng);
  out.world =
      testing::random_world(rng, std::array{0, 6, 100}[static_cast<std::size_t>(round % 3)]);
  if (round % 4 == 0) out.world.solids.push_back(testing::random_composite(rng));
  if (round % 2 == 0) out.world.clouds.push_back(testing::random_cloud(rng, 30, 0.02));
  return out;
}

std::vector<FastChecker> checkers_of(const LevelScene& scene) {
  const FastRobot robot = FastRobot::create(scene.arm, scene.set).value();
  std::vector<FastChecker> out;
  for (const SimdLevel level : kLevels) {
    out.push_back(FastChecker::create(robot, scene.world, level).value());
  }
  return out;
}

TEST(FastLevels, NoneIsWiderThanTheMachine) {
  Rng rng(81);
  const std::vector<FastChecker> checkers = checkers_of(level_scene(rng, 1));
  EXPECT_EQ(checkers[0].width(), 4);
  for (std::size_t i = 0; i < kLevels.size(); ++i) {
    const int width = kLevels[i] <= simd_level() ? 4 << i : checkers[i - 1].width();
    EXPECT_EQ(checkers[i].width(), width);
  }
}

TEST(FastLevels, CallTheSameConfigurationsFree) {
  Rng rng(82);
  int differ = 0, free_of_all = 0;
  for (int round = 0; round < testing::rounds(60, 600); ++round) {
    const LevelScene scene = level_scene(rng, round);
    const std::vector<FastChecker> checkers = checkers_of(scene);
    const double padding = 2 * checkers[0].robot().padding() + 2e-6;
    const auto dof = static_cast<std::size_t>(scene.arm.dof());
    constexpr std::size_t kCount = 101;  // fills no register
    const std::vector<double> rows = random_rows(scene.arm, rng, kCount);
    std::array<std::vector<std::uint8_t>, 3> free;
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(checkers[i].fixed_overlap().has_value(), checkers[0].fixed_overlap().has_value());
      free[i].resize(kCount);
      checkers[i].check(rows, free[i]);
      const bool all =
          std::all_of(free[i].begin(), free[i].end(), [](auto one) { return one != 0; });
      EXPECT_EQ(checkers[i].all_free(rows), all);
    }
    for (std::size_t k = 0; k < kCount; ++k) {
      free_of_all += free[0][k];
      if (free[0][k] == free[1][k] && free[1][k] == free[2][k]) continue;
      ++differ;
      const std::span<const double> q(&rows[k * dof], dof);
      const double truth = testing::true_clearance(scene.arm, scene.set, scene.world, q);
      EXPECT_GT(truth, 0) << "some level calls it free";
      // Solid meshes are thicker where spheres are small.
      if (round % 4 != 0) {
        EXPECT_LT(truth, padding);
      }
    }
  }
  EXPECT_GT(free_of_all, 200);
  EXPECT_LT(differ, 5);
}

TEST(FastLevels, AgreeOnTheClearanceAndOnWhereItIsLeast) {
  Rng rng(83);
  for (int round = 0; round < testing::rounds(40, 400); ++round) {
    const LevelScene scene = level_scene(rng, round);
    const std::vector<FastChecker> checkers = checkers_of(scene);
    constexpr std::size_t kCount = 37;
    const std::vector<double> rows = random_rows(scene.arm, rng, kCount);
    std::vector<SphereClearance> narrow(kCount), wide(kCount);
    checkers[0].clearances(rows, narrow);
    const FastChecker::LeastClearance least = checkers[0].least_clearance(rows);
    for (std::size_t i = 1; i < 3; ++i) {
      checkers[i].clearances(rows, wide);
      for (std::size_t k = 0; k < kCount; ++k) {
        // Which of the overlaps is told, where there are some, is left open.
        if (narrow[k].distance < 1e-3 && wide[k].distance < 1e-3) continue;
        EXPECT_NEAR(wide[k].distance, narrow[k].distance, 1e-5);
      }
      const FastChecker::LeastClearance other = checkers[i].least_clearance(rows);
      if (least.nearest.distance < 1e-3 && other.nearest.distance < 1e-3) continue;
      EXPECT_NEAR(other.nearest.distance, least.nearest.distance, 1e-5);
    }
  }
}

/// One edge, there and back, at one level; @return what is known of it.
EdgeVerdict look_both_ways(const LevelScene& scene, const FastChecker& checker, const JointVec& q0,
                           const JointVec& q1, double thick) {
  const double near = 2 * checker.robot().padding() + 2e-6 + thick;
  const EdgeResult there = check_edge(checker, as_span(q0), as_span(q1));
  const EdgeResult back = check_edge(checker, as_span(q1), as_span(q0));
  for (const auto& [verdict, t] : {std::pair(there.verdict, there.t), {back.verdict, 1 - back.t}}) {
    EXPECT_NE(verdict, EdgeVerdict::outside);
    if (verdict != EdgeVerdict::hit || checker.fixed_overlap()) continue;
    const std::vector<double> q = testing::on_edge(as_span(q0), as_span(q1), t);
    EXPECT_LT(testing::true_clearance(scene.arm, scene.set, scene.world, q), near) << "at " << t;
  }
  if (there.verdict != EdgeVerdict::free) return there.verdict;
  const auto second = verify_edge(scene.arm, scene.set, scene.world, as_span(q0), as_span(q1),
                                  {.max_looks = 100'000});
  EXPECT_TRUE(second.has_value() && second->verdict != EdgeVerdict::hit);
  return there.verdict;
}

TEST(FastLevels, NeverContradictTheVerifierOnEdges) {
  Rng rng(84);
  int proved = 0, refuted = 0;
  for (int round = 0; round < testing::rounds(40, 400); ++round) {
    const LevelScene scene = level_scene(rng, round);
    const double thick = round % 4 == 0 ? 0.01 : 0;  // solid meshes are, where spheres are small
    const std::vector<FastChecker> checkers = checkers_of(scene);
    for (int k = 0; k < 6; ++k) {
      const JointVec q0 = testing::random_q(scene.arm, rng);
      const JointVec q1 = q0 + rng.uniform(0.02, 0.5) * (testing::random_q(scene.arm, rng) - q0);
      for (const FastChecker& checker : checkers) {
        const EdgeVerdict verdict = look_both_ways(scene, checker, q0, q1, thick);
        proved += verdict == EdgeVerdict::free ? 1 : 0;
        refuted += verdict == EdgeVerdict::hit ? 1 : 0;
      }
    }
  }
  EXPECT_GT(proved, 50);
  EXPECT_GT(refuted, 50);
}

}  // namespace
}  // namespace mjarm
