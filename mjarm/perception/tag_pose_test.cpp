#include "mjarm/perception/tag_pose.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "mjarm/perception/look_test.hpp"
#include "mjarm/perception/tag_board.hpp"
#include "tests/support/rounds.hpp"

namespace mjarm::perception {
namespace {

using namespace mjarm::perception::testing;

/// A tag's picture at (x, y) of a gray one.
render::Image pasted(const render::Image& tag, int width, int height, int x, int y) {
  render::Image out{width, height, std::vector<std::uint8_t>(3UL * width * height, 200)};
  for (int row = 0; row < tag.height; ++row) {
    std::copy_n(tag.rgb.begin() + 3 * row * tag.width, 3 * tag.width,
                out.rgb.begin() + 3 * ((row + y) * width + x));
  }
  return out;
}

TEST(TagDetector, FindsEachTagInItsPictureWithItsCorners) {
  Result<TagDetector> detector = TagDetector::create();
  if (!detector) GTEST_SKIP() << detector.error().what;
  for (const int id : {0, 1, 77, 586}) {
    const std::vector<SeenTag> seen =
        detector->find(pasted(*tag_picture(id, 9), 320, 240, 100, 60));
    ASSERT_EQ(seen.size(), 1U) << id;
    EXPECT_EQ(seen[0].id, id);
    // The black square is 72 pixels wide, from column 109 on: its edge is between two pixels.
    const double left = 108.5, right = 180.5, top = 68.5, bottom = 140.5;
    const std::array<Eigen::Vector2d, 4> expected{
        Eigen::Vector2d(left, bottom), {right, bottom}, {right, top}, {left, top}};
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_LT((seen[0].corners[i] - expected[i]).norm(), 0.3) << id << ", corner " << i;
    }
  }
  EXPECT_TRUE(detector->find(pasted(*tag_picture(3, 9), 320, 240, 0, 228 - 90)).size() == 1);
  EXPECT_TRUE(detector->find({320, 240, std::vector<std::uint8_t>(3UL * 320 * 240, 90)}).empty());
}

TEST(TagDetector, NumbersThatNoTagHasAreRefused) {
  for (const auto& [id, pixels] : {std::pair{-1, 10}, {587, 10}, {0, 0}, {0, 101}}) {
    EXPECT_FALSE(tag_picture(id, pixels));
  }
  if (has_tags()) {
    EXPECT_EQ(tag_picture(0, 10).value().width, 100);
  } else {
    EXPECT_NE(TagDetector::create().error().what.find("libapriltag-dev"), std::string::npos);
  }
}

std::string content_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

TEST(TagDetector, ThePicturesOfTheModelsAreThese) {
  if (!has_tags()) GTEST_SKIP() << "built without AprilTag (libapriltag-dev)";
  const std::filesystem::path folder = find_model_file("hello")->parent_path() / "tags";
  for (int id = 0; id < 12; ++id) {
    const std::string name = "tag36h11_" + std::to_string(id) + ".png";
    EXPECT_EQ(content_of(folder / name), *render::encode_png(*tag_picture(id, 20))) << name;
  }
}

// Depth is what makes it right: corners alone leave the tilt of a small tag open by degrees.
TEST(TagPose, DepthTellsTheTiltThatCornersLeaveOpen) {
  Look look;
  if (!look.works() || !has_tags()) GTEST_SKIP() << "no OpenGL, or built without AprilTag";
  TagDetector detector = std::move(*TagDetector::create());
  Rng rng(5), noise(6);
  double worst = 0, worst_alone = 0;
  for (int i = 0; i < mjarm::testing::rounds(4, 100); ++i) {
    Places places{.eye = eye_at({0, 0, 0.06}, 0.8, rng.uniform(-3, 3), rng.uniform(1.2, 1.5))};
    places.bodies[0] = standing(0, 0, 0.03, rng.uniform(-3, 3));
    const render::RgbdFrame frame = look(places, noise);
    const std::vector<SeenTag> seen = detector.find(frame.color);
    ASSERT_EQ(seen.size(), 1U);
    const Pose X_CT = places.eye.inverse() * *places.bodies[0] * kTagOnBox;
    const Result<TagPose, FindErrc> pose = tag_pose(seen[0], kTagSize, frame);
    ASSERT_TRUE(pose) << describe(pose.error());
    EXPECT_LT((pose->X_CT.p - X_CT.p).norm(), 0.001);
    worst = std::max(worst, angle_between(pose->X_CT.R, X_CT.R));
    const std::vector<BoardTag> board{{.id = kTag, .size = kTagSize}};
    const auto alone = board_pose(board_corners(board, seen), frame.intrinsics);
    // Both tilts explain it, or one of them, often less well than depth does.
    worst_alone = std::max(worst_alone, alone ? angle_between(alone->X_CB.R, X_CT.R) : 1);
  }
  constexpr double kDegreeOfTag = std::numbers::pi / 180;
  EXPECT_LT(worst, kDegreeOfTag);
  EXPECT_GT(worst_alone, kDegreeOfTag);
}

}  // namespace
}  // namespace mjarm::perception
