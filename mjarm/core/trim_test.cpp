#include "mjarm/core/trim.hpp"

#include <gtest/gtest.h>

namespace mjarm {
namespace {

TEST(Trimmed, LosesBlanksAtItsEndsAlone) {
  EXPECT_EQ(trimmed(" \ta b\r\n"), "a b");
  EXPECT_EQ(trimmed("a"), "a");
  EXPECT_EQ(trimmed(" \n "), "");
  EXPECT_EQ(trimmed(""), "");
  EXPECT_EQ(trimmed(" \ta\t ", " "), "\ta\t");
}

}  // namespace
}  // namespace mjarm
