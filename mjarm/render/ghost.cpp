#include <algorithm>

#include "mjarm/core/finite.hpp"
#include "mjarm/render/ghost_internal.hpp"
#include "mjarm/sim/raw_state.hpp"

namespace mjarm::render {
namespace {

bool is_usable(const OverlayGhost& ghost) {
  return ghost.qpos.size() == ghost.qpos_index.size() && all_finite(ghost.qpos);
}

/// Geoms only: no labels, frames, sites or anything that would need forces.
mjvOption only_geoms(const mjvOption& option) {
  mjvOption plain = option;
  std::fill_n(plain.flags, static_cast<int>(mjNVISFLAG), mjtByte{0});
  std::fill_n(plain.sitegroup, mjNGROUP, mjtByte{0});
  plain.flags[mjVIS_CONVEXHULL] = option.flags[mjVIS_CONVEXHULL];
  plain.label = mjLABEL_NONE;
  plain.frame = mjFRAME_NONE;
  return plain;
}

/// Moves what may stand in the robot itself towards the camera, so that the two do not flicker
/// through each other.
void lift(mjvGeom& geom, const mjvGLCamera& camera) {
  constexpr float kLift = 0.002F;  // [m]
  for (int i = 0; i < 3; ++i) geom.pos[i] -= kLift * camera.forward[i];
}

/// One colour for all, so that the ghost is not taken for the robot.
void tint(mjvGeom& geom, const Rgba& color) {
  const float rgba[4] = {color.r, color.g, color.b, color.a};
  std::copy(rgba, rgba + 4, geom.rgba);
  geom.matid = -1;
  geom.texid = -1;
  geom.emission = 0.2F;
  geom.specular = 0.1F;
  geom.reflectance = 0;
  geom.castshadow = 0;
  geom.category = mjCAT_DECOR;
  geom.objtype = mjOBJ_UNKNOWN;
  geom.objid = -1;
  geom.segid = -1;
}

}  // namespace

void Ghosts::draw(std::span<const OverlayGhost> ghosts, const mjvOption& option, const mjData& d,
                  mjvScene& scene) {
  for (const OverlayGhost& ghost : ghosts.first(std::min(ghosts.size(), kMaxGhosts))) {
    const bool room = scene.maxgeom - scene.ngeom >= m_->ngeom;
    if (room && is_usable(ghost)) draw_one(ghost, option, d, scene);
  }
}

void Ghosts::draw_one(const OverlayGhost& ghost, const mjvOption& option, const mjData& d,
                      mjvScene& scene) {
  if (!d_) d_.reset(mj_makeData(m_));
  raw::place_otherwise(*m_, d, ghost.qpos_index, ghost.qpos, *d_);
  const mjvOption plain = only_geoms(option);
  const int first = scene.ngeom;
  mjv_addGeoms(m_, d_.get(), &plain, nullptr, mjCAT_DYNAMIC, &scene);
  int kept = first;
  for (int i = first; i < scene.ngeom; ++i) {
    mjvGeom& geom = scene.geoms[i];
    if (geom.objtype != mjOBJ_GEOM) continue;
    if (raw::same_place(*d_, d, m_->geom_bodyid[geom.objid])) continue;
    tint(geom, ghost.color);
    lift(geom, scene.camera[0]);
    if (kept != i) scene.geoms[kept] = geom;
    ++kept;
  }
  scene.ngeom = kept;
}

}  // namespace mjarm::render
