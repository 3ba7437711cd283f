#include "mjarm/collision/cover.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mjarm/collision/cover_cache_internal.hpp"
#include "mjarm/collision/cover_fit_internal.hpp"
#include "mjarm/collision/cover_geoms_internal.hpp"
#include "mjarm/collision/cover_pairs_internal.hpp"
#include "mjarm/core/messages/collision.hpp"
#include "mjarm/core/user_cache.hpp"

namespace mjarm {
namespace {

using detail::FittedCover;
using detail::GeomGroup;
using detail::GeomGroups;
using detail::GeomSolids;
using detail::StandingSolid;

constexpr double kWider = 1.4;  // a bound that takes too many spheres grows by this
constexpr int kMaxWider = 20;

/// Spheres for each link, with the smallest bound that takes no more than there may be.
std::optional<std::vector<FittedCover>> fit_links(
    const std::vector<std::vector<detail::CoverSolid>>& covers, double bound,
    const StopCheck& stop) {
  for (int round = 0; round < kMaxWider && !is_stopped(stop); ++round, bound *= kWider) {
    std::vector<FittedCover> out;
    std::size_t left = kMaxSpheres;
    for (const std::vector<detail::CoverSolid>& solids : covers) {
      auto fit = detail::fit_cover(solids, bound, left, stop);
      if (!fit) break;
      left -= fit->spheres.size();
      out.push_back(std::move(*fit));
    }
    if (out.size() == covers.size()) return out;
  }
  return {};
}

/// What `make()` gives, from the cache of the user where it is there.
/// @param read  of bytes; none where they are of something else.
template <class Make, class Read>
auto cached(const std::optional<UserCache>& cache, const std::string& key, const Read& read,
            const Make& make) -> decltype(make()) {
  if (cache) {
    if (const auto bytes = cache->find(key)) {
      if (auto known = read(*bytes)) return known;
    }
  }
  auto made = make();
  if (cache && made) cache->keep(key, detail::bytes_of(*made));
  return made;
}

/// The body with a free joint that a geom hangs on; empty for the arm's own and where there is
/// none.
std::string movable_of(const mjModel& m, int geom, int arm_root) {
  const int root = m.body_rootid[m.geom_bodyid[geom]];
  const int joint = m.body_jntadr[root];
  const bool free = joint >= 0 && m.jnt_type[joint] == mjJNT_FREE;
  return free && root != arm_root ? detail::body_name(m, root) : std::string();
}

/// The obstacles that some link can meet.
std::vector<StandingSolid> add_scene(const mjModel& m, const GeomGroups& groups,
                                     const GeomSolids& solids, const detail::Meetings& meetings,
                                     ModelCover& out) {
  std::vector<StandingSolid> standing;
  for (const detail::Meetings::Standing& meeting : meetings.standing) {
    const detail::PlacedGeom& placed = groups.obstacles[meeting.obstacle].geoms.front();
    const int index = static_cast<int>(out.scene.solids.size());
    out.scene.solids.push_back(detail::obstacle_of_geom(m, placed));
    out.scene.solids.back().movable = movable_of(m, placed.geom, groups.root);
    if (m.body_rootid[m.geom_bodyid[placed.geom]] == groups.root) out.standing.push_back(index);
    standing.push_back(solids.standing[meeting.obstacle]);
    standing.back().ignored.resize(groups.links.size());
    for (const int link : meeting.ignored) {
      out.scene.ignored.push_back({link, index});
      standing.back().ignored[static_cast<std::size_t>(link)] = 1;
    }
  }
  return standing;
}

}  // namespace

Result<ModelCover> cover_model(const Model& model, const Arm& arm, const CoverOptions& options) {
  const Result<GeomGroups> groups = detail::group_geoms(model, arm, options);
  if (!groups) return fail(groups.error());
  const mjModel& m = *model.raw();
  GeomSolids solids = solids_of_groups(m, arm, *groups);
  const std::optional<UserCache> cache = UserCache::of_user();
  ModelCover out;
  const auto fits = cached(
      cache, detail::key_of_covers(solids.covers, options.bound),
      [&](const std::string& bytes) { return detail::covers_of(bytes, solids.covers.size()); },
      [&] { return fit_links(solids.covers, options.bound, options.stop); });
  if (!fits) {
    if (is_stopped(options.stop)) return fail(stopped());
    return fail(Errc::bad_input,
                text(msg::collision_cover_spheres, arm.name, kMaxSpheres, kMaxSphereLinks));
  }
  for (std::size_t l = 0; l < fits->size(); ++l) {
    const GeomGroup& link = groups->links[l];
    out.bound = std::max(out.bound, (*fits)[l].bound);
    out.spheres.links.push_back({link.name, link.joint, (*fits)[l].spheres});
  }
  const detail::MeetingProof proof(m, arm, *groups, solids, options.rules);
  auto meetings = cached(
      cache, proof.key(),
      [&](const std::string& bytes) { return detail::meetings_of(bytes, *groups); },
      [&] { return find_meetings(proof, *groups, options.stop); });
  if (!meetings) return fail(stopped());
  out.pairs_apart = meetings->apart;
  out.spheres.pairs = std::move(meetings->pairs);
  auto standing = add_scene(m, *groups, solids, *meetings, out);
  out.solids = std::make_shared<const detail::SolidScene>(arm, std::move(solids.links),
                                                          std::move(standing), out.spheres.pairs);
  if (const Result<void> fine = check_sphere_set(out.spheres, arm); !fine)
    return fail(fine.error());
  return out;
}

}  // namespace mjarm
