#include "mjarm/render/framing.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace mjarm::render {
namespace {

using Eigen::Vector3d;

constexpr double kFramedShare = 0.95;   // of the picture is used
constexpr double kLeastDistance = 0.1;  // [m]

Vector3d forward_of(const CameraView& view) {
  return {std::cos(view.elevation) * std::cos(view.azimuth),
          std::cos(view.elevation) * std::sin(view.azimuth), std::sin(view.elevation)};
}

/// Where a camera has to be along one axis of the picture, and how far along the line of sight it
/// may go, so that the two sides of the picture across that axis leave all balls inside.
struct Fit {
  double across = 0, along = 0;
};

/// @param tangent  of the angle between the line of sight and a side.
Fit fit(std::span<const FramedBall> balls, const Vector3d& axis, const Vector3d& forward,
        double tangent) {
  const double cosine = 1 / std::hypot(1.0, tangent), sine = tangent * cosine;
  // A side is a plane through the camera; every ball is to be on its inner side.
  double low = std::numeric_limits<double>::infinity(), high = low;
  for (const FramedBall& ball : balls) {
    const double a = cosine * axis.dot(ball.p_W), f = sine * forward.dot(ball.p_W);
    low = std::min(low, f + a - ball.radius);
    high = std::min(high, f - a - ball.radius);
  }
  return {(low - high) / (2 * cosine), (low + high) / (2 * sine)};
}

}  // namespace

CameraView framing_view(const Model& model, std::span<const FramedBall> balls,
                        const LineOfSight& sight) {
  const bool usable = std::ranges::all_of(balls, [](const FramedBall& ball) {
    return ball.p_W.allFinite() && std::isfinite(ball.radius);
  });
  CameraView view;
  if (balls.empty() || !usable) view = default_view(model);
  view.azimuth = sight.azimuth;
  view.elevation = sight.elevation;
  if (balls.empty() || !usable) return view;
  const Vector3d forward = forward_of(view);
  const Vector3d right(std::sin(view.azimuth), -std::cos(view.azimuth), 0);
  const Vector3d up = right.cross(forward);
  const double tangent =
      kFramedShare * std::tan(0.5 * model.raw()->vis.global.fovy * std::numbers::pi / 180);
  const Fit wide = fit(balls, right, forward, tangent * sight.aspect);
  const Fit high = fit(balls, up, forward, tangent);
  const double along = std::min(wide.along, high.along);
  double depth = 0;
  for (const FramedBall& ball : balls) {
    depth += (forward.dot(ball.p_W) - along) / static_cast<double>(balls.size());
  }
  view.distance = std::max(depth, kLeastDistance);
  view.lookat_W = wide.across * right + high.across * up + (along + view.distance) * forward;
  return view;
}

Vector3d camera_place(const CameraView& view) {
  return view.lookat_W - view.distance * forward_of(view);
}

}  // namespace mjarm::render
