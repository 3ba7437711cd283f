#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "mjarm/collision/fast_check.hpp"
#include "mjarm/collision/random_scene_test.hpp"

/// Holds the answers of the fast checker against the oracle.
namespace mjarm::testing {

inline constexpr std::array kLevels{SimdLevel::baseline, SimdLevel::avx2, SimdLevel::avx512};

inline std::vector<double> random_rows(const Arm& arm, Rng& rng, int count) {
  std::vector<double> rows;
  for (int i = 0; i < count; ++i) {
    const JointVec q = random_q(arm, rng);
    rows.insert(rows.end(), q.data(), q.data() + q.size());
  }
  return rows;
}

struct Tally {
  int free = 0, blocked = 0, padded = 0;
};

/// How far answers may be from the oracle.
struct Slack {
  double extent = 1;  ///< [m] of the largest solid and its distance, which cost digits
  double thick = 0;   ///< [m] by which solid meshes are thicker where spheres are small
};

/// Holds the answers of one level for random configurations against the oracle.
inline void compare(const Arm& arm, const SphereSet& set, const Obstacles& world, SimdLevel level,
                    Rng& rng, int count, Tally& tally, const Slack& slack = {}) {
  const auto robot = FastRobot::create(arm, set);
  ASSERT_TRUE(robot.has_value()) << robot.error().what;
  const auto checker = FastChecker::create(*robot, world, level);
  ASSERT_TRUE(checker.has_value()) << checker.error().what;
  EXPECT_LT(robot->padding(), 4e-4);
  const auto dof = static_cast<std::size_t>(arm.dof());
  const std::vector<double> rows = random_rows(arm, rng, count);
  std::vector<std::uint8_t> free(static_cast<std::size_t>(count));
  checker->check(rows, free);
  std::vector<SphereClearance> clearances(free.size());
  checker->clearances(rows, clearances);
  const FastChecker::LeastClearance least = checker->least_clearance(rows);
  const auto nearest = std::min_element(
      clearances.begin(), clearances.end(),
      [](const SphereClearance& a, const SphereClearance& b) { return a.distance < b.distance; });
  EXPECT_EQ(least.nearest.link >= 0, least.nearest.distance < 1);
  double least_gap = 1;
  const double pad = 2 * robot->padding() + 2e-6 * slack.extent + slack.thick;
  for (std::size_t i = 0; i < free.size(); ++i) {
    const std::span<const double> q(&rows[i * dof], dof);
    const double truth = true_clearance(arm, set, world, q);
    if (free[i] != 0) {
      ++tally.free;
      ASSERT_GT(truth, 0) << "called free";
    } else {
      ++tally.blocked;
      ASSERT_LT(truth, pad) << "called blocked";
      tally.padded += truth > 0 ? 1 : 0;
    }
    EXPECT_EQ(checker->is_free(q), free[i] != 0);
    const double gap = true_clearance(arm, set, world, q, true);
    least_gap = std::min(least_gap, gap);
    const double bound = clearances[i].distance;
    EXPECT_LE(bound, std::max(gap, 0.0) + 1e-9);
    EXPECT_GT(bound, std::min(gap, 0.99) - pad - 1e-6 - 1e-6 * slack.extent);
    EXPECT_EQ(clearances[i].link >= 0, bound < 1);
  }
  // Overlaps are told by different spheres: how deep they are is not.
  if (nearest->distance > 0) {
    EXPECT_GE(least.nearest.distance, nearest->distance);
  } else {
    EXPECT_LT(least.nearest.distance, pad);
  }
  // Where the box round a polytope says more than its planes, the bound of all is the better one.
  if (least.nearest.distance > std::max(least_gap, 0.0) + 1e-9) {
    double exact = 1;
    for (std::size_t i = 0; i < free.size(); ++i) {
      const std::span<const double> q(&rows[i * dof], dof);
      exact = std::min(exact, true_clearance(arm, set, world, q, true, exact_point_distance));
    }
    EXPECT_LE(least.nearest.distance, std::max(exact, 0.0) + 1e-7);
  }
}

}  // namespace mjarm::testing
