#include <algorithm>

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

struct CloudPoint {
  float radius;
  int id;
};

void cover_point(const FastPoints& points, std::size_t i, FastBounds& bounds) {
  for (int k = 0; k < 3; ++k) {
    const double center = points.center[k][i], radius = points.radius[i];
    bounds.low[k] = std::min(bounds.low[k], round_down(center - radius));
    bounds.high[k] = std::max(bounds.high[k], round_up(center + radius));
  }
}

}  // namespace

void add_clouds(std::span<const PointCloud> clouds, const Eigen::Matrix3d& R_WF,
                const Eigen::Vector3d& middle_F, double reach, int first_id, FastWorld& out) {
  std::vector<Eigen::Vector3f> places;
  std::vector<CloudPoint> points;
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    for (const Eigen::Vector3d& p_W : clouds[i].points_W) {
      const Eigen::Vector3d p_F = R_WF.transpose() * p_W;
      const double radius = clouds[i].radius;
      if ((p_F - middle_F).norm() > reach + radius) continue;
      // What rounding does to its place.
      const double leak = 0x1p-22 * (p_F.norm() + radius);
      places.push_back(p_F.cast<float>());
      points.push_back({round_up(radius + leak), first_id + static_cast<int>(i)});
    }
  }
  const std::size_t leaves = (points.size() + kFan - 1) / kFan;
  out.points.assign(leaves, no_points());
  out.point_ids.assign(leaves * kFan, -1);
  std::vector<FastBounds> bounds(
      leaves, {Eigen::Vector3f::Constant(kFarAway), Eigen::Vector3f::Constant(-kFarAway)});
  std::size_t at = 0;
  for (const int from : curve_order(places)) {
    const auto i = static_cast<std::size_t>(from);
    FastPoints& leaf = out.points[at / kFan];
    for (int k = 0; k < 3; ++k) leaf.center[k][at % kFan] = places[i][k];
    leaf.radius[at % kFan] = points[i].radius;
    out.point_ids[at] = points[i].id;
    cover_point(leaf, at % kFan, bounds[at / kFan]);
    ++at;
  }
  out.clouds.build(bounds);
}

}  // namespace mjarm::detail
