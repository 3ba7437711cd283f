#include <algorithm>
#include <limits>

#include "mjarm/collision/cover_pairs_internal.hpp"
#include "mjarm/collision/fast_robot_internal.hpp"

namespace mjarm::detail {
namespace {

using Eigen::Vector3d;

StandingSolid standing_solid(const mjModel& m, const PlacedGeom& placed) {
  StandingSolid out;
  out.X_WO = placed.X_LG;
  const int type = m.geom_type[placed.geom];
  if (type == mjGEOM_PLANE) {
    out.kind = StandingSolid::Kind::half_space;
    out.high = Vector3d::Constant(std::numeric_limits<double>::infinity());
    out.low = -out.high;
    return out;
  }
  if (type == mjGEOM_HFIELD) {
    out.kind = StandingSolid::Kind::ground;
    out.ground = std::get<HeightFieldShape>(obstacle_of_geom(m, placed).shape);
    const auto& heights = out.ground.heights;
    const Vector3d high(out.ground.half.x(), out.ground.half.y(),
                        *std::max_element(heights.begin(), heights.end()));
    const CoverBounds box =
        bounds_in_world(placed.X_LG, {{-high.x(), -high.y(), out.ground.bottom}, high});
    out.low = box.low;
    out.high = box.high;
    return out;
  }
  const CoverSolid solid = solid_of_geom(m, placed);
  const CoverBounds box = bounds_of({&solid, 1});
  out.low = box.low;
  out.high = box.high;
  out.convex.emplace(solid);
  return out;
}

}  // namespace

GeomSolids solids_of_groups(const mjModel& m, const Arm& arm, const GeomGroups& groups) {
  GeomSolids out;
  SphereSet skeletons;
  for (const GeomGroup& link : groups.links) {
    std::vector<CoverSolid>& covers = out.covers.emplace_back();
    for (const PlacedGeom& placed : link.geoms) {
      const CoverSolid& solid = covers.emplace_back(solid_of_geom(m, placed));
      const int index = static_cast<int>(out.covers.size()) - 1;
      out.links.push_back({Convex(solid), index, link.joint, {}});
      skeletons.links.push_back({link.name, link.joint, {}});
      for (const Vector3d& p : solid.skeleton()) {
        skeletons.links.back().spheres.push_back({p, 0.001});
      }
    }
  }
  const LinkChain chain{Chain(arm)};
  const auto points = spheres_in_bodies(skeletons, arm, chain);
  for (std::size_t k = 0; k < out.links.size(); ++k) {
    out.links[k].levers = group_bounds(arm, chain, out.links[k].joint + 1, points[k]).levers;
  }
  for (const GeomGroup& obstacle : groups.obstacles) {
    out.standing.push_back(standing_solid(m, obstacle.geoms.front()));
  }
  return out;
}

}  // namespace mjarm::detail
