#include "mjarm/path/letters.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace mjarm {
namespace {

constexpr const char* kAll = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789";

TEST(Letters, EveryLetterFillsItsHeight) {
  for (const char* c = kAll; *c != '\0'; ++c) {
    const auto strokes = letter_strokes(std::string(1, *c), 0.2);
    ASSERT_TRUE(strokes.has_value()) << *c;
    double low = 1, high = 0, left = 1, right = 0;
    for (const Stroke& stroke : *strokes) {
      const std::vector<Eigen::Vector2d>& points = stroke.points;
      ASSERT_GE(points.size(), 2U) << *c;
      for (std::size_t i = 0; i < points.size(); ++i) {
        low = std::min(low, points[i].y());
        high = std::max(high, points[i].y());
        left = std::min(left, points[i].x());
        right = std::max(right, points[i].x());
        if (i == 0) continue;
        EXPECT_GT((points[i] - points[i - 1]).norm(), 0.02) << *c;
      }
    }
    EXPECT_NEAR(low, 0, 1e-12) << *c;
    EXPECT_NEAR(high, 0.2, 1e-12) << *c;
    EXPECT_GE(left, 0) << *c;
    EXPECT_LE(right, 0.18) << *c;
  }
}

TEST(Letters, LGoesDownThenRightAndZHasThreeStrokes) {
  const auto l = letter_strokes("L", 0.9);
  ASSERT_TRUE(l.has_value());
  ASSERT_EQ(l->size(), 1U);
  EXPECT_THAT(l->front().points, ::testing::SizeIs(3));
  EXPECT_LT(l->front().points[1].y(), l->front().points[0].y());
  EXPECT_GT(l->front().points[2].x(), l->front().points[1].x());
  const auto z = letter_strokes("z", 0.9);
  ASSERT_TRUE(z.has_value());
  EXPECT_THAT(z->front().points, ::testing::SizeIs(4));
}

TEST(Letters, StandSideBySide) {
  const auto one = letter_strokes("I", 0.1);
  const auto many = letter_strokes("LI I", 0.1);
  ASSERT_TRUE(one && many);
  ASSERT_EQ(many->size(), 3U);
  const double l_right = (*many)[0].points[2].x(), i_x = (*many)[1].points[0].x(),
               last_x = (*many)[2].points[0].x();
  EXPECT_GT(i_x, l_right + 0.01);
  EXPECT_GT(last_x, i_x + 0.04);
}

TEST(Letters, UnknownOnesAreNamed) {
  const auto what = [](const Result<std::vector<Stroke>>& r) { return r ? "" : r.error().what; };
  EXPECT_THAT(what(letter_strokes("A?", 0.1)), ::testing::HasSubstr("\"?\""));
  // A snowman: Chinese characters may be installed here.
  EXPECT_THAT(what(letter_strokes("A\xE2\x98\x83", 0.1)), ::testing::HasSubstr("\"\xE2\x98\x83\""));
  EXPECT_THAT(what(letter_strokes("  ", 0.1)), ::testing::HasSubstr("no letter"));
  EXPECT_THAT(what(letter_strokes("", 0.1)), ::testing::HasSubstr("no letter"));
  EXPECT_THAT(what(letter_strokes("A", 0)), ::testing::HasSubstr("height"));
  EXPECT_THAT(what(letter_strokes("A", std::numeric_limits<double>::quiet_NaN())),
              ::testing::HasSubstr("height"));
}

}  // namespace
}  // namespace mjarm
