#include "mjarm/render/overlay_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace mjarm::render {
namespace {

constexpr Rgba kFar = {0.20F, 0.60F, 0.35F, 1};
constexpr Rgba kNear = {0.90F, 0.15F, 0.15F, 1};
constexpr double kPathDashes = 60;       ///< dashes a picture
constexpr double kShortestDash = 0.005;  ///< [m]

}  // namespace

void add_contacts(Overlay& overlay, std::span<const ContactMark> contacts,
                  const ContactLook& look) {
  for (const ContactMark& contact : contacts) {
    overlay.spheres.push_back({contact.p_W, look.radius, look.color});
    if (!contact.force_W) continue;
    const double force = contact.force_W->norm();
    if (!(force > 0) || !std::isfinite(force)) continue;
    const double length = std::min(look.longest, look.metres_per_newton * force);
    overlay.arrows.push_back({.from_W = contact.p_W,
                              .to_W = contact.p_W + length / force * *contact.force_W,
                              .width = look.radius,
                              .color = look.color});
  }
}

void add_closest_pair(Overlay& overlay, const Eigen::Vector3d& p1_W, const Eigen::Vector3d& p2_W,
                      double distance, double margin) {
  const Rgba color = distance < std::max(margin, 0.0) ? kNear : kFar;
  for (const Eigen::Vector3d& p_W : {p1_W, p2_W}) overlay.spheres.push_back({p_W, 0.006, color});
  overlay.lines.push_back({.points_W = {p1_W, p2_W}, .width = 0.003, .color = color});
  char number[32];
  std::snprintf(number, sizeof(number), "%.1f mm", 1e3 * distance);
  overlay.labels.push_back({0.5 * (p1_W + p2_W), number});
}

void add_planned_path(Overlay& overlay, std::span<const Pose> X_WT, const PathLook& look) {
  const std::vector<Pose> path(X_WT.begin(), X_WT.end());
  add_planned_paths(overlay, {&path, 1}, look);
}

void add_planned_paths(Overlay& overlay, std::span<const std::vector<Pose>> X_WT,
                       const PathLook& look) {
  double length = 0;
  const std::size_t first = overlay.lines.size();
  for (const std::vector<Pose>& path : X_WT) {
    OverlayLine& line = overlay.lines.emplace_back();
    line.width = look.width;
    line.color = look.color;
    for (const Pose& pose : path) {
      if (!line.points_W.empty()) length += (pose.p - line.points_W.back()).norm();
      line.points_W.push_back(pose.p);
    }
  }
  if (!look.dashed) return;
  for (OverlayLine& line : std::span(overlay.lines).subspan(first)) {
    line.dash = std::max(kShortestDash, length / (2 * kPathDashes));
  }
}

void add_velocity_ellipsoid(Overlay& overlay, const Eigen::Vector3d& p_WT,
                            const Eigen::Matrix3d& R_WE, const Eigen::Vector3d& semi_axes,
                            double scale) {
  overlay.ellipsoids.push_back({.X_WE = {p_WT, R_WE}, .semi_axes = scale * semi_axes});
}

OverlayGhost ghost_of(const Arm& arm, std::span<const double> q) {
  OverlayGhost ghost;
  for (std::size_t j = 0; j < std::min(q.size(), arm.joints.size()); ++j) {
    ghost.qpos_index.push_back(arm.joints[j].qpos);
    ghost.qpos.push_back(q[j]);
  }
  return ghost;
}

}  // namespace mjarm::render
