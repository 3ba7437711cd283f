#include "mjarm/perception/hand_eye.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/perception/tag_pose.hpp"
#include "tests/support/rounds.hpp"

namespace mjarm::perception {
namespace {

using mjarm::testing::rounds;

constexpr double kOneDegree = std::numbers::pi / 180;
const render::CameraIntrinsics kLens{
    .width = 1280, .height = 720, .fx = 938, .fy = 938, .cx = 639.5, .cy = 359.5};

/// Six tags of 50 mm in two rows of three.
std::vector<BoardTag> board() {
  std::vector<BoardTag> out;
  for (int i = 0; i < 6; ++i) {
    out.push_back({.id = i, .size = 0.05, .X_BT = {.p = {0.07 * (i % 3), 0.07 * (i / 3), 0}}});
  }
  return out;
}

Pose near(Rng& rng, const Pose& X, double metres, double radians) {
  const auto three = [&](double most) {
    return Eigen::Vector3d(rng.uniform(-most, most), rng.uniform(-most, most),
                           rng.uniform(-most, most));
  };
  return {.p = X.p + three(metres), .R = X.R * rotation_exp(three(radians))};
}

/// A rig: the camera on its carrier P, the board on the other one, Q; views have the board at 0.5
/// m.
struct Rig {
  CameraMount mount;
  Pose X_PC, X_QB;
  HandEyeView view(Rng& rng, double sigma, double turn) const {
    const Pose facing{.p = {-0.07, 0.035, 0.5}, .R = from_euler({std::numbers::pi, 0, 0})};
    return view_of(near(rng, facing, 0.05, turn), rng, sigma);
  }
  HandEyeView view_of(const Pose& X_CB, Rng& rng, double sigma) const {
    const Pose X_PQ = X_PC * X_CB * X_QB.inverse();
    HandEyeView out{.X_WT = mount == CameraMount::wrist ? X_PQ.inverse() : X_PQ};
    for (const BoardTag& tag : board()) {
      for (const Eigen::Vector3d& p_T : tag_corners(tag.size)) {
        const Eigen::Vector3d p_B = tag.X_BT * p_T;
        const Eigen::Vector2d off(sigma * rng.normal(), sigma * rng.normal());
        out.corners.push_back({p_B, kLens.project(X_CB * p_B) + off});
      }
    }
    return out;
  }
};

Rig random_rig(Rng& rng, CameraMount mount) {
  const Pose anywhere{.p = {0.3, 0.1, 0.4}, .R = from_euler({1, 2, 3})};
  return {mount, near(rng, anywhere, 0.3, 2), near(rng, anywhere, 0.3, 2)};
}

class HandEyeOf : public ::testing::TestWithParam<CameraMount> {};

TEST_P(HandEyeOf, TwentyViewsTellTheCameraWithinATenthOfADegree) {
  Rng rng(1);
  for (int i = 0; i < rounds(4, 200); ++i) {
    const Rig rig = random_rig(rng, GetParam());
    std::vector<HandEyeView> views;
    for (int k = 0; k < 20; ++k) views.push_back(rig.view(rng, 0.2, 0.5));
    const auto found = calibrate_hand_eye(views, GetParam(), kLens);
    ASSERT_TRUE(found) << describe(found.error());
    EXPECT_EQ(found->views, 20);
    EXPECT_LT((found->X_PC.p - rig.X_PC.p).norm(), 0.001);
    EXPECT_LT(angle_between(found->X_PC.R, rig.X_PC.R), 0.1 * kOneDegree);
    EXPECT_LT((found->X_QB.p - rig.X_QB.p).norm(), 0.001);
    EXPECT_NEAR(found->residual, 0.28, 0.03);  // 0.2 px each way
  }
}

TEST_P(HandEyeOf, ExactViewsGiveTheExactPose) {
  Rng rng(2);
  const Rig rig = random_rig(rng, GetParam());
  std::vector<HandEyeView> views;
  for (int k = 0; k < 3; ++k) views.push_back(rig.view(rng, 0, 0.5));
  views.push_back({.X_WT = {}, .corners = {}});  // does not see the board
  const auto found = calibrate_hand_eye(views, GetParam(), kLens);
  ASSERT_TRUE(found) << describe(found.error());
  EXPECT_EQ(found->views, 3);
  EXPECT_LT((found->X_PC.p - rig.X_PC.p).norm(), 1e-7);
  EXPECT_LT(angle_between(found->X_PC.R, rig.X_PC.R), 1e-7);
}
INSTANTIATE_TEST_SUITE_P(Mounts, HandEyeOf,
                         ::testing::Values(CameraMount::wrist, CameraMount::fixed));

HandEyeErrc reason(const std::vector<HandEyeView>& views) {
  const auto found = calibrate_hand_eye(views, CameraMount::wrist, kLens);
  EXPECT_FALSE(found);
  return found ? HandEyeErrc{-1} : found.error();
}

TEST(HandEye, ViewsThatCannotTellItSayWhy) {
  Rng rng(3);
  const Rig rig = random_rig(rng, CameraMount::wrist);
  std::vector<HandEyeView> views{rig.view(rng, 0.2, 0.5), rig.view(rng, 0.2, 0.5)};
  EXPECT_EQ(reason(views), HandEyeErrc::too_few_views);
  views.push_back({});
  EXPECT_EQ(reason(views), HandEyeErrc::board_not_seen);
  // Turns about the line of sight alone, and none at all.
  for (const double turn : {0.3, 0.0}) {
    std::vector<HandEyeView> twisted;
    for (int k = 0; k < 10; ++k) {
      const Pose X_CB{
          .p = {-0.07 + 0.01 * k, 0.03, 0.5},
          .R = from_euler({0, 0, turn * k}) * from_euler({std::numbers::pi - 0.3, 0, 0})};
      twisted.push_back(rig.view_of(X_CB, rng, 0.2));
    }
    EXPECT_EQ(reason(twisted), HandEyeErrc::one_axis) << turn;
  }
  // One pose of the tool is that of another moment.
  std::vector<HandEyeView> wrong;
  for (int k = 0; k < 10; ++k) wrong.push_back(rig.view(rng, 0.2, 0.5));
  wrong[4].X_WT = wrong[7].X_WT;
  EXPECT_EQ(reason(wrong), HandEyeErrc::contradiction);
}

}  // namespace
}  // namespace mjarm::perception
