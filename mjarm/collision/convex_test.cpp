#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mjarm/collision/convex_internal.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"

namespace mjarm::detail {
namespace {

using Eigen::Vector3d;

Vector3d any_vector(Rng& rng, double size) {
  return {rng.uniform(-size, size), rng.uniform(-size, size), rng.uniform(-size, size)};
}

Pose any_pose(Rng& rng, double size) {
  return {any_vector(rng, size), rotation_exp(any_vector(rng, 3))};
}

CoverSolid any_convex(Rng& rng) {
  static constexpr SolidKind kKinds[] = {SolidKind::ball, SolidKind::capsule, SolidKind::box,
                                         SolidKind::cylinder, SolidKind::ellipsoid};
  CoverSolid out;
  out.kind = kKinds[rng.below(5)];
  out.X_LS = any_pose(rng, 0.1);
  out.size = {rng.uniform(0.01, 0.1), rng.uniform(0.01, 0.1), rng.uniform(0.01, 0.1)};
  return out;
}

/// The nearest two points, by going back and forth between the solids along ever shorter steps.
double slow_distance(const Convex& a, const Pose& X_WA, const Convex& b, const Pose& X_WB) {
  // Frank and Wolfe's steps with line search: slow, and simple enough to be trusted.
  int hint_a = 0, hint_b = 0;
  const Pose X_WS = X_WA * a.frame(), X_WT = X_WB * b.frame();
  Vector3d v = X_WA * a.center() - X_WB * b.center();
  for (int step = 0; step < 20'000; ++step) {
    const Vector3d n = v.normalized();
    const Vector3d w = X_WS * a.farthest(-(X_WS.R.transpose() * n), hint_a) -
                       X_WT * b.farthest(X_WT.R.transpose() * n, hint_b);
    const Vector3d way = w - v;
    if (way.squaredNorm() == 0) break;
    const double t = std::clamp(-v.dot(way) / way.squaredNorm(), 0.0, 1.0);
    v += t * way;
    if (v.norm() < 1e-6) return 0;
  }
  return v.norm();
}

TEST(Convex, DistancesAreThoseOfASlowSearch) {
  Rng rng(410);
  int apart = 0, overlapping = 0;
  for (int round = 0; round < 300; ++round) {
    const Convex a(any_convex(rng)), b(any_convex(rng));
    const Pose X_WA = any_pose(rng, 0.15), X_WB = any_pose(rng, 0.15);
    const Separation found = separate(a, X_WA, b, X_WB);
    const double slow = slow_distance(a, X_WA, b, X_WB);
    if (found.distance == 0) {
      EXPECT_LT(slow, 2e-3) << round;
      ++overlapping;
      continue;
    }
    ++apart;
    EXPECT_GE(found.gap, found.distance * (1 - 1e-5)) << round;
    EXPECT_NEAR(found.distance, slow, 2e-3) << round;
    EXPECT_LE(found.gap, slow + 1e-9) << round;
    const Separation back = separate(b, X_WB, a, X_WA);
    EXPECT_NEAR(back.gap, found.gap, 1e-5 * found.gap) << round;
    EXPECT_LT((back.normal + found.normal).norm(), 1e-2) << round;
  }
  EXPECT_GT(apart, 50);
  EXPECT_GT(overlapping, 20);
}

TEST(Convex, StopsWhereItsLimitsSay) {
  Rng rng(411);
  int near = 0, enough = 0;
  for (int round = 0; round < 20'000; ++round) {
    const Convex a(any_convex(rng)), b(any_convex(rng));
    const Pose X_WA = any_pose(rng, 0.2), X_WB = any_pose(rng, 0.2);
    const double whole = separate(a, X_WA, b, X_WB).gap;
    const double limit = rng.uniform(0, 0.2);
    const Separation cut = separate(a, X_WA, b, X_WB, {.enough = limit, .too_near = limit});
    if (whole > limit + 1e-6) {
      ASSERT_GT(cut.gap, limit) << round;
      ++enough;
    } else if (whole < limit - 1e-6) {
      ASSERT_LE(cut.distance, limit) << round;
      ++near;
    }
  }
  EXPECT_GT(near, 1000);
  EXPECT_GT(enough, 1000);
}

}  // namespace
}  // namespace mjarm::detail
