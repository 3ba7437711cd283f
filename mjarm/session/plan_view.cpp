#include "mjarm/session/plan_view.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <variant>
#include <vector>

#include "mjarm/render/framing.hpp"

namespace mjarm::session {
namespace {

using Eigen::Vector3d;

constexpr double kElevation = -0.5;        // [rad]
constexpr double kAside = 0.45;            // [rad] off the straight look across, for depth
constexpr std::size_t kMaxBlocking = 200;  // solids that are looked at

/// Heading of the line of sight [rad].
double azimuth_of(const Vector3d& base, std::span<const Vector3d> way) {
  Vector3d middle = Vector3d::Zero();
  for (const Vector3d& p_W : way) middle += p_W / static_cast<double>(way.size());
  const Vector3d outward = middle - base, along = way.back() - way.front();
  Vector3d look(-along.y(), along.x(), 0);  // across the path
  if (look.norm() < 0.05) look = {-outward.x(), -outward.y(), 0};
  if (look.dot(outward) > 0) look = -look;
  return std::atan2(look.y(), look.x()) + kAside;
}

/// Corners of the box round a solid, in the world; none of those without an end.
std::vector<Vector3d> corners_of(const Obstacle& solid) {
  Vector3d low = Vector3d::Zero(), high = low;
  if (const auto* ball = std::get_if<BallShape>(&solid.shape)) {
    high.setConstant(ball->radius);
    low = -high;
  } else if (const auto* capsule = std::get_if<CapsuleShape>(&solid.shape)) {
    high = {capsule->radius, capsule->radius, capsule->radius + capsule->half_length};
    low = -high;
  } else if (const auto* box = std::get_if<BoxShape>(&solid.shape)) {
    high = box->half;
    low = -high;
  } else if (const auto* cylinder = std::get_if<CylinderShape>(&solid.shape)) {
    high = {cylinder->radius, cylinder->radius, cylinder->half_length};
    low = -high;
  } else if (const auto* polytope = std::get_if<PolytopeShape>(&solid.shape)) {
    low = polytope->low;
    high = polytope->high;
  } else if (const auto* mesh = std::get_if<MeshShape>(&solid.shape)) {
    low = high = mesh->vertices.front();
    for (const Vector3d& p : mesh->vertices) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  } else {
    return {};
  }
  std::vector<Vector3d> out;
  for (int i = 0; i < 8; ++i) {
    const Vector3d p((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                     (i & 4) != 0 ? high.z() : low.z());
    out.push_back(solid.X_WO * p);
  }
  return out;
}

/// All of what the path goes round: solids near the tool's way that are no larger than the arm.
void add_solids_round(std::span<const Vector3d> way, const std::vector<Obstacle>& solids,
                      std::vector<render::FramedBall>& balls) {
  constexpr double kNear = 0.3, kLargest = 1.5;  // [m]
  for (std::size_t i = 0; i < std::min(solids.size(), kMaxBlocking); ++i) {
    const std::vector<Vector3d> corners = corners_of(solids[i]);
    if (corners.empty() || (corners.back() - corners.front()).norm() > kLargest) continue;
    const auto near = [&](const Vector3d& p_W) { return distance(solids[i], p_W) < kNear; };
    if (std::ranges::none_of(way, near)) continue;
    for (const Vector3d& corner : corners) balls.push_back({corner, 0});
  }
}

/// Whether a solid stands between the two, by going on as far as it is surely free.
bool hides(const Obstacle& solid, const Vector3d& from_W, const Vector3d& to_W) {
  constexpr double kHit = 1e-3, kEnd = 0.02;  // [m]
  const double length = (to_W - from_W).norm();
  for (double way = 0; way < length - kEnd;) {
    const double free = distance(solid, from_W + way / length * (to_W - from_W));
    if (free < kHit) return true;
    way += free;
  }
  return false;
}

}  // namespace

render::CameraView plan_view(const PlanSubject& subject, const PlanDrawing& drawing,
                             double aspect) {
  std::vector<render::FramedBall> balls;
  for (const JointVec& q : subject.path.q) {
    for (const PlacedSphere& sphere : place_spheres(subject.checker.robot(), as_span(q))) {
      balls.push_back({sphere.p_W, sphere.radius});
    }
  }
  for (const Vector3d& p_W : drawing.tool_way()) balls.push_back({p_W, 0});
  add_solids_round(drawing.tool_way(), subject.obstacles.solids, balls);
  const double azimuth = azimuth_of(subject.arm.joints.front().X_PJ.p, drawing.tool_way());
  return render::framing_view(subject.model, balls, {azimuth, kElevation, aspect});
}

std::vector<int> hiding_solids(const PlanSubject& subject, const PlanDrawing& drawing,
                               const render::CameraView& view) {
  const Vector3d place = render::camera_place(view);
  const std::vector<Obstacle>& solids = subject.obstacles.solids;
  std::vector<int> out;
  for (std::size_t i = 0; i < std::min(solids.size(), kMaxBlocking); ++i) {
    const auto hidden = [&](const Vector3d& p_W) { return hides(solids[i], place, p_W); };
    if (std::ranges::any_of(drawing.tool_way(), hidden)) out.push_back(static_cast<int>(i));
  }
  return out;
}

}  // namespace mjarm::session
