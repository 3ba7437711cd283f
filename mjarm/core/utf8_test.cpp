#include "mjarm/core/utf8.hpp"

#include <gtest/gtest.h>

namespace mjarm {
namespace {

TEST(Utf8, LengthOfTheFirstCharacter) {
  EXPECT_EQ(utf8_length("a"), 1U);
  EXPECT_EQ(utf8_length("\xC3\xA9x"), 2U);
  EXPECT_EQ(utf8_length("\xE8\x87\x82"), 3U);
  EXPECT_EQ(utf8_length("\xF0\x9F\xA4\x96"), 4U);
}

TEST(Utf8, WhatIsMalformed) {
  EXPECT_TRUE(is_utf8(""));
  EXPECT_TRUE(is_utf8("arm \xE8\x87\x82 \xF0\x9F\xA4\x96"));
  for (const char* bad : {"\x80", "\xC3", "\xC0\x80", "\xE0\x80\x80", "\xED\xA0\x80",
                          "\xF0\x80\x80\x80", "\xF4\x90\x80\x80", "\xF5", "\xFF", "a\xE8\x87"}) {
    EXPECT_FALSE(is_utf8(bad)) << bad;
  }
}

}  // namespace
}  // namespace mjarm
