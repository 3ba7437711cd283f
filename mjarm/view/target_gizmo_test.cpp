#include "mjarm/view/target_gizmo.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"

namespace mjarm::view {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kPictureWidth = 1280;
constexpr int kPictureHeight = 800;
constexpr double kPi = std::numbers::pi;
constexpr GizmoHandle kAll[] = {GizmoHandle::move_x,   GizmoHandle::move_y,  GizmoHandle::move_z,
                                GizmoHandle::move_yz,  GizmoHandle::move_zx, GizmoHandle::move_xy,
                                GizmoHandle::turn_x,   GizmoHandle::turn_y,  GizmoHandle::turn_z,
                                GizmoHandle::move_free};

Pose random_pose(Rng& rng) {
  return {{rng.uniform(-0.5, 0.5), rng.uniform(-0.5, 0.5), rng.uniform(0, 1)},
          from_euler({rng.uniform(-3, 3), rng.uniform(-1.5, 1.5), rng.uniform(-3, 3)})};
}

/// An eye that has the point somewhere in its picture.
Eye random_eye(Rng& rng, const Vector3d& p) {
  const Vector3d aside(rng.uniform(-0.3, 0.3), rng.uniform(-0.3, 0.3), rng.uniform(-0.2, 0.2));
  Eye eye = eye_of({.lookat_W = p + aside,
                    .distance = rng.uniform(1, 4),
                    .azimuth = rng.uniform(-3, 3),
                    .elevation = rng.uniform(-1.5, 1.5)},
                   0.8);
  eye.orthographic = rng.uniform() < 0.2;
  return eye;
}

Ray ray_to(const Eye& eye, const Vector3d& p) {
  if (eye.orthographic) {
    return {p - (p - eye.p_W).dot(eye.forward_W) * eye.forward_W, eye.forward_W};
  }
  return {eye.p_W, (p - eye.p_W).normalized()};
}

Ray at_pixel(const Eye& eye, const Vector2d& pixel) {
  return ray_of_pixel(eye, kPictureWidth, kPictureHeight, pixel.x(), pixel.y());
}

/// Points of a handle as it is drawn; none where it is not.
std::vector<Vector3d> drawn_points(const TargetGizmo& gizmo, GizmoHandle handle) {
  std::vector<Vector3d> out;
  if (!gizmo.is_visible(handle)) return out;
  render::Overlay overlay;
  gizmo.draw(overlay, {});
  const int k = static_cast<int>(handle);
  if (handle <= GizmoHandle::move_z) {
    const render::OverlayArrow& arrow = overlay.arrows.at(static_cast<std::size_t>(k));
    for (int i = 0; i <= 16; ++i) {
      out.push_back(arrow.from_W + i / 16.0 * (arrow.to_W - arrow.from_W));
    }
  } else if (handle <= GizmoHandle::move_xy) {
    std::size_t box = 0;
    for (int i = 3; i < k; ++i) box += gizmo.is_visible(static_cast<GizmoHandle>(i)) ? 1U : 0U;
    const render::OverlayBox& square = overlay.boxes.at(box);
    for (int i = 0; i < 81; ++i) {
      Vector3d at = Vector3d::Zero();
      at[(k + 1) % 3] = (i % 9 - 4) / 4.1;
      at[(k + 2) % 3] = (i / 9 - 4) / 4.1;
      out.push_back(square.X_WB * Vector3d(at.cwiseProduct(square.half_sizes)));
    }
  } else if (handle <= GizmoHandle::turn_z) {
    for (const std::size_t half : {0U, 1U}) {
      const auto& points = overlay.lines.at(2 * static_cast<std::size_t>(k - 6) + half).points_W;
      out.insert(out.end(), points.begin(), points.end());
    }
  } else {
    const render::OverlaySphere& ball = overlay.spheres.at(0);
    for (int i = 0; i < 125; ++i) {
      const Vector3d share(i % 5 - 2, i / 5 % 5 - 2, i / 25 - 2);
      if (share.norm() < 2.5) out.push_back(ball.p_W + ball.radius / 2.5 * share);
    }
  }
  return out;
}

/// A pixel that meets the handle: somewhat beside what is drawn of it, or else right on that.
std::optional<Vector2d> pixel_of(TargetGizmo& gizmo, const Eye& eye, GizmoHandle handle) {
  const std::vector<Vector3d> points = drawn_points(gizmo, handle);
  for (const Vector2d& beside : {Vector2d(4, -3), Vector2d(-3, 4), Vector2d(0, 0)}) {
    for (const Vector3d& p : points) {
      const auto pixel = pixel_of_point(eye, kPictureWidth, kPictureHeight, p);
      if (pixel && gizmo.hover(at_pixel(eye, *pixel + beside)) == handle) return *pixel + beside;
    }
  }
  return std::nullopt;
}

struct Case {
  Eye eye;
  TargetGizmo gizmo;
};

Case random_case(Rng& rng) {
  const Pose pose = random_pose(rng);
  Case out{random_eye(rng, pose.p), TargetGizmo(pose)};
  out.gizmo.set_eye(out.eye);
  if (rng.uniform() < 0.5) out.gizmo.set_axes(Eigen::Matrix3d::Identity());
  return out;
}

Eigen::Matrix3d axes_of(const Case& c) {
  render::Overlay overlay;
  c.gizmo.draw(overlay, {});
  Eigen::Matrix3d axes;
  for (int i = 0; i < 3; ++i) {
    const render::OverlayArrow& arrow = overlay.arrows.at(static_cast<std::size_t>(i));
    axes.col(i) = (arrow.to_W - arrow.from_W).normalized();
  }
  return axes;
}

TEST(TargetGizmo, EveryHandleCanBeHitFromRandomCameras) {
  Rng rng(21);
  for (int i = 0; i < 60; ++i) {
    Case c = random_case(rng);
    const Vector3d sight = ray_to(c.eye, c.gizmo.pose().p).direction_W;
    const Eigen::Matrix3d axes = axes_of(c);
    for (const GizmoHandle handle : kAll) {
      if (!c.gizmo.is_visible(handle)) continue;
      const bool arrow = handle <= GizmoHandle::move_z;
      // An arrow that points away from the eye stands behind the ball.
      if (arrow && std::abs(axes.col(static_cast<int>(handle)).dot(sight)) > 0.97) continue;
      const auto pixel = pixel_of(c.gizmo, c.eye, handle);
      ASSERT_TRUE(pixel) << "case " << i << ", handle " << static_cast<int>(handle);
      ASSERT_TRUE(c.gizmo.grab(at_pixel(c.eye, *pixel)));
      EXPECT_EQ(c.gizmo.held(), handle);
      EXPECT_EQ(c.gizmo.hover(at_pixel(c.eye, {0, 0})), handle) << "held ones stay";
      c.gizmo.release();
    }
  }
}

TEST(TargetGizmo, IsAsLargeOnTheScreenFromAnyDistance) {
  for (const double distance : {0.5, 1.0, 2.0, 8.0, 50.0}) {
    const Eye eye = eye_of({.distance = distance, .azimuth = 0.4, .elevation = -0.5}, 0.8);
    TargetGizmo gizmo;
    gizmo.set_eye(eye);
    render::Overlay overlay;
    gizmo.draw(overlay, {});
    double furthest = 0;
    for (const render::OverlayArrow& arrow : overlay.arrows) {
      const auto pixel = pixel_of_point(eye, kPictureWidth, kPictureHeight, arrow.to_W);
      ASSERT_TRUE(pixel);
      furthest =
          std::max(furthest, (*pixel - Vector2d(kPictureWidth / 2.0, kPictureHeight / 2.0)).norm());
    }
    EXPECT_NEAR(furthest, 0.15 * kPictureHeight, 0.03 * kPictureHeight) << distance;
  }
}

TEST(TargetGizmo, ArrowsMoveAlongTheirAxisAndUnderTheMouse) {
  Rng rng(22);
  int tried = 0;
  for (int i = 0; i < 200; ++i) {
    Case c = random_case(rng);
    const Eigen::Matrix3d axes = axes_of(c);
    const int k = i % 3;
    const Vector3d a = axes.col(k);
    const Pose start = c.gizmo.pose();
    const auto pixel = pixel_of(c.gizmo, c.eye, static_cast<GizmoHandle>(k));
    if (!pixel) continue;
    ++tried;
    const Ray begin = at_pixel(c.eye, *pixel);
    ASSERT_TRUE(c.gizmo.grab(begin));
    for (int n = 0; n < 20; ++n) {
      const Vector2d to = *pixel + Vector2d(rng.uniform(-200, 200), rng.uniform(-200, 200));
      const Pose moved = c.gizmo.drag(at_pixel(c.eye, to));
      const Vector3d shift = moved.p - start.p;
      EXPECT_LT((shift - shift.dot(a) * a).norm(), 1e-9);
      EXPECT_EQ(moved.R, start.R);
      EXPECT_NEAR(c.gizmo.amount(), shift.dot(a), 1e-9);
    }
    // The mouse that follows a point of the axis takes the target along with it.
    const Vector3d sight = ray_to(c.eye, start.p).direction_W;
    if (std::abs(a.dot(sight)) > 0.9) continue;
    c.gizmo.release();
    c.gizmo.set_pose(start);
    const double s = 0.16 * c.eye.height_at(start.p);
    ASSERT_TRUE(c.gizmo.grab(ray_to(c.eye, start.p + 0.98 * s * a)));
    if (c.gizmo.held() != static_cast<GizmoHandle>(k)) continue;
    const double way = rng.uniform(-0.2, 0.2);
    c.gizmo.drag(ray_to(c.eye, start.p + (0.98 * s + way) * a));
    EXPECT_LT((c.gizmo.pose().p - start.p - way * a).norm(), 1e-9);
  }
  EXPECT_GT(tried, 150);
}

TEST(TargetGizmo, RingsTurnByTheAngleSwept) {
  Rng rng(23);
  int tried = 0;
  for (int i = 0; i < 300; ++i) {
    Case c = random_case(rng);
    const Eigen::Matrix3d axes = axes_of(c);
    const int k = i % 3;
    const Vector3d a = axes.col(k);
    const Pose start = c.gizmo.pose();
    const Vector3d sight = ray_to(c.eye, start.p).direction_W;
    if (std::abs(a.dot(sight)) < 0.4) continue;
    const double r = 0.72 * 0.16 * c.eye.height_at(start.p);
    const auto on_ring = [&](double angle) {
      return ray_to(c.eye, start.p + r * (std::cos(angle) * axes.col((k + 1) % 3) +
                                          std::sin(angle) * axes.col((k + 2) % 3)));
    };
    const double from = rng.uniform(-kPi, kPi);
    ASSERT_TRUE(c.gizmo.grab(on_ring(from)));
    if (c.gizmo.held() != static_cast<GizmoHandle>(6 + k)) continue;
    ++tried;
    // Two turns and a half, and back to one: the angle is counted on.
    for (double swept = 0; swept < 5 * kPi; swept += 0.1) {
      c.gizmo.drag(on_ring(from + swept));
      EXPECT_NEAR(c.gizmo.amount(), swept, 1e-9);
      EXPECT_EQ(c.gizmo.pose().p, start.p);
    }
    for (double swept = 5 * kPi; swept > 1; swept -= 0.1) c.gizmo.drag(on_ring(from + swept));
    c.gizmo.drag(on_ring(from + 1));
    EXPECT_NEAR(c.gizmo.amount(), 1, 1e-9);
    EXPECT_LT((c.gizmo.pose().R - rotation_exp(a) * start.R).norm(), 1e-9);
  }
  EXPECT_GT(tried, 60);
}

TEST(TargetGizmo, SquaresAndTheBallMoveInTheirPlane) {
  Rng rng(24);
  int tried = 0;
  for (int i = 0; i < 160; ++i) {
    Case c = random_case(rng);
    const Eigen::Matrix3d axes = axes_of(c);
    const GizmoHandle handle = kAll[i % 4 == 3 ? 9 : 3 + i % 4];
    const Pose start = c.gizmo.pose();
    const auto pixel = pixel_of(c.gizmo, c.eye, handle);
    if (!pixel) continue;
    ++tried;
    ASSERT_TRUE(c.gizmo.grab(at_pixel(c.eye, *pixel)));
    const Vector3d normal = handle == GizmoHandle::move_free ? ray_to(c.eye, start.p).direction_W
                                                             : Vector3d(axes.col(i % 4));
    for (int n = 0; n < 20; ++n) {
      const Vector2d to = *pixel + Vector2d(rng.uniform(-200, 200), rng.uniform(-200, 200));
      const Vector3d shift = c.gizmo.drag(at_pixel(c.eye, to)).p - start.p;
      EXPECT_NEAR(shift.dot(normal), 0, 1e-9);
      EXPECT_EQ(c.gizmo.pose().R, start.R);
    }
  }
  EXPECT_GT(tried, 120);
}

/// Wherever the mouse goes in between, back at its start the target is where it was.
TEST(TargetGizmo, ADragThatComesBackChangesNothing) {
  Rng rng(25);
  for (int i = 0; i < 60; ++i) {
    Case c = random_case(rng);
    for (const GizmoHandle handle : kAll) {
      const Pose start = c.gizmo.pose();
      const auto pixel = pixel_of(c.gizmo, c.eye, handle);
      if (!pixel) continue;
      ASSERT_TRUE(c.gizmo.grab(at_pixel(c.eye, *pixel)));
      const Vector2d out(rng.uniform(-80, 80), rng.uniform(-80, 80));
      for (const double share : {0.2, 0.6, 1.0, 0.7, 0.3, 0.0}) {
        c.gizmo.drag(at_pixel(c.eye, *pixel + share * out));
      }
      EXPECT_LT((c.gizmo.pose().p - start.p).norm(), 1e-9);
      EXPECT_LT((c.gizmo.pose().R - start.R).norm(), 1e-9) << static_cast<int>(handle);
      c.gizmo.release();
    }
  }
}

/// Whatever the view, also along an axis or onto the edge of a ring: a mouse that goes by pixels
/// never lets the target jump.
TEST(TargetGizmo, NothingJumpsAtGrazingAngles) {
  Rng rng(26);
  for (int i = 0; i < 60; ++i) {
    const Pose start = random_pose(rng);
    const Vector3d towards =
        start.R.col(i % 3) +
        rng.uniform(0, 0.3) * Vector3d(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
    const Vector3d f =
        (i % 2 == 0 ? towards : towards.cross(start.R.col((i + 1) % 3))).normalized();
    const double distance = 2;
    const Eye eye = eye_of({.lookat_W = start.p,
                            .distance = distance,
                            .azimuth = std::atan2(f.y(), f.x()),
                            .elevation = std::asin(f.z())},
                           0.8);
    TargetGizmo gizmo(start);
    gizmo.set_eye(eye);
    for (const GizmoHandle handle : kAll) {
      const auto pixel = pixel_of(gizmo, eye, handle);
      if (!pixel) continue;
      ASSERT_TRUE(gizmo.grab(at_pixel(eye, *pixel)));
      const double heading = rng.uniform(-kPi, kPi);
      Pose last = start;
      double longest = 0, farthest = 0;
      bool finite = true;
      for (int n = 0; n < 800; ++n) {
        const Vector2d to = *pixel + n * Vector2d(std::cos(heading), std::sin(heading));
        const Pose now = gizmo.drag(at_pixel(eye, to));
        finite = finite && now.p.allFinite() && now.R.allFinite();
        longest = std::max(longest, (now.p - last.p).norm());
        farthest = std::max(farthest, (now.p - start.p).norm());
        last = now;
      }
      EXPECT_TRUE(finite) << static_cast<int>(handle);
      EXPECT_LT(longest, 0.05 * distance) << static_cast<int>(handle);
      EXPECT_LT(farthest, 3.001 * distance) << static_cast<int>(handle);
      gizmo.set_pose(start);
    }
  }
}

TEST(TargetGizmo, DegenerateRaysChangeNothing) {
  const double nan = std::nan("");
  const Pose start{{0.3, 0.1, 0.5}, from_euler({0.3, 0.2, 0.1})};
  const Eye eye = eye_of({.lookat_W = start.p, .distance = 2, .elevation = -0.5}, 0.8);
  TargetGizmo gizmo(start);
  gizmo.set_eye(eye);
  const Ray bad[] = {
      {{nan, 0, 0}, {1, 0, 0}},           {{0, 0, 0}, {nan, 0, 0}},  {{0, 0, 0}, {0, 0, 0}},
      {{0, 0, 0}, {INFINITY, 0, 0}},      {eye.p_W, -eye.forward_W}, {eye.p_W, eye.up_W},
      {{1e300, 1e300, 1e300}, {1, 0, 0}}, {start.p, {1, 0, 0}}};
  for (const Ray& ray : bad) {
    gizmo.hover(ray);
    if (gizmo.grab(ray)) gizmo.drag(ray);
    gizmo.release();
    EXPECT_LT((gizmo.pose().p - start.p).norm(), 1e-12);
  }
  for (const GizmoHandle handle : kAll) {
    const auto pixel = pixel_of(gizmo, eye, handle);
    if (!pixel) continue;
    ASSERT_TRUE(gizmo.grab(at_pixel(eye, *pixel)));
    for (const Ray& ray : bad) {
      const Pose& pose = gizmo.drag(ray);
      EXPECT_TRUE(pose.p.allFinite() && pose.R.allFinite());
    }
    gizmo.set_pose(start);
  }
  EXPECT_FALSE(gizmo.held());
  gizmo.drag(ray_to(eye, {0, 0, 0}));
  EXPECT_EQ(gizmo.pose().p, start.p) << "nothing is held";
}

TEST(TargetGizmo, BehindTheEyeItIsNeitherDrawnNorHit) {
  TargetGizmo gizmo;
  gizmo.set_eye(eye_of({.lookat_W = {5, 0, 0}, .distance = 1}, 0.8));
  render::Overlay overlay;
  gizmo.draw(overlay, {});
  EXPECT_EQ(shapes_of(overlay), 0U);
  EXPECT_FALSE(gizmo.hover({{4, 0, 0}, {-1, 0, 0}}));
}

TEST(TargetGizmo, WithoutRingsNothingTurns) {
  const Eye eye{.p_W = {-2, 0, 0}};
  TargetGizmo with;
  TargetGizmo without({}, {.turns = false});
  with.set_eye(eye);
  without.set_eye(eye);
  render::Overlay rings, none;
  with.draw(rings, {});
  without.draw(none, {});
  EXPECT_EQ(rings.lines.size(), 6U);
  EXPECT_TRUE(none.lines.empty());
  EXPECT_EQ(none.arrows.size(), 3U);
  int turned = 0;
  for (int i = 0; i < 400; ++i) {
    const Ray ray = ray_of_pixel(eye, 20, 20, 5 + 0.5 * (i % 20), 5 + 0.5 * (i / 20));
    const auto is_ring = [](std::optional<GizmoHandle> handle) {
      return handle && *handle >= GizmoHandle::turn_x && *handle <= GizmoHandle::turn_z;
    };
    if (is_ring(with.hover(ray))) ++turned;
    EXPECT_FALSE(is_ring(without.hover(ray)));
  }
  EXPECT_GT(turned, 0);
}

TEST(TargetGizmo, DrawingShowsWhatIsHoveredAndHeld) {
  const Eye eye = eye_of({.distance = 2, .azimuth = 0.6, .elevation = -0.5}, 0.8);
  TargetGizmo gizmo;
  gizmo.set_eye(eye);
  const render::Rgba state{0.1F, 0.2F, 0.3F, 1};
  render::Overlay plain;
  gizmo.draw(plain, state);
  EXPECT_EQ(plain.spheres.at(0).color, state);
  EXPECT_TRUE(plain.labels.empty());
  const auto pixel = pixel_of(gizmo, eye, GizmoHandle::move_z);
  ASSERT_TRUE(pixel);
  gizmo.hover(at_pixel(eye, *pixel));
  render::Overlay hovered;
  gizmo.draw(hovered, state);
  EXPECT_NE(hovered.arrows.at(2).color, plain.arrows.at(2).color);
  EXPECT_EQ(hovered.arrows.at(0).color, plain.arrows.at(0).color);
  gizmo.grab(at_pixel(eye, *pixel));
  gizmo.drag(at_pixel(eye, *pixel + Vector2d(0, -50)));
  render::Overlay held;
  gizmo.draw(held, state);
  EXPECT_LT(held.arrows.at(0).color.a, 0.5F);
  EXPECT_GT(held.arrows.at(2).color.a, 0.9F);
  ASSERT_EQ(held.labels.size(), 1U);
  EXPECT_EQ(held.labels[0].text.front(), '+') << held.labels[0].text;
  EXPECT_GT(gizmo.pose().p.z(), 0.05);
}

}  // namespace
}  // namespace mjarm::view
