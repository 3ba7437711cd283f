// Views of what moves, judged by MuJoCo's own rays and camera.
#include "mjarm/render/clear_view.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>

#include "mjarm/render/scene.hpp"

namespace mjarm::render {
namespace {

/// A pendulum in a hall of 40 m, on a floor, beside a post that it cannot reach round.
constexpr const char* kHall = R"(<mujoco>
  <worldbody>
    <geom name="floor" type="plane" size="20 20 0.1"/>
    <geom name="wall" type="box" size="20 0.1 5" pos="0 20 5"/>
    <geom name="post" type="box" size="0.05 0.05 0.3" pos="0.3 0 0.3"/>
    <body name="arm" pos="0 0 0.4">
      <joint axis="0 1 0"/>
      <geom name="rod" type="capsule" fromto="0 0 0 0 0 0.4" size="0.03"/>
    </body>
  </worldbody>
</mujoco>)";

/// Where a point is in the picture: -1 to 1 in both directions is inside.
Eigen::Vector2d place_in(const Model& model, const CameraView& view, const Eigen::Vector3d& p_W,
                         double aspect) {
  Scene scene(model, RenderQuality::low);
  EXPECT_TRUE(scene.set_camera({.view = view}));
  scene.update({});
  const mjvGLCamera camera = mjv_averageCamera(&scene.raw().camera[0], &scene.raw().camera[1]);
  const auto vector = [](const float* v) { return Eigen::Vector3d(v[0], v[1], v[2]); };
  const Eigen::Vector3d forward = vector(camera.forward), up = vector(camera.up);
  const Eigen::Vector3d way = p_W - vector(camera.pos);
  const double depth = way.dot(forward) * camera.frustum_top / camera.frustum_near;
  return {way.dot(forward.cross(up)) / (depth * aspect), way.dot(up) / depth};
}

TEST(ClearView, WhatMovesIsNotTinyInALargeHall) {
  const Model model = Model::from_mjcf(kHall).value();
  const CameraView view = default_view(model);
  EXPECT_LT(view.distance, 3) << "MuJoCo would stand " << 1.5 * model.raw()->stat.extent
                              << " m off";
  const double height = (place_in(model, view, {0, 0, 0.83}, 16.0 / 9) -
                         place_in(model, view, {0, 0, 0.37}, 16.0 / 9))
                            .y();
  EXPECT_GT(height, 0.5) << "a quarter of the picture";
  // As long as it is flat and near from where the camera looks, an arm of 1 m is not tiny.
  const Model arm = Model::from_mjcf(R"(<mujoco><visual><global azimuth="90"/></visual>
      <statistic center="0 0 0" extent="1.2"/><worldbody><body><joint axis="1 0 0"/>
      <geom type="capsule" fromto="0 0 0 0 1 0" size="0.05"/></body></worldbody></mujoco>)")
                        .value();
  EXPECT_NEAR(default_view(arm).distance, 1.8, 1e-6);
  const Model still = Model::from_mjcf(
                          "<mujoco><statistic extent='30'/><worldbody><geom size='1'/>"
                          "</worldbody></mujoco>")
                          .value();
  EXPECT_NEAR(default_view(still).distance, 45, 1e-6) << "nothing moves: as the file asks";
}

TEST(ClearView, PartsAreThoseThatMoveAndWhatIsInTheirReach) {
  const Model model = Model::from_mjcf(kHall).value();
  const Snapshot start;
  const std::vector<FramedBall> parts = moving_parts(model, {&start, 1});
  Eigen::Vector3d low = parts.at(0).p_W, high = low;
  for (const FramedBall& ball : parts) {
    low = low.cwiseMin(ball.p_W);
    high = high.cwiseMax(ball.p_W);
  }
  EXPECT_LT((low - Eigen::Vector3d(-0.03, -0.05, 0)).norm(), 0.01) << low.transpose();
  EXPECT_LT((high - Eigen::Vector3d(0.35, 0.05, 0.83)).norm(), 0.01) << high.transpose();
}

TEST(ClearView, AModelWithoutLooksIsSeenFromSomewhere) {
  // Nothing but one point to be seen: the camera stands on it, and no ray leads from there to it.
  const Model model = Model::from_mjcf(R"(<mujoco><worldbody><body><joint/>
      <geom size="0.1" group="4"/></body></worldbody></mujoco>)")
                          .value();
  const Eigen::Vector3d point(0.2, 0, 0.1);
  const CameraView view = clear_view(model, {{{point, 0}}, {point}, {Snapshot{}}}, 1.5);
  EXPECT_GT(view.distance, 0);
}

/// Something was written behind a wide shield, as it looks from the model's own heading: the view
/// goes round the shield, faces the plane that was written on, and holds all of it.
TEST(ClearView, GoesRoundWhatHides) {
  constexpr const char* kShield = R"(<mujoco>
    <visual><global azimuth="90"/></visual><statistic center="0 0 0" extent="1"/>
    <worldbody><body><joint axis="0 0 1"/>
      <geom type="box" size="0.6 0.02 0.5" pos="0 -0.4 0"/></body></worldbody></mujoco>)";
  const Model model = Model::from_mjcf(kShield).value();
  ViewSubject subject;
  subject.moments.resize(1);
  subject.balls = moving_parts(model, subject.moments);
  for (int i = 0; i < 40; ++i) {
    subject.marks_W.push_back({0.3 * std::cos(0.3 * i), 0, 0.3 * std::sin(0.3 * i)});
    subject.balls.push_back({subject.marks_W.back(), 0});
  }
  const CameraView view = clear_view(model, subject, 1.5);
  const Eigen::Vector3d eye = camera_place(view);
  Scene scene(model, RenderQuality::low);
  ASSERT_TRUE(scene.set_state({}));
  int hidden = 0;
  for (const Eigen::Vector3d& p_W : subject.marks_W) {
    const Eigen::Vector3d way = p_W - eye;
    const double hit = mj_ray(&scene.model(), &scene.data(), eye.data(), way.data(), nullptr, 1, -1,
                              nullptr, nullptr);
    hidden += hit >= 0 && hit < 0.99 ? 1 : 0;
  }
  EXPECT_EQ(hidden, 0);
  EXPECT_GT(std::abs((eye - view.lookat_W).normalized().y()), 0.5) << "not edge-on";
  for (const FramedBall& ball : subject.balls) {
    EXPECT_LT(place_in(model, view, ball.p_W, 1.5).cwiseAbs().maxCoeff(), 1);
  }
}

/// What lies flat is looked at from above, and from where it is read, whichever way that is.
TEST(ClearView, ATextIsSeenAsItIsRead) {
  const Model model = Model::from_mjcf(kHall).value();
  for (const double turn : {0.3, 2.0, -1.5}) {
    const Eigen::Vector3d right(std::cos(turn), std::sin(turn), 0), up(-right.y(), right.x(), 0);
    ViewSubject subject;
    subject.right_W = right;
    subject.moments.resize(1);
    subject.balls = moving_parts(model, subject.moments);
    for (int i = 0; i < 40; ++i) {
      subject.marks_W.push_back(0.6 * right + 0.1 * (std::cos(i) * right + std::sin(i) * up));
      subject.balls.push_back({subject.marks_W.back(), 0});
    }
    const CameraView view = clear_view(model, subject, 1.5);
    EXPECT_LT(view.elevation, -0.6);
    const Eigen::Vector3d middle = 0.6 * right;
    const auto place = [&](const Eigen::Vector3d& p_W) { return place_in(model, view, p_W, 1.5); };
    const Eigen::Vector2d across = place(middle + 0.1 * right) - place(middle);
    EXPECT_GT(across.x(), 2 * std::abs(across.y())) << turn;
    EXPECT_GT((place(middle + 0.1 * up) - place(middle)).y(), 0) << turn;
  }
}

}  // namespace
}  // namespace mjarm::render
