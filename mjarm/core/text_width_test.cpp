#include "mjarm/core/text_width.hpp"

#include <gtest/gtest.h>

namespace mjarm {
namespace {

TEST(TextWidth, ChineseCountsTwo) {
  EXPECT_EQ(text_width(""), 0);
  EXPECT_EQ(text_width("joint"), 5);
  EXPECT_EQ(text_width("关节：6"), 7);
  EXPECT_EQ(text_width("Zürich"), 6);
}

TEST(TextWidth, PadsToColumns) {
  EXPECT_EQ(padded("ab", 4), "ab  ");
  EXPECT_EQ(padded("关节", 6), "关节  ");
  EXPECT_EQ(padded("abcdef", 4), "abcdef");
}

}  // namespace
}  // namespace mjarm
