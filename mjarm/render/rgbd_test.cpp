#include "mjarm/render/rgbd.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace mjarm::render {
namespace {

/// A floor, a ball above it, a tilted board, and a site that no camera may see. `eye` looks down
/// askew; `lens` is told by its focal length and an off-centre sensor; `wrist` moves with a joint.
constexpr const char* kGarden = R"(
<mujoco model="garden">
  <statistic extent="2" center="0 0 0"/>
  <visual><headlight ambient="1 1 1" diffuse="0 0 0" specular="0 0 0"/></visual>
  <worldbody>
    <camera name="eye" pos="0.3 -0.5 0.6" xyaxes="0.9 0.3 0.1 -0.2 0.5 0.6" fovy="50"/>
    <camera name="lens" pos="0 0 0.7" xyaxes="1 0 0 0 1 0" resolution="640 480"
            focal="0.004 0.005" sensorsize="0.0064 0.0048" principal="0.0003 -0.0002"/>
    <geom name="floor" type="plane" size="3 3 0.1" rgba="0.4 0.4 0.4 1"/>
    <geom name="ball" type="sphere" size="0.1" pos="0.05 0 0.12" rgba="1 0 0 1"/>
    <geom name="board" type="box" size="0.1 0.08 0.002" pos="-0.25 0.05 0.1" euler="30 20 10"/>
    <site type="sphere" size="0.3" rgba="0 1 0 1"/>
    <body pos="0 0 0.5">
      <joint name="lift" type="slide" axis="0 0 1"/>
      <geom type="sphere" size="0.01" pos="0.2 0.2 0.2" mass="1"/>
      <camera name="wrist" pos="0 0 0.1" xyaxes="0 -1 0 1 0 0" fovy="45"/>
    </body>
  </worldbody>
</mujoco>)";

struct Garden {
  Garden() : model(*Model::from_mjcf(kGarden)), d(mj_makeData(model.raw()), mj_deleteData) {
    mj_forward(model.raw(), d.get());
  }
  /// [m] along the optical axis to what MuJoCo's own rays meet first, -1 where they meet nothing;
  /// and the cosine between ray and surface.
  std::pair<double, double> ray_depth(const RgbdFrame& frame, int x, int y) const {
    const Eigen::Vector3d ray_W = frame.X_WC.R * frame.intrinsics.ray({x, y});
    int geom = -1;
    Eigen::Vector3d normal_W;
    const double depth = mj_ray(model.raw(), d.get(), frame.X_WC.p.data(), ray_W.data(), nullptr, 1,
                                -1, &geom, normal_W.data());
    return {depth, geom < 0 ? 1 : std::abs(normal_W.dot(ray_W.normalized()))};
  }
  Model model;
  std::unique_ptr<mjData, void (*)(mjData*)> d;
};

std::unique_ptr<RgbdCamera> camera_of(const Garden& garden, const char* name,
                                      const RgbdOptions& options) {
  Result<RgbdCamera> made = RgbdCamera::create(garden.model, name, options);
  return made ? std::make_unique<RgbdCamera>(std::move(*made)) : nullptr;
}

bool can_draw() { return GlContext::create().has_value(); }

class Rgbd : public ::testing::TestWithParam<const char*> {};

// Every 7th pixel against MuJoCo's rays, which know nothing of OpenGL, nor of our intrinsics.
TEST_P(Rgbd, DepthIsThatOfRaysThroughThePixels) {
  if (!can_draw()) GTEST_SKIP() << "no OpenGL";
  const Garden garden;
  const auto camera = camera_of(garden, GetParam(), {.depth_sigma = 0, .supersampling = 2});
  ASSERT_TRUE(camera);
  Rng rng(1);
  const Result<RgbdFrame> frame = camera->look({}, rng);
  ASSERT_TRUE(frame) << frame.error().what;
  ASSERT_EQ(frame->depth.size(), std::size_t{1280} * 720);
  int compared = 0;
  int other = 0;
  for (int y = 3; y < 720; y += 7) {
    for (int x = 3; x < 1280; x += 7) {
      const auto [expected, cosine] = garden.ray_depth(*frame, x, y);
      const double depth = frame->depth[static_cast<std::size_t>(1280 * y + x)];
      ++compared;
      // At an edge another thing may be seen; where a ball turns away, its faces are off by more.
      if (expected < 0 ? depth != 0 : std::abs(depth - expected) * cosine > 1e-4) ++other;
    }
  }
  EXPECT_GT(compared, 15000);
  EXPECT_LT(other, compared / 2000);
}
INSTANTIATE_TEST_SUITE_P(Cameras, Rgbd, ::testing::Values("eye", "lens", "wrist"),
                         [](const auto& camera) { return std::string(camera.param); });

TEST(RgbdCamera, ColoursFitDepthAndSitesAreNotSeen) {
  if (!can_draw()) GTEST_SKIP() << "no OpenGL";
  const Garden garden;
  const auto camera = camera_of(garden, "eye", {.depth_sigma = 0});
  ASSERT_TRUE(camera);
  Rng rng(1);
  const RgbdFrame frame = *camera->look({}, rng);
  const Eigen::Vector3d middle_W(0.05, 0, 0.12);
  int red = 0;
  for (int y = 0; y < 720; y += 5) {
    for (int x = 0; x < 1280; x += 5) {
      const auto [r, g, b] = frame.color.pixel(x, y);
      EXPECT_FALSE(g > 100 && r < 60) << "a site at " << x << ", " << y;
      if (!(r > 150 && g < 60)) continue;
      ++red;
      const double z = frame.depth[static_cast<std::size_t>(1280 * y + x)];
      const Eigen::Vector3d p_W = frame.X_WC * (z * frame.intrinsics.ray({x, y}));
      EXPECT_LT((p_W - middle_W).norm(), 0.1002);
    }
  }
  EXPECT_GT(red, 200);
}

TEST(RgbdCamera, NoiseGrowsWithTheSquareOfDepthAndComesFromTheGenerator) {
  if (!can_draw()) GTEST_SKIP() << "no OpenGL";
  const Garden garden;
  const auto exact = camera_of(garden, "lens", {.depth_sigma = 0});
  const auto noisy = camera_of(garden, "lens", {.depth_sigma = 0.001});
  ASSERT_TRUE(exact && noisy);
  Rng first(7), again(7), other(8);
  const RgbdFrame truth = *exact->look({}, other);
  const RgbdFrame frame = *noisy->look({}, first);
  EXPECT_EQ(frame.depth, noisy->look({}, again)->depth);
  EXPECT_NE(frame.depth, noisy->look({}, other)->depth);
  double squares = 0;
  double sum = 0;
  for (std::size_t i = 0; i < truth.depth.size(); ++i) {
    const double z = truth.depth[i];
    const double e = z > 0 ? (frame.depth[i] - z) / (0.001 * z * z / 0.25) : 0;
    sum += e;
    squares += e * e;
  }
  const auto n = static_cast<double>(truth.depth.size());
  EXPECT_NEAR(sum / n, 0, 0.01);
  EXPECT_NEAR(std::sqrt(squares / n), 1, 0.01);
}

TEST(RgbdCamera, ACameraThatMovesIsWhereTheSnapshotHasIt) {
  if (!can_draw()) GTEST_SKIP() << "no OpenGL";
  const Garden garden;
  const auto camera = camera_of(garden, "wrist", {.depth_sigma = 0, .farthest = 0.7});
  ASSERT_TRUE(camera);
  Rng rng(1);
  const RgbdFrame low = *camera->look({}, rng);
  const std::size_t corner = 1280 * 5 + 5;
  EXPECT_NEAR(low.X_WC.p.z(), 0.6, 1e-12);
  EXPECT_NEAR(low.depth[corner], 0.6, 1e-4);  // the floor, straight below
  Sim sim(garden.model);
  sim.set_state(std::vector<double>{0.2}, std::vector<double>{0});
  const RgbdFrame high = *camera->look(sim.snapshot(), rng);
  EXPECT_NEAR(high.X_WC.p.z(), 0.8, 1e-12);
  EXPECT_EQ(high.depth[corner], 0) << "beyond 0.7 m nothing is measured";
  EXPECT_TRUE(high.X_WC.R.col(2).isApprox(-Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(high.X_WC.R.col(0).isApprox(-Eigen::Vector3d::UnitY()));
}

TEST(RgbdCamera, BadCamerasAndOptionsAreRefused) {
  if (!can_draw()) GTEST_SKIP() << "no OpenGL";
  const Garden garden;
  const auto why = [&](const char* name, const RgbdOptions& options) {
    const Result<RgbdCamera> made = RgbdCamera::create(garden.model, name, options);
    return made ? std::string() : made.error().what;
  };
  EXPECT_NE(why("wirst", {}).find("wrist"), std::string::npos);
  EXPECT_NE(why("", {}), "");
  EXPECT_NE(why("eye", {.depth_sigma = -1}).find("depth_sigma"), std::string::npos);
  EXPECT_NE(why("eye", {.nearest = 1, .farthest = 0.5}).find("farthest"), std::string::npos);
  EXPECT_NE(why("eye", {.width = 0}).find("0 x 720"), std::string::npos);
}

}  // namespace
}  // namespace mjarm::render
