#include <gtest/gtest.h>

#include <numbers>

#include "mjarm/collision/cover_fit_internal.hpp"
#include "mjarm/collision/random_scene_test.hpp"

namespace mjarm::detail {
namespace {

using Eigen::Vector3d;

/// A tetrahedron with a corner in the origin.
CoverSolid wedge(double size) {
  CoverSolid out;
  out.kind = SolidKind::hull;
  out.points = {{0, 0, 0}, {size, 0, 0}, {0, size, 0}, {0, 0, size}};
  for (const std::array<int, 3>& corners : {std::array{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}}) {
    out.triangles.push_back(hull_triangle(out.points, corners));
  }
  out.facets = Facets({{-Vector3d::UnitX(), 0},
                       {-Vector3d::UnitY(), 0},
                       {-Vector3d::UnitZ(), 0},
                       {Vector3d::Constant(1 / std::numbers::sqrt3), size / std::numbers::sqrt3}});
  return out;
}

CoverSolid random_solid(Rng& rng) {
  const auto kind = static_cast<SolidKind>(rng.below(6));
  CoverSolid out;
  if (kind == SolidKind::hull) out = wedge(rng.uniform(0.03, 0.15));
  out.kind = kind;
  out.X_LS = {testing::random_vector(rng, 0.08), from_euler(testing::random_vector(rng, 3))};
  for (int k = 0; k < 3; ++k) out.size[k] = rng.uniform(0.004, 0.1);
  return out;
}

/// Distance from a point to a solid, by steps downhill from its middle; the solid is convex.
double distance_by_walking(const CoverSolid& solid, const Vector3d& p) {
  if (solid.kind != SolidKind::hull) return std::max(solid.signed_distance(p), 0.0);
  Vector3d x = solid.X_LS.p;  // projections on all half-spaces in turn (Dykstra)
  std::vector<Vector3d> shifts(solid.facets.size(), Vector3d::Zero());
  x = p;
  for (int round = 0; round < 500; ++round) {
    for (std::size_t f = 0; f < shifts.size(); ++f) {
      const Vector3d normal = solid.X_LS.R * solid.facets[f].normal;
      const Vector3d y = x + shifts[f];
      const double beyond = normal.dot(y - solid.X_LS.p) - solid.facets[f].offset;
      x = beyond > 0 ? Vector3d(y - beyond * normal) : y;
      shifts[f] = y - x;
    }
  }
  return (x - p).norm();
}

bool is_covered(std::span<const Sphere> spheres, const Vector3d& p) {
  return std::any_of(spheres.begin(), spheres.end(), [&](const Sphere& sphere) {
    return (sphere.center - p).norm() <= sphere.radius;
  });
}

Vector3d random_point(const CoverBounds& bounds, Rng& rng) {
  const Vector3d share(rng.uniform(), rng.uniform(), rng.uniform());
  return bounds.low + share.cwiseProduct(bounds.high - bounds.low);
}

TEST(CoverFit, ContainsTheSolidsAndSticksOutByNoMoreThanTheBound) {
  Rng rng(311);
  int inside = 0;
  for (int round = 0; round < 12; ++round) {
    std::vector<CoverSolid> solids;
    for (std::uint64_t k = 0; k <= rng.below(3); ++k) solids.push_back(random_solid(rng));
    const double bound = rng.uniform(0.01, 0.03);
    const auto fit = fit_cover(solids, bound, 512);
    ASSERT_TRUE(fit.has_value()) << "round " << round;
    EXPECT_LE(fit->bound, bound * (1 + 1e-9));
    const CoverBounds bounds = bounds_of(solids);
    for (int k = 0; k < 2000; ++k) {
      const Vector3d p = random_point(bounds, rng);
      if (depth_in(solids, p) < 0) continue;
      ++inside;
      ASSERT_TRUE(is_covered(fit->spheres, p)) << "round " << round;
    }
    for (const Sphere& sphere : fit->spheres) {
      for (int k = 0; k < 20; ++k) {
        const Vector3d p =
            sphere.center + sphere.radius * testing::random_vector(rng, 1).normalized();
        double least = 1;
        for (const CoverSolid& solid : solids)
          least = std::min(least, distance_by_walking(solid, p));
        ASSERT_LE(least, fit->bound + 1e-6) << "round " << round;
      }
    }
  }
  EXPECT_GT(inside, 2000);
}

TEST(CoverFit, CapsulesAreRowsOfSpheres) {
  CoverSolid capsule;
  capsule.kind = SolidKind::capsule;
  capsule.size = {0.05, 0.2, 0};
  // Each sphere of radius 62 mm covers 73 mm of the length, the first begins 12 mm from the end.
  const auto fit = fit_cover({&capsule, 1}, 0.012, 512);
  ASSERT_TRUE(fit.has_value());
  EXPECT_GE(fit->spheres.size(), 7U);
  EXPECT_LE(fit->spheres.size(), 8U);
}

TEST(CoverFit, SaysWhereMoreSpheresAreNeeded) {
  CoverSolid box;
  box.kind = SolidKind::box;
  box.size = {0.2, 0.2, 0.01};
  EXPECT_FALSE(fit_cover({&box, 1}, 0.005, 10).has_value());
}

/// A proof that can fail: every sphere is needed.
TEST(SealCover, FindsTheGapOfEverySphereThatIsTakenAway) {
  Rng rng(312);
  for (int round = 0; round < 6; ++round) {
    const CoverSolid solid = random_solid(rng);
    const auto fit = fit_cover({&solid, 1}, 0.02, 512);
    ASSERT_TRUE(fit.has_value());
    std::vector<Sphere> spheres = fit->spheres;
    EXPECT_TRUE(seal_cover({&solid, 1}, spheres, 0.02).empty());
    if (spheres.size() < 2) continue;
    spheres.erase(spheres.begin() + static_cast<std::ptrdiff_t>(rng.below(spheres.size())));
    const std::vector<Vector3d> gaps = seal_cover({&solid, 1}, spheres, 0.02);
    ASSERT_FALSE(gaps.empty()) << "round " << round;
    for (const Vector3d& gap : gaps) EXPECT_LT(solid.signed_distance(gap), 1e-6);
  }
}

/// Distances of a solid, by drawing points: inside, no point of the surface is nearer.
TEST(CoverSolid, EllipsoidDistancesAreThoseOfTheNearestPoint) {
  Rng rng(313);
  for (int round = 0; round < 50; ++round) {
    CoverSolid solid;
    solid.kind = SolidKind::ellipsoid;
    solid.size = {rng.uniform(0.02, 0.1), rng.uniform(0.02, 0.1), rng.uniform(0.02, 0.1)};
    Vector3d p = testing::random_vector(rng, 0.12);
    if (round % 5 == 0) p[static_cast<Eigen::Index>(rng.below(3))] = 0;
    if (round % 7 == 0) p.setZero();
    double least = 1;
    for (int k = 0; k < 20'000; ++k) {
      const Vector3d n = testing::random_vector(rng, 1).normalized();
      least = std::min(least, (n.cwiseProduct(solid.size) - p).norm());
    }
    const bool outside = p.cwiseQuotient(solid.size).norm() > 1;
    const double distance = solid.signed_distance(p);
    EXPECT_EQ(distance > 0, outside);
    EXPECT_LE(std::abs(distance), least + 1e-9);
    EXPECT_NEAR(std::abs(distance), least, 2e-3);
  }
}

}  // namespace
}  // namespace mjarm::detail
