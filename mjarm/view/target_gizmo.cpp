#include "mjarm/view/target_gizmo.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "mjarm/core/rotation.hpp"
#include "mjarm/view/gizmo_shape_internal.hpp"

namespace mjarm::view {
namespace {

using Eigen::Vector3d;

constexpr double kGrazing = 0.26;   ///< sine (15 degrees) below which a direction points at the eye
constexpr double kFlattest = 0.1;   ///< sine: rays flatter to a plane do not take hold in it
constexpr double kHorizon = 0.4;    ///< of the first ray's sine: flatter rays meet it too far away
constexpr double kReach = 3;        ///< in distances to the eye
constexpr double kDepthCost = 0.5;  ///< of a handle one arrow length behind another

bool is_usable(const Ray& ray) {
  return ray.origin_W.allFinite() && ray.direction_W.allFinite() &&
         std::abs(ray.direction_W.squaredNorm() - 1) < 1e-6;
}

int axis_of(GizmoHandle handle) { return static_cast<int>(handle) % 3; }
bool is_arrow(GizmoHandle handle) { return handle <= GizmoHandle::move_z; }
bool is_ring(GizmoHandle handle) {
  return handle >= GizmoHandle::turn_x && handle <= GizmoHandle::turn_z;
}

/// Where a ray comes nearest to something: how near, and how far along the ray.
struct Nearest {
  double miss = 0;  ///< [m]
  double way = 0;   ///< [m] along the ray, >= 0
  Vector3d point = Vector3d::Zero();
};

Nearest nearest_to_point(const Ray& ray, const Vector3d& p) {
  const double way = std::max(0.0, (p - ray.origin_W).dot(ray.direction_W));
  return {(ray.at(way) - p).norm(), way, p};
}

Nearest nearest_to_segment(const Ray& ray, const Vector3d& a, const Vector3d& b) {
  const Vector3d along = b - a;
  const Vector3d start = a - ray.origin_W;
  const double slope = along.dot(ray.direction_W);
  const double steep = along.squaredNorm() - slope * slope;
  double share = 0;
  if (steep > 1e-12 * along.squaredNorm()) {
    share = (slope * start.dot(ray.direction_W) - along.dot(start)) / steep;
  }
  return nearest_to_point(ray, a + std::clamp(share, 0.0, 1.0) * along);
}

/// Corners of the ring as a polygon, with radius one.
const std::array<Eigen::Vector2d, gizmo::kRingPieces>& ring_corners() {
  static const auto corners = [] {
    std::array<Eigen::Vector2d, gizmo::kRingPieces> out;
    for (int i = 0; i < gizmo::kRingPieces; ++i) {
      const double angle = 2 * std::numbers::pi * i / gizmo::kRingPieces;
      out[static_cast<std::size_t>(i)] = {std::cos(angle), std::sin(angle)};
    }
    return out;
  }();
  return corners;
}

Nearest nearest_to_ring(const Ray& ray, const Vector3d& middle, const Vector3d& u,
                        const Vector3d& v) {
  Nearest best{std::numeric_limits<double>::infinity(), 0, middle};
  const auto at = [&](const Eigen::Vector2d& c) -> Vector3d {
    return middle + c.x() * u + c.y() * v;
  };
  Vector3d from = at(ring_corners().back());
  for (const Eigen::Vector2d& corner : ring_corners()) {
    const Vector3d to = at(corner);
    const Nearest found = nearest_to_segment(ray, from, to);
    if (found.miss < best.miss) best = found;
    from = to;
  }
  return best;
}

/// Where a ray meets a plane in front of it; none for rays too flat to it.
std::optional<Vector3d> meet(const Ray& ray, const Vector3d& point, const Vector3d& normal,
                             double flattest = kFlattest) {
  const double slope = ray.direction_W.dot(normal);
  if (!(std::abs(slope) > flattest)) return std::nullopt;
  const double way = (point - ray.origin_W).dot(normal) / slope;
  if (!(way > 0) || !std::isfinite(way)) return std::nullopt;
  return ray.at(way);
}

Vector3d without(const Vector3d& v, const Vector3d& axis) { return v - v.dot(axis) * axis; }

Vector3d shortened(const Vector3d& v, double longest) {
  const double length = v.norm();
  return length > longest ? Vector3d(longest / length * v) : v;
}

}  // namespace

TargetGizmo::TargetGizmo(const Pose& X_WT, const GizmoOptions& options)
    : X_WT_(X_WT), options_(options) {}

void TargetGizmo::set_pose(const Pose& X_WT) {
  X_WT_ = X_WT;
  release();
}

std::optional<GizmoHandle> TargetGizmo::held() const noexcept {
  return grip_ ? std::optional(grip_->handle) : std::nullopt;
}

double TargetGizmo::amount() const noexcept { return grip_ ? grip_->amount : 0; }

/// [m] length of the arrows; not above 0 where the target is behind the eye.
double TargetGizmo::scale() const { return options_.size * eye_.height_at(X_WT_.p); }

bool TargetGizmo::is_visible(GizmoHandle handle) const {
  if (is_ring(handle)) return options_.turns;
  if (is_arrow(handle) || handle == GizmoHandle::move_free) return true;
  const Vector3d sight = eye_.orthographic ? eye_.forward_W : (X_WT_.p - eye_.p_W).normalized();
  return std::abs(axes().col(axis_of(handle)).dot(sight)) > gizmo::kEdgeOn;
}

std::optional<TargetGizmo::Hit> TargetGizmo::find(const Ray& mouse) const {
  const double s = scale();
  if (!is_usable(mouse) || !(s > 0)) return std::nullopt;
  const double max = options_.nearness / options_.size * s;
  if (nearest_to_point(mouse, X_WT_.p).miss > s + max) return std::nullopt;
  const Eigen::Matrix3d R = axes();
  const double middle = nearest_to_point(mouse, X_WT_.p).way;
  std::optional<Hit> best;
  const auto offer = [&](GizmoHandle handle, const Nearest& found) {
    if (!(found.miss <= max)) return;
    const double cost = found.miss / max + kDepthCost * (found.way - middle) / s;
    if (!best || cost < best->cost) best = Hit{handle, cost, found.point};
  };
  for (int i = 0; i < 3; ++i) {
    const Vector3d a = R.col(i);
    const Vector3d u = R.col((i + 1) % 3);
    const Vector3d v = R.col((i + 2) % 3);
    offer(static_cast<GizmoHandle>(i),
          nearest_to_segment(mouse, X_WT_.p + gizmo::kArrowBegin * s * a, X_WT_.p + s * a));
    if (options_.turns) {
      offer(static_cast<GizmoHandle>(6 + i),
            nearest_to_ring(mouse, X_WT_.p, gizmo::kRing * s * u, gizmo::kRing * s * v));
    }
    const auto square = static_cast<GizmoHandle>(3 + i);
    const Vector3d centre = X_WT_.p + gizmo::kSquare * s * (u + v);
    const std::optional<Vector3d> met = meet(mouse, centre, a);
    if (!met || !is_visible(square)) continue;
    const Vector3d off = *met - centre;
    if (std::max(std::abs(off.dot(u)), std::abs(off.dot(v))) > gizmo::kSquareHalf * s) continue;
    offer(square, {0, (*met - mouse.origin_W).norm(), *met});
  }
  Nearest ball = nearest_to_point(mouse, X_WT_.p);
  ball.miss = std::max(0.0, ball.miss - gizmo::kBall * s);
  offer(GizmoHandle::move_free, ball);
  return best;
}

std::optional<GizmoHandle> TargetGizmo::hover(const Ray& mouse) {
  const std::optional<Hit> hit = grip_ ? std::nullopt : find(mouse);
  hovered_ = grip_ ? held() : hit ? std::optional(hit->handle) : std::nullopt;
  return hovered_;
}

/// An axis is followed in the plane through it that faces the eye most. Where it points at the eye,
/// its way across the picture is taken instead, made longer as at the smallest good angle.
void TargetGizmo::hold_axis(Grip& grip, const Vector3d& sight) const {
  const Vector3d facing = without(sight, grip.axis_W);
  if (facing.norm() > kGrazing) {
    grip.plane_W = facing.normalized();
    grip.across_W = grip.axis_W;
    return;
  }
  grip.plane_W = sight;
  const Vector3d seen = without(grip.axis_W, sight);
  const Vector3d shown = seen.norm() > 1e-6 ? seen : without(eye_.up_W, sight);
  grip.across_W = shown.normalized() / kGrazing;
}

/// A ring is followed in its plane; where it is seen from its edge, it rolls with its near side.
void TargetGizmo::hold_ring(Grip& grip, const Vector3d& sight) const {
  grip.linear = std::abs(grip.axis_W.dot(sight)) < kGrazing;
  grip.plane_W = grip.linear ? sight : grip.axis_W;
  if (!grip.linear) return;
  const Vector3d to_eye = -without(sight, grip.axis_W).normalized();
  grip.across_W = grip.axis_W.cross(to_eye) / (gizmo::kRing * scale());
}

std::optional<TargetGizmo::Grip> TargetGizmo::grip_of(const Hit& hit, const Ray& mouse) const {
  Grip grip{};
  grip.handle = hit.handle;
  grip.X_start = X_WT_;
  grip.axis_W = axes().col(axis_of(hit.handle));
  const Vector3d sight = eye_.orthographic ? eye_.forward_W : (X_WT_.p - eye_.p_W).normalized();
  grip.linear = is_arrow(hit.handle);
  if (is_arrow(hit.handle)) {
    hold_axis(grip, sight);
  } else if (is_ring(hit.handle)) {
    hold_ring(grip, sight);
  } else {
    grip.plane_W = hit.handle == GizmoHandle::move_free ? sight : grip.axis_W;
  }
  grip.reach = kReach * (X_WT_.p - eye_.p_W).norm();
  const std::optional<Vector3d> met = meet(mouse, X_WT_.p, grip.plane_W);
  if (!met) return std::nullopt;
  grip.point_W = *met;
  grip.flattest = kHorizon * std::abs(mouse.direction_W.dot(grip.plane_W));
  return grip;
}

bool TargetGizmo::grab(const Ray& mouse) {
  release();
  const std::optional<Hit> hit = find(mouse);
  if (hit) grip_ = grip_of(*hit, mouse);
  hovered_ = held();
  return grip_.has_value();
}

/// The angle swept about the axis, counted on beyond half turns; held where the mouse is so near to
/// the axis that its angle says nothing.
void TargetGizmo::turn(Grip& grip, const Vector3d& met) {
  const Vector3d from = without(grip.point_W - grip.X_start.p, grip.axis_W);
  const Vector3d to = without(met - grip.X_start.p, grip.axis_W);
  if (std::min(from.norm(), to.norm()) < 0.05 * scale()) return;
  const double angle = std::atan2(grip.axis_W.dot(from.cross(to)), from.dot(to));
  grip.amount =
      angle + 2 * std::numbers::pi * std::round((grip.amount - angle) / (2 * std::numbers::pi));
}

const Pose& TargetGizmo::drag(const Ray& mouse) {
  if (!grip_ || !is_usable(mouse)) return X_WT_;
  Grip& grip = *grip_;
  const std::optional<Vector3d> met = meet(mouse, grip.X_start.p, grip.plane_W, grip.flattest);
  if (!met) return X_WT_;
  const Vector3d way = *met - grip.point_W;
  if (is_ring(grip.handle)) {
    if (grip.linear) {
      grip.amount = grip.across_W.dot(way);
    } else {
      turn(grip, *met);
    }
    X_WT_.R = rotation_exp(grip.amount * grip.axis_W) * grip.X_start.R;
  } else if (is_arrow(grip.handle)) {
    grip.amount = std::clamp(grip.across_W.dot(way), -grip.reach, grip.reach);
    X_WT_.p = grip.X_start.p + grip.amount * grip.axis_W;
  } else {
    const Vector3d shift = shortened(without(way, grip.plane_W), grip.reach);
    grip.amount = shift.norm();
    X_WT_.p = grip.X_start.p + shift;
  }
  return X_WT_;
}

}  // namespace mjarm::view
