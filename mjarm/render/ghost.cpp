#include <algorithm>
#include <cmath>

#include "mjarm/render/ghost_internal.hpp"

namespace mjarm::render {
namespace {

constexpr double kSamePlace = 1e-6;  ///< [m], and for entries of rotation matrices

bool is_usable(const OverlayGhost& ghost) {
  return ghost.qpos.size() == ghost.qpos_index.size() &&
         std::ranges::all_of(ghost.qpos, [](double value) { return std::isfinite(value); });
}

bool moved(const mjModel& m, const mjData& a, const mjData& b, int geom) {
  const int body = m.geom_bodyid[geom];
  const auto differ = [](const mjtNum* x, const mjtNum* y, int count) {
    return !std::equal(x, x + count, y,
                       [](mjtNum s, mjtNum t) { return std::abs(s - t) < kSamePlace; });
  };
  return differ(a.xpos + 3 * body, b.xpos + 3 * body, 3) ||
         differ(a.xmat + 9 * body, b.xmat + 9 * body, 9);
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
  std::copy_n(d.qpos, m_->nq, d_->qpos);
  std::copy_n(d.mocap_pos, 3 * m_->nmocap, d_->mocap_pos);
  std::copy_n(d.mocap_quat, 4 * m_->nmocap, d_->mocap_quat);
  for (std::size_t i = 0; i < ghost.qpos.size(); ++i) {
    const int index = ghost.qpos_index[i];
    if (index >= 0 && index < m_->nq) d_->qpos[index] = ghost.qpos[i];
  }
  mj_kinematics(m_, d_.get());
  const mjvOption plain = only_geoms(option);
  const int first = scene.ngeom;
  mjv_addGeoms(m_, d_.get(), &plain, nullptr, mjCAT_DYNAMIC, &scene);
  int kept = first;
  for (int i = first; i < scene.ngeom; ++i) {
    mjvGeom& geom = scene.geoms[i];
    if (geom.objtype != mjOBJ_GEOM || !moved(*m_, *d_, d, geom.objid)) continue;
    tint(geom, ghost.color);
    lift(geom, scene.camera[0]);
    if (kept != i) scene.geoms[kept] = geom;
    ++kept;
  }
  scene.ngeom = kept;
}

}  // namespace mjarm::render
