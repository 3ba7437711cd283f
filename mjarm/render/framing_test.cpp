#include "mjarm/render/framing.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "mjarm/core/rng.hpp"
#include "mjarm/render/scene.hpp"

namespace mjarm::render {
namespace {

Model empty_room() {
  return Model::from_mjcf(R"(<mujoco><visual><global fovy="50"/></visual>
      <worldbody><geom size="0.1"/></worldbody></mujoco>)")
      .value();
}

/// By how much of its half the ball reaches out of the middle of the picture, the larger of both
/// directions: 1 is at the edge. By MuJoCo's own camera.
double reach(const Model& model, const CameraView& view, const FramedBall& ball, double aspect) {
  Scene scene(model, RenderQuality::low);
  EXPECT_TRUE(scene.set_camera({.view = view}));
  scene.update({});
  const mjvGLCamera camera = mjv_averageCamera(&scene.raw().camera[0], &scene.raw().camera[1]);
  const auto vector = [](const float* v) { return Eigen::Vector3d(v[0], v[1], v[2]); };
  const Eigen::Vector3d forward = vector(camera.forward), up = vector(camera.up);
  const Eigen::Vector3d right = forward.cross(up);
  const Eigen::Vector3d p = ball.p_W - vector(camera.pos);
  const double tangent = camera.frustum_top / camera.frustum_near;
  const auto part = [&](const Eigen::Vector3d& axis, double t) {
    // The cone of lines that touch the ball reaches beyond its centre.
    const double depth = p.dot(forward), across = std::abs(p.dot(axis));
    const double d = std::hypot(depth, across);
    EXPECT_GT(depth, ball.radius);
    return std::tan(std::atan2(across, depth) + std::asin(ball.radius / d)) / t;
  };
  return std::max(part(up, tangent), part(right, tangent * aspect));
}

TEST(Framing, AllIsInThePictureAndSomethingNearlyTouchesItsEdge) {
  const Model model = empty_room();
  Rng rng(5);
  for (int round = 0; round < 200; ++round) {
    std::vector<FramedBall> balls(1 + rng.below(12));
    for (FramedBall& ball : balls) {
      for (int k = 0; k < 3; ++k) ball.p_W[k] = rng.uniform(-1, 1);
      ball.radius = rng.uniform(0.01, 0.3);
    }
    const LineOfSight sight{rng.uniform(-3.1, 3.1), rng.uniform(-1.4, 1.4), rng.uniform(0.5, 2.5)};
    const CameraView view = framing_view(model, balls, sight);
    EXPECT_EQ(view.azimuth, sight.azimuth);
    EXPECT_EQ(view.elevation, sight.elevation);
    double max = 0;
    for (const FramedBall& ball : balls) {
      max = std::max(max, reach(model, view, ball, sight.aspect));
    }
    EXPECT_LT(max, 1);
    EXPECT_GT(max, 0.9);
  }
}

TEST(Framing, NothingToFrameIsTheViewOfTheModel) {
  const Model model = empty_room();
  const LineOfSight sight{1, -0.5, 1};
  const CameraView plain = default_view(model);
  EXPECT_EQ(framing_view(model, {}, sight).distance, plain.distance);
  const FramedBall bad{{0, std::numeric_limits<double>::quiet_NaN(), 0}, 0.1};
  EXPECT_EQ(framing_view(model, {&bad, 1}, sight).lookat_W, plain.lookat_W);
}

TEST(Framing, TheCameraStandsBehindWhatItLooksAt) {
  const CameraView view{{1, 2, 3}, 2, std::numbers::pi / 2, 0};
  EXPECT_LT((camera_place(view) - Eigen::Vector3d(1, 0, 3)).norm(), 1e-12);
}

}  // namespace
}  // namespace mjarm::render
