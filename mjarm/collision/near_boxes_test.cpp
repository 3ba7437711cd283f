#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mjarm/collision/near_boxes_internal.hpp"
#include "mjarm/collision/random_scene_test.hpp"

namespace mjarm::detail {
namespace {

using Eigen::Vector3d;

/// None that is near is missed, of any size of scene, endless boxes included, and what is clearly
/// farther is not among them.
TEST(NearBoxes, AreThoseThatAreNear) {
  Rng rng(92);
  int near = 0, far = 0;
  for (const double size : {0.1, 1.0, 1000.0}) {
    for (const int count : {1, 3, 64, 65, 200}) {
      NearBoxes boxes;
      std::vector<std::array<Vector3d, 2>> all;
      for (int k = 0; k < count; ++k) {
        const Vector3d low = testing::random_vector(rng, size);
        const Vector3d high = low + testing::random_vector(rng, 0.3 * size).cwiseAbs();
        all.push_back({low, high});
        if (k == 1) all.back()[0].setConstant(-std::numeric_limits<double>::infinity());
        boxes.add(all.back()[0], all.back()[1]);
      }
      ASSERT_EQ(boxes.words(), static_cast<std::size_t>(count + 63) / 64);
      for (int round = 0; round < 20; ++round) {
        const Vector3d p = testing::random_vector(rng, size);
        for (std::size_t k = 0; k < all.size(); ++k) {
          const double apart =
              (all[k][0] - p).cwiseMax(p - all[k][1]).cwiseMax(Vector3d::Zero()).norm();
          const auto is_near = [&](double within) {
            return (boxes.near(k / 64, p, within) >> (k % 64) & 1) != 0;
          };
          EXPECT_TRUE(is_near(apart));
          ++near;
          if (apart < 1e-3 * size) continue;
          EXPECT_FALSE(is_near(0.9 * apart - 1e-4 * (1 + size)));
          ++far;
        }
      }
    }
  }
  EXPECT_GT(near, 3000);
  EXPECT_GT(far, 2000);
}

}  // namespace
}  // namespace mjarm::detail
