#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numbers>
#include <string>

#include "mjarm/core/rotation.hpp"
#include "mjarm/perception/hand_eye.hpp"
#include "mjarm/perception/look_test.hpp"
#include "tests/support/rounds.hpp"

namespace mjarm::perception {
namespace {

constexpr double kTagOfBoard = 0.05;  // [m]

/// Six tags in two rows of three, as a model with a camera that can be put anywhere.
std::string board_model(std::vector<BoardTag>& board) {
  std::string assets, geoms;
  for (int i = 0; i < 6; ++i) {
    const std::string id = std::to_string(i);
    const double x = 0.07 * (i % 3), y = 0.07 * (i / 3);
    board.push_back({.id = i, .size = kTagOfBoard, .X_BT = {.p = {x, y, 0}}});
    assets += "<texture name=\"t" + id + "\" type=\"2d\" file=\"t" + id +
              ".png\"/><material name=\"t" + id + "\" texture=\"t" + id +
              "\" texuniform=\"false\"/>";
    geoms += "<geom type=\"box\" size=\"0.03125 0.03125 0.0005\" material=\"t" + id + "\" pos=\"" +
             std::to_string(x) + " " + std::to_string(y) + " -0.0005\"/>";
  }
  return "<mujoco><visual><headlight ambient=\"0.8 0.8 0.8\" diffuse=\"0.2 0.2 0.2\"/></visual>"
         "<statistic extent=\"1\"/><asset>" +
         assets +
         "</asset><worldbody>"
         "<geom type=\"box\" size=\"0.2 0.2 0.01\" pos=\"0.07 0.035 -0.0115\" rgba=\"0.7 0.7 0.7 "
         "1\"/>" +
         geoms +
         "<body name=\"eye\"><freejoint/><inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"1 1 1\"/>"
         "<camera name=\"eye\" fovy=\"42\"/></body></worldbody></mujoco>";
}

// Rendered pictures, tags found in them, and the pose comes out of the whole chain.
TEST(HandEyeLook, RenderedViewsTellTheCameraWithinAMillimetre) {
  Result<TagDetector> detector = TagDetector::create();
  if (!detector) GTEST_SKIP() << detector.error().what;
  support::TempFolder folder;
  for (int i = 0; i < 6; ++i) {
    const std::string name = "t" + std::to_string(i) + ".png";
    ASSERT_TRUE(render::write_png(*tag_picture(i, 20), folder.path() / name));
  }
  std::vector<BoardTag> board;
  const Model model = *Model::load(folder.write("board.xml", board_model(board)));
  Result<render::RgbdCamera> camera = render::RgbdCamera::create(model, "eye");
  if (!camera) GTEST_SKIP() << camera.error().what;
  Sim sim(model);
  Rng rng(7);
  const Pose X_TC{.p = {0.03, -0.06, 0.05}, .R = from_euler({0.1, -0.2, 1.5})};
  const Pose flip{.R = Eigen::Vector3d(1, -1, -1).asDiagonal()};
  std::vector<HandEyeView> views;
  render::CameraIntrinsics lens;
  for (int i = 0; i < mjarm::testing::rounds(5, 20); ++i) {
    const Pose X_WC =
        testing::eye_at({0.07 + rng.uniform(-0.03, 0.03), 0.035, 0}, rng.uniform(0.4, 0.6),
                        rng.uniform(-3, 3), rng.uniform(0.7, 1.4));
    sim.place_free("eye", X_WC * flip);
    const render::RgbdFrame frame = *camera->look(sim.snapshot(), rng);
    lens = frame.intrinsics;
    views.push_back({.X_WT = X_WC * X_TC.inverse(),
                     .corners = board_corners(board, detector->find(frame.color))});
    EXPECT_EQ(views.back().corners.size(), 24U);
  }
  const auto found = calibrate_hand_eye(views, CameraMount::wrist, lens);
  ASSERT_TRUE(found) << describe(found.error());
  const double metres = (found->X_PC.p - X_TC.p).norm();
  const double turn = angle_between(found->X_PC.R, X_TC.R) * 180 / std::numbers::pi;
  RecordProperty("mm", std::to_string(1000 * metres));
  RecordProperty("deg", std::to_string(turn));
  RecordProperty("px", std::to_string(found->residual));
  EXPECT_LT(metres, 0.001);
  EXPECT_LT(turn, 0.1);
  EXPECT_LT(found->residual, 0.5);
  EXPECT_LT(found->X_QB.p.norm(), 0.001) << "the board stands at the origin";
}

}  // namespace
}  // namespace mjarm::perception
