#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "mjarm/view/gizmo_shape_internal.hpp"
#include "mjarm/view/target_gizmo.hpp"

namespace mjarm::view {
namespace {

using Eigen::Vector3d;

constexpr render::Rgba kAxisColors[3] = {
    {0.90F, 0.20F, 0.18F, 1}, {0.20F, 0.72F, 0.25F, 1}, {0.20F, 0.42F, 0.95F, 1}};
constexpr render::Rgba kBright = {1.00F, 0.85F, 0.10F, 1};
constexpr double kArrowWidth = 0.045;  ///< in lengths of the arrows, as all that follows
constexpr double kRingWidth = 0.022;
constexpr double kBrightWidth = 1.5;
constexpr float kBehind = 0.35F;  ///< opacity of the far half of a ring
constexpr float kOthers = 0.20F;  ///< opacity of handles while another one is held
constexpr double kInFront = 0.15;

/// Moves what is drawn towards the eye, and makes it smaller by as much: it looks the same and
/// hides behind nothing.
class Front {
 public:
  Front(const Eye& eye, const Vector3d& p_W, double size) : eye_(eye.p_W) {
    if (eye.orthographic) return;
    const double depth = (p_W - eye.p_W).dot(eye.forward_W);
    // The nearest arrow must stay behind the plane where the picture begins.
    share_ =
        std::clamp(std::max(kInFront, 1.5 * eye.near / std::max(depth - size, 1e-9)), 0.0, 1.0);
  }
  [[nodiscard]] Vector3d at(const Vector3d& p_W) const { return eye_ + share_ * (p_W - eye_); }
  [[nodiscard]] double length(double value) const { return share_ * value; }

 private:
  Vector3d eye_;
  double share_ = 1;
};

/// Colour and thickness of a handle.
struct Look {
  render::Rgba color;
  double wide = 1;
};

Look look_of(GizmoHandle handle, std::optional<GizmoHandle> hovered,
             std::optional<GizmoHandle> held, render::Rgba color) {
  if (held && *held != handle) color.a *= kOthers;
  if (held.value_or(hovered.value_or(handle)) != handle || (!held && !hovered)) return {color, 1};
  return {{kBright.r, kBright.g, kBright.b, color.a}, kBrightWidth};
}

/// The ring as two polylines: the half that faces the eye, and the other.
void draw_ring(render::Overlay& overlay, const Front& front, const Pose& X_WG, int axis, double s,
               const Vector3d& to_eye, const Look& look) {
  const Vector3d u = gizmo::kRing * s * X_WG.R.col((axis + 1) % 3);
  const Vector3d v = gizmo::kRing * s * X_WG.R.col((axis + 2) % 3);
  const double nearest = std::atan2(v.dot(to_eye), u.dot(to_eye));
  for (const bool far : {false, true}) {
    render::OverlayLine& line = overlay.lines.emplace_back();
    line.width = front.length(look.wide * kRingWidth * s);
    line.color = look.color;
    line.look = render::LineLook::tube;
    if (far) line.color.a *= kBehind;
    for (int i = 0; i <= gizmo::kRingPieces / 2; ++i) {
      const double share = 2.0 * i / gizmo::kRingPieces - 0.5 + (far ? 1 : 0);
      const double angle = nearest + std::numbers::pi * share;
      line.points_W.push_back(front.at(X_WG.p + std::cos(angle) * u + std::sin(angle) * v));
    }
  }
}

std::string amount_text(GizmoHandle handle, double amount) {
  const bool turns = handle >= GizmoHandle::turn_x && handle <= GizmoHandle::turn_z;
  char number[48];
  std::snprintf(number, sizeof(number), turns ? "%+.1f deg" : "%+.1f mm",
                amount * (turns ? 180 / std::numbers::pi : 1e3));
  return number;
}

}  // namespace

void TargetGizmo::draw(render::Overlay& overlay, const render::Rgba& state) const {
  const double s = scale();
  if (!(s > 0)) return;
  const Pose X_WG{X_WT_.p, axes()};
  const Front front(eye_, X_WG.p, s);
  const Vector3d to_eye =
      eye_.orthographic ? Vector3d(-eye_.forward_W) : Vector3d(eye_.p_W - X_WG.p);
  const auto look = [&](GizmoHandle handle, const render::Rgba& color) {
    return look_of(handle, hovered_, held(), color);
  };
  for (int i = 0; i < 3; ++i) {
    const Vector3d a = X_WG.R.col(i);
    const Look arrow = look(static_cast<GizmoHandle>(i), kAxisColors[i]);
    overlay.arrows.push_back({.from_W = front.at(X_WG.p + gizmo::kArrowBegin * s * a),
                              .to_W = front.at(X_WG.p + s * a),
                              .width = front.length(arrow.wide * kArrowWidth * s),
                              .color = arrow.color});
    const auto square = static_cast<GizmoHandle>(3 + i);
    if (is_visible(square)) {
      render::Rgba pale = kAxisColors[i];
      pale.a = 0.6F;
      const Vector3d centre =
          X_WG.p + gizmo::kSquare * s * (X_WG.R.col((i + 1) % 3) + X_WG.R.col((i + 2) % 3));
      Vector3d half = Vector3d::Constant(front.length(gizmo::kSquareHalf * s));
      half[i] = front.length(0.004 * s);
      overlay.boxes.push_back({{front.at(centre), X_WG.R}, half, look(square, pale).color});
    }
    const auto ring = static_cast<GizmoHandle>(6 + i);
    if (!is_visible(ring)) continue;
    draw_ring(overlay, front, X_WG, i, s, to_eye, look(ring, kAxisColors[i]));
  }
  const Look ball = look(GizmoHandle::move_free, state);
  overlay.spheres.push_back({.p_W = front.at(X_WG.p),
                             .radius = front.length(ball.wide * gizmo::kBall * s),
                             .color = state});
  if (!grip_) return;
  const Vector3d above = front.at(X_WG.p + 1.15 * s * eye_.up_W);
  overlay.labels.push_back({above, amount_text(grip_->handle, grip_->amount)});
  const Vector3d way[2] = {front.at(grip_->X_start.p), front.at(X_WG.p)};
  if ((way[1] - way[0]).norm() > 0) {
    overlay.lines.push_back(
        {.points_W = {way[0], way[1]}, .color = kBright, .look = render::LineLook::thin});
  }
}

}  // namespace mjarm::view
