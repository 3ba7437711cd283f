#include <algorithm>
#include <cmath>

#include "mjarm/collision/fast_world_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr float kFarAway = 1e18F;

FastPoints no_points() {
  FastPoints out;
  for (float* axis : out.center) std::fill_n(axis, kFan, kFarAway);
  std::fill_n(out.radius, kFan, 0.0F);
  return out;
}

/// A point within reach, in frame 0.
struct CloudPoint {
  float radius;
  int id;
};

struct ReachedPoints {
  std::vector<Eigen::Vector3f> places;
  std::vector<CloudPoint> points;

  void add(const PointCloud& cloud, int id, const Eigen::Matrix3d& R_FW,
           const Eigen::Vector3d& middle_F, double reach) {
    const double most2 = (reach + cloud.radius) * (reach + cloud.radius);
    for (const Eigen::Vector3d& p_W : cloud.points_W) {
      const Eigen::Vector3d p_F = R_FW * p_W;
      if ((p_F - middle_F).squaredNorm() > most2) continue;
      // What rounding does to the place and the radius.
      const double leak = 0x1p-22 * (p_F.lpNorm<1>() + cloud.radius);
      places.emplace_back(p_F.cast<float>());
      points.push_back({static_cast<float>(cloud.radius + leak), id});
    }
  }
};

/// Of the first `count` points of a leaf, with what rounding does.
FastBounds bounds_of(const FastPoints& leaf, std::size_t count) {
  FastBounds out;
  for (int k = 0; k < 3; ++k) {
    float low = kFarAway, high = -kFarAway;
    for (std::size_t i = 0; i < count; ++i) {
      const float center = leaf.center[k][i];
      const float half = leaf.radius[i] + 0x1p-22F * (std::abs(center) + leaf.radius[i]);
      low = std::min(low, center - half);
      high = std::max(high, center + half);
    }
    out.low[k] = low;
    out.high[k] = high;
  }
  return out;
}

}  // namespace

void add_clouds(std::span<const PointCloud> clouds, const Eigen::Matrix3d& R_WF,
                const Eigen::Vector3d& middle_F, double reach, int first_id, FastWorld& out) {
  ReachedPoints reached;
  const Eigen::Matrix3d R_FW = R_WF.transpose();
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    reached.add(clouds[i], first_id + static_cast<int>(i), R_FW, middle_F, reach);
  }
  const std::size_t count = reached.places.size();
  const std::size_t leaves = (count + kFan - 1) / kFan;
  const std::vector<int> order = curve_order(reached.places);
  out.points.assign(leaves, no_points());
  out.point_ids.assign(leaves * kFan, -1);
  std::vector<FastBounds> bounds(leaves);
  for (std::size_t l = 0; l < leaves; ++l) {
    FastPoints& leaf = out.points[l];
    const std::size_t size = std::min<std::size_t>(kFan, count - l * kFan);
    for (std::size_t i = 0; i < size; ++i) {
      const auto from = static_cast<std::size_t>(order[l * kFan + i]);
      for (int k = 0; k < 3; ++k) leaf.center[k][i] = reached.places[from][k];
      leaf.radius[i] = reached.points[from].radius;
      out.point_ids[l * kFan + i] = reached.points[from].id;
    }
    bounds[l] = bounds_of(leaf, size);
  }
  out.clouds.build(bounds);
}

double mark_clouds(FastWorld& out) {
  const auto cell = static_cast<float>(out.grid.cell_size());
  float lack = 0;
  for (std::size_t i = 0; i < out.point_ids.size(); ++i) {
    if (out.point_ids[i] < 0) continue;
    const FastPoints& leaf = out.points[i / kFan];
    const float radius = leaf.radius[i % kFan];
    const Eigen::Vector3f center(leaf.center[0][i % kFan], leaf.center[1][i % kFan],
                                 leaf.center[2][i % kFan]);
    const Eigen::Vector3f half = Eigen::Vector3f::Constant(std::min(radius, cell));
    lack = std::max(lack, radius - cell);
    out.grid.mark({center - half, center + half});
  }
  return lack;
}

}  // namespace mjarm::detail
