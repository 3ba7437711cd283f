#include "mjarm/render/camera.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "mjarm/render/scene.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::render {
namespace {

constexpr const char* kScene = R"(
<mujoco>
  <statistic center="0.1 0.2 0.3" extent="2"/>
  <visual><global azimuth="-45" elevation="-20"/></visual>
  <worldbody>
    <camera name="overview" pos="1 -2 1.5" xyaxes="0.8 0.6 0 -0.3 0.4 0.8"/>
    <camera pos="0 0 1"/>
    <geom type="box" size="0.1 0.1 0.1"/>
  </worldbody>
</mujoco>)";

class Cameras : public ::testing::Test {
 protected:
  support::TempFolder folder_;
  Model model_ = Model::load(folder_.write("scene.xml", kScene)).value();
};

TEST_F(Cameras, DefaultIsWhatTheFileAsksFor) {
  const CameraView view = default_view(model_);
  EXPECT_TRUE(view.lookat_W.isApprox(Eigen::Vector3d(0.1, 0.2, 0.3), 1e-12));
  EXPECT_NEAR(view.azimuth, -std::numbers::pi / 4, 1e-12);
  EXPECT_NEAR(view.elevation, -std::numbers::pi / 9, 1e-12);
  EXPECT_GT(view.distance, 2);
}

TEST_F(Cameras, DefaultLooksWhereWhatMovesStandsAtHome) {
  const std::string scene = R"(
<mujoco>
  <worldbody>
    <geom type="plane" size="1 1 0.1"/>
    <body><freejoint/><geom type="box" size="0.2 0.2 0.2"/></body>
  </worldbody>
  <keyframe><key name="home" qpos="5 -3 0.2 1 0 0 0"/></keyframe>
</mujoco>)";
  const Model model = Model::load(folder_.write("moved.xml", scene)).value();
  const CameraView view = default_view(model);
  EXPECT_TRUE(view.lookat_W.isApprox(Eigen::Vector3d(5, -3, 0.2), 0.1)) << view.lookat_W;
}

TEST_F(Cameras, NamesAreListed) {
  EXPECT_EQ(camera_names(model_), std::vector<std::string>{"overview"});
}

TEST_F(Cameras, UnknownNameIsRefusedWithTheNearest) {
  const Result<void> checked = check_camera(model_, {.name = "overveiw"});
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().code, Errc::bad_input);
  for (const char* part : {"scene.xml", "\"overveiw\"", "did you mean \"overview\""}) {
    EXPECT_NE(checked.error().what.find(part), std::string::npos) << checked.error().what;
  }
}

TEST_F(Cameras, BadNumbersAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CameraView view;
  EXPECT_TRUE(check_camera(model_, {.view = view}));
  view.distance = -1;
  EXPECT_FALSE(check_camera(model_, {.view = view}));
  view.distance = 1;
  view.azimuth = nan;
  const Result<void> checked = check_camera(model_, {.view = view});
  ASSERT_FALSE(checked);
  EXPECT_NE(checked.error().what.find("azimuth"), std::string::npos) << checked.error().what;
  view = {.lookat_W = {0, nan, 0}};
  EXPECT_FALSE(check_camera(model_, {.view = view}));
}

TEST_F(Cameras, ViewOfANamedCameraKeepsPlaceAndDirection) {
  Scene scene(model_, RenderQuality::low);
  ASSERT_TRUE(scene.set_camera({.name = "overview"}));
  const CameraView view = scene.view();
  ASSERT_TRUE(scene.set_camera({.view = view}));
  scene.update({});
  const mjvGLCamera gl = mjv_averageCamera(&scene.raw().camera[0], &scene.raw().camera[1]);
  // The oracle is the pose in the file: z points away from the line of sight.
  const Eigen::Vector3d x = Eigen::Vector3d(0.8, 0.6, 0).normalized();
  Eigen::Vector3d y(-0.3, 0.4, 0.8);
  y = (y - y.dot(x) * x).normalized();
  const Eigen::Vector3d forward = -x.cross(y);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(gl.pos[i], Eigen::Vector3d(1, -2, 1.5)[i], 1e-5);
    EXPECT_NEAR(gl.forward[i], forward[i], 1e-5);
  }
}

TEST_F(Cameras, SnapshotOfAnotherModelIsRefused) {
  Scene scene(model_, RenderQuality::low);
  EXPECT_TRUE(scene.set_state({}));
  const Result<void> set = scene.set_state({.time = 0, .state = {1, 2, 3}});
  ASSERT_FALSE(set);
  EXPECT_EQ(set.error().code, Errc::bad_input);
}

}  // namespace
}  // namespace mjarm::render
