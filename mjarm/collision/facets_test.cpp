#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mjarm/collision/facets_internal.hpp"
#include "mjarm/collision/random_scene_test.hpp"

namespace mjarm::detail {
namespace {

using Eigen::Vector3d;

double one_by_one(const std::vector<Facet>& all, const Vector3d& p) {
  double max = -std::numeric_limits<double>::infinity();
  for (const auto& [n, offset] : all) {
    max = std::max(max, n.x() * p.x() + n.y() * p.y() + n.z() * p.z() - offset);
  }
  return max;
}

/// Of one facet to thousands, round and flat, near the origin and far from it: the same to the last
/// bit wherever one looks from.
TEST(Facets, FarthestIsThatOfAllOneByOne) {
  Rng rng(91);
  for (const int count : {1, 3, 16, 17, 100, 700, 5000}) {
    const Vector3d center = testing::random_vector(rng, count == 100 ? 100 : 0.1);
    const Vector3d shape(0.1, rng.uniform(0.001, 0.1), 0.3);
    std::vector<Facet> all;
    for (int k = 0; k < count; ++k) {
      const Vector3d n = testing::random_vector(rng, 1).normalized();
      all.push_back({n, n.dot(center) + n.cwiseProduct(shape).norm()});
    }
    const Facets facets(all);
    ASSERT_EQ(facets.size(), all.size());
    for (int k = 0; k < 200; ++k) {
      const Vector3d p = center + testing::random_vector(rng, std::pow(10, rng.uniform(-3, 1)));
      ASSERT_EQ(facets.farthest(p), one_by_one(all, p)) << count;
    }
    for (std::size_t k = 0; k < all.size(); ++k) ASSERT_EQ(facets[k].offset, all[k].offset);
  }
  EXPECT_EQ(Facets().farthest(Vector3d::Zero()), -std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace mjarm::detail
