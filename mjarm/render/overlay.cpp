#include "mjarm/render/overlay.hpp"

#include <algorithm>
#include <cstring>

#include "mjarm/render/overlay_internal.hpp"

namespace mjarm {
namespace {

constexpr Rgba kRed = {0.85F, 0.22F, 0.20F, 1};
constexpr Rgba kGreen = {0.25F, 0.66F, 0.28F, 1};
constexpr Rgba kBlue = {0.20F, 0.38F, 0.85F, 1};

/// A new geom of the scene, without a place yet.
mjvGeom& add_geom(mjvScene& scene, int type, const Rgba& color) {
  mjvGeom& geom = scene.geoms[scene.ngeom++];
  const float rgba[4] = {color.r, color.g, color.b, color.a};
  mjv_initGeom(&geom, type, nullptr, nullptr, nullptr, rgba);
  geom.category = mjCAT_DECOR;
  geom.objtype = mjOBJ_UNKNOWN;
  geom.objid = -1;
  geom.segid = -1;
  geom.castshadow = 0;
  // Paths must be found at a glance, also on the side away from the light.
  geom.emission = 0.25F;
  geom.specular = 0.2F;
  return geom;
}

void add_connector(mjvScene& scene, int type, double width, const Eigen::Vector3d& from,
                   const Eigen::Vector3d& to, const Rgba& color) {
  if ((to - from).norm() < mjMINVAL) return;
  mjv_connector(&add_geom(scene, type, color), type, width / 2, from.data(), to.data());
}

void add_sphere(mjvScene& scene, const OverlaySphere& sphere) {
  mjvGeom& geom = add_geom(scene, mjGEOM_SPHERE, sphere.color);
  std::fill_n(geom.size, 3, static_cast<float>(sphere.radius));
  for (int i = 0; i < 3; ++i) geom.pos[i] = static_cast<float>(sphere.p_W[i]);
}

void add_label(mjvScene& scene, const OverlayLabel& label) {
  mjvGeom& geom = add_geom(scene, mjGEOM_LABEL, {1, 1, 1, 1});
  for (int i = 0; i < 3; ++i) geom.pos[i] = static_cast<float>(label.p_W[i]);
  std::size_t length = 0;
  for (const char c : label.text) {
    if (length + 1 == sizeof(geom.label)) break;
    const auto byte = static_cast<unsigned char>(c);
    if ((byte & 0xC0U) == 0x80U) continue;  // inside of a UTF-8 character, shown as one `?`
    geom.label[length++] = byte >= 32 && byte < 127 ? c : '?';
  }
  geom.label[length] = '\0';
}

}  // namespace

std::size_t geoms_of(const Overlay& overlay) {
  std::size_t count = overlay.spheres.size() + overlay.arrows.size() + 3 * overlay.frames.size() +
                      overlay.labels.size();
  for (const OverlayLine& line : overlay.lines) count += line.points_W.size();
  return count;
}

void add_overlay(const Overlay& overlay, mjvScene& scene) {
  for (const OverlaySphere& sphere : overlay.spheres) add_sphere(scene, sphere);
  for (const OverlayLine& line : overlay.lines) {
    for (std::size_t i = 1; i < line.points_W.size(); ++i) {
      add_connector(scene, mjGEOM_CAPSULE, line.width, line.points_W[i - 1], line.points_W[i],
                    line.color);
    }
  }
  for (const OverlayArrow& arrow : overlay.arrows) {
    add_connector(scene, mjGEOM_ARROW, arrow.width, arrow.from_W, arrow.to_W, arrow.color);
  }
  for (const OverlayFrame& frame : overlay.frames) {
    const Rgba colors[3] = {kRed, kGreen, kBlue};
    for (int i = 0; i < 3; ++i) {
      add_connector(scene, mjGEOM_CAPSULE, frame.width, frame.X_WF.p,
                    frame.X_WF.p + frame.length * frame.X_WF.R.col(i), colors[i]);
    }
  }
  for (const OverlayLabel& label : overlay.labels) add_label(scene, label);
}

}  // namespace mjarm
