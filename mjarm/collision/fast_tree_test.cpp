#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "mjarm/collision/fast_grid_internal.hpp"
#include "mjarm/collision/fast_tree_internal.hpp"
#include "mjarm/collision/random_scene_test.hpp"

namespace mjarm {
namespace {

using detail::FastBounds;
using detail::FastNode;
using detail::FastTree;
using detail::kFan;

std::vector<FastBounds> random_boxes(Rng& rng, std::size_t count) {
  std::vector<FastBounds> out;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3f low = testing::random_vector(rng, 1).cast<float>();
    const Eigen::Vector3f size = testing::random_vector(rng, 0.1).cast<float>().cwiseAbs();
    out.push_back({low, low + size});
  }
  return out;
}

TEST(CurveOrder, NamesEveryPlaceOnceAndKeepsNeighboursTogether) {
  Rng rng(71);
  for (const std::size_t count : {0, 1, 2, 700, 3000}) {
    std::vector<Eigen::Vector3f> places;
    for (std::size_t i = 0; i < count; ++i) {
      places.push_back(testing::random_vector(rng, 5).cast<float>());
    }
    const std::vector<int> order = detail::curve_order(places);
    std::vector<int> sorted = order, every(count);
    std::sort(sorted.begin(), sorted.end());
    std::iota(every.begin(), every.end(), 0);
    EXPECT_EQ(sorted, every);
    if (count < 700) continue;
    double along = 0, anyhow = 0;  // [m] from one to the next, on the curve and as they came
    for (std::size_t i = 1; i < count; ++i) {
      const auto place = [&](std::size_t k) { return places[static_cast<std::size_t>(order[k])]; };
      along += (place(i) - place(i - 1)).norm();
      anyhow += (places[i] - places[i - 1]).norm();
    }
    EXPECT_LT(along, 0.3 * anyhow);
  }
}

TEST(CurveOrder, PlacesThatAreOneStayInTheirOrder) {
  for (const std::size_t count : {5, 2000}) {  // sorted by comparing, and by digits
    const std::vector<Eigen::Vector3f> places(count, Eigen::Vector3f(1, 2, 3));
    const std::vector<int> order = detail::curve_order(places);
    EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
  }
}

TEST(FastTree, EveryBoxHoldsThoseBelowIt) {
  Rng rng(72);
  for (const std::size_t count : {1, 16, 17, 256, 257, 5000}) {
    const std::vector<FastBounds> leaves = random_boxes(rng, count);
    detail::FastTreeNodes nodes;
    nodes.build(leaves);
    const FastTree tree = nodes.tables();
    ASSERT_GT(tree.levels, 0);
    EXPECT_EQ(nodes.levels[tree.levels - 1].size(), 1U);
    std::size_t below = count;
    for (int level = 0; level < tree.levels; ++level) {
      for (std::size_t i = 0; i < below; ++i) {
        const FastNode& node = tree.nodes[level][i / kFan];
        for (int k = 0; k < 3; ++k) {
          if (level == 0) {
            EXPECT_EQ(node.low[k][i % kFan], leaves[i].low[k]);
            EXPECT_EQ(node.high[k][i % kFan], leaves[i].high[k]);
            continue;
          }
          const FastNode& child = tree.nodes[level - 1][i];
          EXPECT_EQ(node.low[k][i % kFan], *std::min_element(child.low[k], child.low[k] + kFan));
          EXPECT_EQ(node.high[k][i % kFan], *std::max_element(child.high[k], child.high[k] + kFan));
        }
      }
      below = (below + kFan - 1) / kFan;
    }
    EXPECT_EQ(below, 1U);
  }
  detail::FastTreeNodes none;
  none.build({});
  EXPECT_EQ(none.tables().levels, 0);
}

/// What the kernels read of a grid, in double precision.
double distance_bound(const detail::FastGrid& grid, const Eigen::Vector3d& p) {
  std::size_t at = 0;
  for (int k = 2; k >= 0; --k) {
    const double cell = std::floor((p[k] - grid.low[k]) * grid.per_meter);
    at = at * static_cast<std::size_t>(grid.side) +
         static_cast<std::size_t>(std::clamp(cell, 0.0, grid.side - 1.0));
  }
  return grid.cells[at] * static_cast<double>(grid.unit) - static_cast<double>(grid.slack);
}

double distance_to_bounds(const FastBounds& box, const Eigen::Vector3d& p) {
  const Eigen::Vector3d low = box.low.cast<double>(), high = box.high.cast<double>();
  return (p - p.cwiseMax(low).cwiseMin(high)).norm();
}

TEST(FastGrid, NeverSaysMoreThanTheDistanceAndRulesOutMostOfTheRoom) {
  Rng rng(73);
  for (const std::size_t count : {1, 20, 400}) {
    const std::vector<FastBounds> boxes = random_boxes(rng, count);
    for (const double lack : {0.0, 0.05}) {
      detail::FastGridCells cells({0.1, -0.2, 0}, 1.2, count);
      for (const FastBounds& box : boxes) cells.mark(box);
      cells.finish(lack);
      int ruled_out = 0;
      for (int i = 0; i < 3000; ++i) {
        const Eigen::Vector3d p = testing::random_vector(rng, 2);  // within the grid and outside
        double truth = std::numeric_limits<double>::infinity();
        for (const FastBounds& box : boxes) truth = std::min(truth, distance_to_bounds(box, p));
        const double bound = distance_bound(cells.tables(), p);
        EXPECT_LE(bound, std::max(truth - lack, 0.0) + 1e-9);
        ruled_out += bound > 0 ? 1 : 0;
      }
      EXPECT_GT(ruled_out, count > 100 ? 20 : 300) << count << ' ' << lack;
    }
  }
}

TEST(FastGrid, TooMuchWorkRulesNothingOut) {
  const Eigen::Vector3f far(10, 10, 10);
  detail::FastGridCells cells({0, 0, 0}, 1, 1);
  for (int i = 0; i < 400; ++i) cells.mark({-far, far}, [](const auto&) { return false; });
  cells.finish(0);
  Rng rng(74);
  for (int i = 0; i < 1000; ++i) {
    EXPECT_LE(distance_bound(cells.tables(), testing::random_vector(rng, 2)), 0);
  }
}

}  // namespace
}  // namespace mjarm
