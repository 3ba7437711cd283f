#include "mjarm/view/ray.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "mjarm/core/rng.hpp"
#include "mjarm/render/offscreen.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::view {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kRayWide = 640;
constexpr int kRayHigh = 360;

constexpr const char* kRoom = R"(
<mujoco model="room">
  <visual><global fovy="FOVY" ORTHO/><headlight ambient="1 1 1" diffuse="0 0 0" specular="0 0 0"/></visual>
  <statistic center="0 0 0.5" extent="2"/>
  <worldbody>
    <camera name="side" pos="2 -2 1" xyaxes="0.7 0.7 0 -0.2 0.2 0.9" fovy="50"/>
    <geom type="plane" size="0 0 1" rgba="0 0 0 1"/>
    <geom type="box" size="0.2 0.3 0.4" pos="0.1 0 0.4" rgba="0 0 0 1"/>
  </worldbody>
</mujoco>)";

class Rays : public ::testing::TestWithParam<bool> {
 protected:
  void SetUp() override {
    std::string xml = kRoom;
    xml.replace(xml.find("FOVY"), 4, GetParam() ? "2.5" : "40");
    xml.replace(xml.find("ORTHO"), 5, GetParam() ? "orthographic=\"true\"" : "");
    Result<Model> loaded = Model::load(folder_.write("room.xml", xml));
    ASSERT_TRUE(loaded) << loaded.error().what;
    model_ = std::make_unique<Model>(*loaded);
    scene_ = std::make_unique<render::Scene>(*model_, render::RenderQuality::low);
  }
  static render::CameraView random_view(Rng& rng) {
    return {.lookat_W = {rng.uniform(-0.2, 0.2), rng.uniform(-0.2, 0.2), rng.uniform(0.2, 0.6)},
            .distance = rng.uniform(1.5, 4),
            .azimuth = rng.uniform(-3, 3),
            .elevation = rng.uniform(-1.4, -0.1)};
  }
  support::TempFolder folder_;
  std::unique_ptr<Model> model_;
  std::unique_ptr<render::Scene> scene_;
};

/// MuJoCo's own selection with the mouse finds points on our rays.
TEST_P(Rays, AgreeWithMujocosSelection) {
  const mjModel& m = scene_->model();
  const std::unique_ptr<mjData, void (*)(mjData*)> d(mj_makeData(&m), mj_deleteData);
  mj_forward(&m, d.get());
  mjvOption option;
  mjv_defaultOption(&option);
  Rng rng(7);
  int found = 0;
  for (int i = 0; i < 300; ++i) {
    const render::Camera camera =
        i % 10 == 0 ? render::Camera{.name = "side"} : render::Camera{.view = random_view(rng)};
    ASSERT_TRUE(scene_->set_camera(camera));
    scene_->update({});
    const Eye eye = eye_of(*scene_);
    const double x = rng.uniform(0, kRayWide);
    const double y = rng.uniform(0, kRayHigh);
    mjtNum at[3];
    int geom = -1;
    int flex = -1;
    int skin = -1;
    const int body =
        mjv_select(&m, d.get(), &option, static_cast<mjtNum>(kRayWide) / kRayHigh, x / kRayWide,
                   1 - y / kRayHigh, &scene_->raw(), at, &geom, &flex, &skin);
    if (body < 0) continue;
    ++found;
    const Vector3d p(at[0], at[1], at[2]);
    const Ray ray = ray_of_pixel(eye, kRayWide, kRayHigh, x, y);
    EXPECT_NEAR(ray.direction_W.norm(), 1, 1e-12);
    const Vector3d off = p - ray.origin_W;
    const double miss = (off - off.dot(ray.direction_W) * ray.direction_W).norm();
    EXPECT_LT(miss, 1e-5 * off.norm()) << i;
    const std::optional<Vector2d> back = pixel_of_point(eye, kRayWide, kRayHigh, p);
    ASSERT_TRUE(back);
    EXPECT_LT((*back - Vector2d(x, y)).norm(), 0.02);
  }
  EXPECT_GT(found, 150);
}

TEST_P(Rays, TheFreeCameraIsWhereMujocoPutsIt) {
  if (GetParam()) GTEST_SKIP() << "eye_of(CameraView) is for cameras with perspective";
  Rng rng(8);
  for (int i = 0; i < 100; ++i) {
    const render::CameraView view = random_view(rng);
    ASSERT_TRUE(scene_->set_camera({.view = view}));
    scene_->update({});
    const Eye theirs = eye_of(*scene_);
    const Eye ours = eye_of(view, 40 * std::numbers::pi / 180);
    EXPECT_LT((theirs.p_W - ours.p_W).norm(), 1e-5);
    EXPECT_LT((theirs.forward_W - ours.forward_W).norm(), 1e-6);
    EXPECT_LT((theirs.up_W - ours.up_W).norm(), 1e-6);
    EXPECT_NEAR(theirs.upper, ours.upper, 1e-6);
    EXPECT_NEAR(theirs.lower, ours.lower, 1e-6);
    EXPECT_NEAR(theirs.middle, 0, 1e-6);
  }
}

/// A ball of the overlay is seen at the pixel that `pixel_of_point` tells.
TEST_P(Rays, PointsAreSeenWhereTheyAreSaidToBe) {
  Result<render::OffscreenRenderer> made = render::OffscreenRenderer::create(
      *model_, {.width = kRayWide, .height = kRayHigh, .quality = render::RenderQuality::low});
  if (!made) GTEST_SKIP() << made.error().what;
  Rng rng(9);
  for (int i = 0; i < 10; ++i) {
    const render::Camera camera{.view = random_view(rng)};
    const Vector3d p(rng.uniform(-0.3, 0.3), rng.uniform(-0.3, 0.3), rng.uniform(0.9, 1.2));
    render::Overlay overlay;
    overlay.spheres.push_back({p, 0.03, {0, 1, 0, 1}});
    const Result<render::Image> image = made->draw({}, camera, overlay);
    ASSERT_TRUE(image) << image.error().what;
    Vector2d sum = Vector2d::Zero();
    int count = 0;
    for (int y = 0; y < kRayHigh; ++y) {
      for (int x = 0; x < kRayWide; ++x) {
        const auto [r, g, b] = image->pixel(x, y);
        if (g < 120 || r > 60 || b > 60) continue;
        sum += Vector2d(x + 0.5, y + 0.5);
        ++count;
      }
    }
    ASSERT_TRUE(scene_->set_camera(camera));
    scene_->update({});
    const std::optional<Vector2d> at = pixel_of_point(eye_of(*scene_), kRayWide, kRayHigh, p);
    ASSERT_TRUE(at);
    if (count < 20) continue;  // outside of the picture
    const bool whole =
        at->x() > 20 && at->x() < kRayWide - 20 && at->y() > 20 && at->y() < kRayHigh - 20;
    if (whole) {
      EXPECT_LT((sum / count - *at).norm(), 0.6);
    }
  }
}

std::string projection(const ::testing::TestParamInfo<bool>& info) {
  return info.param ? "orthographic" : "perspective";
}
INSTANTIATE_TEST_SUITE_P(Projections, Rays, ::testing::Bool(), projection);

TEST(RaysAlone, NothingBehindTheEyeHasAPixel) {
  const Eye eye = eye_of({.distance = 2}, 0.8);
  EXPECT_FALSE(pixel_of_point(eye, kRayWide, kRayHigh, {-5, 0, 0}));
  EXPECT_LE(eye.height_at({-5, 0, 0}), 0);
  const std::optional<Vector2d> middle = pixel_of_point(eye, kRayWide, kRayHigh, {0, 0, 0});
  ASSERT_TRUE(middle);
  EXPECT_LT((*middle - Vector2d(kRayWide / 2.0, kRayHigh / 2.0)).norm(), 1e-9);
}

}  // namespace
}  // namespace mjarm::view
