#include "apps/mjarm/view/plan_camera.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <variant>

#include "mjarm/core/rotation.hpp"
#include "mjarm/render/framing.hpp"

namespace mjarm::app {
namespace {

using Eigen::Vector3d;

constexpr int kAzimuths = 24;
constexpr std::array kElevations{-0.3, -0.55, -0.9};  // [rad]
constexpr std::size_t kMaxBlocking = 200;            // solids
constexpr std::size_t kMaxWatched = 120;             // points
constexpr double kReachShare = 1.5;  // what is so much farther than the arm gets need not be seen
constexpr double kLittle = 0.03;     // of arm and path may be hidden by a solid
// What a view is worth, beside the share of what it shows:
constexpr double kBehindArm = 0.6;  // less, where the arm is before the way of the tool
constexpr double kBroad = 0.25;     // a way of the tool that is seen from its broad side
constexpr double kNearness = 0.15;  // all things large
constexpr double kSteep = 0.08;     // less, where it looks steeply up or down [1/rad]
constexpr double kUsual = -0.45;    // [rad] elevation that needs no reason

/// The corners of what a solid fills, in its frame.
struct CornersOf {
  std::vector<FramedBall> operator()(const BallShape& ball) const {
    return {{{0, 0, 0}, ball.radius}};
  }
  std::vector<FramedBall> operator()(const CapsuleShape& capsule) const {
    return ends(capsule.half_length, capsule.radius);
  }
  std::vector<FramedBall> operator()(const CylinderShape& cylinder) const {
    return ends(cylinder.half_length, cylinder.radius);
  }
  std::vector<FramedBall> operator()(const BoxShape& box) const {
    return box_of(-box.half, box.half);
  }
  std::vector<FramedBall> operator()(const PolytopeShape& hull) const {
    return box_of(hull.low, hull.high);
  }
  std::vector<FramedBall> operator()(const MeshShape& mesh) const {
    Vector3d low = mesh.vertices.front(), high = low;
    for (const Vector3d& p : mesh.vertices) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    return box_of(low, high);
  }
  std::vector<FramedBall> operator()(const HalfSpaceShape&) const { return {}; }
  std::vector<FramedBall> operator()(const HeightFieldShape&) const { return {}; }

  static std::vector<FramedBall> ends(double half, double radius) {
    return {{{0, 0, half}, radius}, {{0, 0, -half}, radius}};
  }
  static std::vector<FramedBall> box_of(const Vector3d& low, const Vector3d& high) {
    std::vector<FramedBall> out;
    for (int i = 0; i < 8; ++i) {
      out.push_back(
          {{(i & 1 ? high : low).x(), (i & 2 ? high : low).y(), (i & 4 ? high : low).z()}, 0});
    }
    return out;
  }
};

/// All that has to be in the picture.
std::vector<FramedBall> balls_of(const PlanSubject& subject, const PlanDrawing& drawing) {
  std::vector<FramedBall> out;
  for (const JointVec& q : subject.path.q) {
    for (const PlacedSphere& sphere : place_spheres(subject.checker.robot(), as_span(q))) {
      out.push_back({sphere.p_W, sphere.radius});
    }
  }
  for (const Vector3d& p_W : drawing.tool_way()) out.push_back({p_W, 0});
  const Vector3d base = subject.arm.joints.front().X_PJ.p;
  double reach = 0;
  for (const FramedBall& ball : out) reach = std::max(reach, (ball.p_W - base).norm());
  const double limit = kReachShare * reach;
  const auto add = [&](const Vector3d& p_W, double radius) {
    const Vector3d way = p_W - base;
    out.push_back({base + std::min(1.0, limit / way.norm()) * way, radius});
  };
  for (const Obstacle& solid : subject.obstacles.solids) {
    if (distance(solid, base) > limit) continue;
    for (const FramedBall& ball : std::visit(CornersOf(), solid.shape)) {
      add(solid.X_WO * ball.p_W, ball.radius);
    }
  }
  for (const PointCloud& cloud : subject.obstacles.clouds) {
    for (const Vector3d& p_W : cloud.points_W) {
      if ((p_W - base).norm() < limit) add(p_W, cloud.radius);
    }
  }
  return out;
}

/// What should not be hidden: the way of the tool, and the arm where it is drawn.
std::vector<Vector3d> watched_of(const PlanSubject& subject, const PlanDrawing& drawing) {
  std::vector<Vector3d> all = drawing.tool_way();
  const std::array shown{drawing.way().at(drawing.way().tightest()), subject.path.q.front(),
                         subject.path.q.back()};
  for (const JointVec& q : shown) {
    for (const PlacedSphere& sphere : place_spheres(subject.checker.robot(), as_span(q))) {
      all.push_back(sphere.p_W);
    }
  }
  const std::size_t step = 1 + all.size() / kMaxWatched;
  std::vector<Vector3d> out;
  for (std::size_t i = 0; i < all.size(); i += step) out.push_back(all[i]);
  return out;
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

/// The first of them; the others are not looked at.
std::span<const Obstacle> blocking_solids(const PlanSubject& subject) {
  const auto solids = std::span(subject.obstacles.solids);
  return solids.first(std::min(solids.size(), kMaxBlocking));
}

/// Whether the arm itself, where it is drawn, hides a point that is not beside it.
bool arm_hides(std::span<const PlacedSphere> arm, const Vector3d& from_W, const Vector3d& to_W) {
  constexpr double kBeside = 0.05;  // [m]
  const Vector3d way = to_W - from_W;
  return std::ranges::any_of(arm, [&](const PlacedSphere& sphere) {
    const double share = way.dot(sphere.p_W - from_W) / way.squaredNorm();
    return share < 1 && (from_W + share * way - sphere.p_W).norm() < sphere.radius &&
           (to_W - sphere.p_W).norm() > sphere.radius + kBeside;
  });
}

double value_of(const PlanSubject& subject, const PlanDrawing& drawing,
                std::span<const Vector3d> watched, std::span<const PlacedSphere> arm,
                const CameraView& view, double nearest) {
  const Vector3d place = camera_place(view);
  double seen = 0;
  for (const Vector3d& p_W : watched) {
    const bool hidden = std::ranges::any_of(
        blocking_solids(subject), [&](const Obstacle& solid) { return hides(solid, place, p_W); });
    seen += hidden ? 0 : 1;
  }
  const Vector3d forward = (view.lookat_W - place).normalized();
  double across = 0, all = 1e-9, behind = 0;
  const std::vector<Vector3d>& way = drawing.tool_way();
  for (const Vector3d& p_W : way) behind += arm_hides(arm, place, p_W) ? 1 : 0;
  for (std::size_t i = 1; i < way.size(); ++i) {
    const Vector3d piece = way[i] - way[i - 1];
    across += (piece - forward.dot(piece) * forward).norm();
    all += piece.norm();
  }
  return seen / static_cast<double>(watched.size()) -
         kBehindArm * behind / static_cast<double>(way.size()) + kBroad * across / all +
         kNearness * nearest / view.distance - kSteep * std::abs(view.elevation - kUsual);
}

}  // namespace

CameraView plan_view(const PlanSubject& subject, const PlanDrawing& drawing, double aspect) {
  const std::vector<FramedBall> balls = balls_of(subject, drawing);
  const std::vector<Vector3d> watched = watched_of(subject, drawing);
  const std::vector<PlacedSphere> arm = place_spheres(
      subject.checker.robot(), mjarm::as_span(drawing.way().at(drawing.way().tightest())));
  std::vector<CameraView> views;
  for (const double elevation : kElevations) {
    for (int k = 0; k < kAzimuths; ++k) {
      const double azimuth = 2 * std::numbers::pi * k / kAzimuths;
      views.push_back(framing_view(subject.model, balls, {azimuth, elevation, aspect}));
    }
  }
  double nearest = views.front().distance;
  for (const CameraView& view : views) nearest = std::min(nearest, view.distance);
  const CameraView* best = nullptr;
  double max = 0;
  for (const CameraView& view : views) {
    const double value = value_of(subject, drawing, watched, arm, view, nearest);
    if (best != nullptr && value <= max) continue;
    best = &view;
    max = value;
  }
  return *best;
}

std::vector<int> hiding_solids(const PlanSubject& subject, const PlanDrawing& drawing,
                               const CameraView& view) {
  const std::vector<Vector3d> watched = watched_of(subject, drawing);
  const Vector3d place = camera_place(view);
  std::vector<int> out;
  for (const Obstacle& solid : blocking_solids(subject)) {
    const auto hidden = std::ranges::count_if(
        watched, [&](const Vector3d& p_W) { return hides(solid, place, p_W); });
    if (static_cast<double>(hidden) <= kLittle * static_cast<double>(watched.size())) continue;
    out.push_back(static_cast<int>(&solid - subject.obstacles.solids.data()));
  }
  return out;
}

}  // namespace mjarm::app
