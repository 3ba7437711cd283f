#include "mjarm/collision/cover.hpp"

#include <algorithm>
#include <cmath>

#include "mjarm/collision/cover_fit_internal.hpp"
#include "mjarm/collision/cover_geoms_internal.hpp"
#include "mjarm/collision/cover_pairs_internal.hpp"
#include "mjarm/core/messages/collision.hpp"

namespace mjarm {
namespace {

using detail::CoverSolid;
using detail::GeomGroup;
using detail::GeomGroups;

constexpr double kWider = 1.4;  // a bound that takes too many spheres grows by this
constexpr int kMaxWider = 20;

std::vector<CoverSolid> solids_of(const mjModel& m, const GeomGroup& group) {
  std::vector<CoverSolid> out;
  for (const detail::PlacedGeom& placed : group.geoms) {
    out.push_back(detail::solid_of_geom(m, placed));
  }
  return out;
}

/// The links as spheres, with the smallest bound that takes no more than there may be.
bool add_spheres(const mjModel& m, const std::vector<GeomGroup>& links, double bound,
                 const StopCheck& stop, ModelCover& out) {
  for (int round = 0; round < kMaxWider && !is_stopped(stop); ++round, bound *= kWider) {
    out.spheres.links.clear();
    out.bound = 0;
    std::size_t left = kMaxSpheres;
    for (const GeomGroup& link : links) {
      const auto fit = detail::fit_cover(solids_of(m, link), bound, left, stop);
      if (!fit) break;
      left -= fit->spheres.size();
      out.bound = std::max(out.bound, fit->bound);
      out.spheres.links.push_back({link.name, link.joint, fit->spheres});
    }
    if (out.spheres.links.size() == links.size()) return true;
  }
  return false;
}

void add_pairs(detail::MeetingProof& proof, const GeomGroups& groups, const StopCheck& stop,
               ModelCover& out) {
  for (std::size_t a = 0; a < groups.links.size() && !is_stopped(stop); ++a) {
    for (std::size_t b = 0; b < groups.links.size(); ++b) {
      const GeomGroup& near = groups.links[a];
      const GeomGroup& far = groups.links[b];
      if (near.joint >= far.joint || !proof.is_allowed(near, far)) continue;
      if (proof.never_meet(near, far, b)) {
        ++out.pairs_apart;
      } else {
        out.spheres.pairs.push_back({static_cast<int>(a), static_cast<int>(b)});
      }
    }
  }
}

/// Obstacles that some link can meet, and the links that cannot.
void add_scene(const mjModel& m, detail::MeetingProof& proof, const GeomGroups& groups,
               const StopCheck& stop, ModelCover& out) {
  for (const GeomGroup& obstacle : groups.obstacles) {
    if (is_stopped(stop)) return;
    std::vector<int> ignored;
    for (std::size_t b = 0; b < groups.links.size(); ++b) {
      const bool allowed = proof.is_allowed(obstacle, groups.links[b]);
      const bool apart = allowed && proof.never_meet(obstacle, groups.links[b], b);
      out.pairs_apart += apart ? 1 : 0;
      if (!allowed || apart) ignored.push_back(static_cast<int>(b));
    }
    if (ignored.size() == groups.links.size()) continue;
    const int index = static_cast<int>(out.scene.solids.size());
    detail::SceneSolid solid = detail::obstacle_of_geom(m, obstacle.geoms.front());
    out.scene.solids.push_back(std::move(solid.obstacle));
    for (const int link : ignored) out.scene.ignored.push_back({link, index});
    if (solid.is_larger) out.larger.push_back(index);
    const int body = m.geom_bodyid[obstacle.geoms.front().geom];
    if (m.body_rootid[body] == groups.root) out.standing.push_back(index);
  }
}

}  // namespace

Result<ModelCover> cover_model(const Model& model, const Arm& arm, const CoverOptions& options) {
  const Result<GeomGroups> groups = detail::group_geoms(model, arm, options);
  if (!groups) return fail(groups.error());
  ModelCover out;
  if (!add_spheres(*model.raw(), groups->links, options.bound, options.stop, out)) {
    if (is_stopped(options.stop)) return fail(stopped());
    return fail(Errc::bad_input,
                text(msg::collision_cover_spheres, arm.name, kMaxSpheres, kMaxSphereLinks));
  }
  detail::MeetingProof proof(model, arm, *groups, options.rules);
  add_pairs(proof, *groups, options.stop, out);
  add_scene(*model.raw(), proof, *groups, options.stop, out);
  if (is_stopped(options.stop)) return fail(stopped());
  if (const Result<void> fine = check_sphere_set(out.spheres, arm); !fine)
    return fail(fine.error());
  return out;
}

}  // namespace mjarm
