#include "mjarm/render/free_camera.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mjarm/render/offscreen.hpp"

namespace mjarm::render {
namespace {

/// A red ball of 2 cm before black, drawn where the pinhole says.
TEST(FreeCamera, SeesAPointWhereItsPoseAndAngleSay) {
  const Eigen::Vector3d p_W(0.3, -0.1, 0.2);
  const Model model = Model::from_mjcf(R"(<mujoco><visual><global fovy="40"/></visual><worldbody>
    <light pos="0 0 3"/>
    <geom type="sphere" size="0.02" pos="0.3 -0.1 0.2" rgba="1 0 0 1"/></worldbody></mujoco>)")
                          .value();
  constexpr int kSize = 256;
  auto renderer = OffscreenRenderer::create(
      model, {.width = kSize, .height = kSize, .quality = RenderQuality::low});
  if (!renderer) GTEST_SKIP() << renderer.error().what;
  const CameraView view{
      .lookat_W = {0.2, 0.05, 0.1}, .distance = 1.1, .azimuth = 2.1, .elevation = -0.5};
  const Image image = renderer->draw({}, {.view = view}).value();
  double count = 0, x = 0, y = 0;
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      const auto pixel = image.pixel(column, row);
      if (pixel[0] < 30 || pixel[1] > pixel[0] / 2) continue;
      count += 1;
      x += column + 0.5;
      y += row + 0.5;
    }
  }
  ASSERT_GT(count, 20);
  const Eigen::Vector3d p_C = camera_pose(view).inverse() * p_W;
  const double focal = kSize / 2.0 / std::tan(free_camera_fovy(model) / 2);
  EXPECT_NEAR(x / count, kSize / 2.0 + focal * p_C.x() / -p_C.z(), 1);
  EXPECT_NEAR(y / count, kSize / 2.0 - focal * p_C.y() / -p_C.z(), 1);
}

}  // namespace
}  // namespace mjarm::render
