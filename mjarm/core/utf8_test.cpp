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

TEST(Utf8, WhatATerminalWouldObeyIsShownInstead) {
  EXPECT_EQ(printable("a\x1b[31m-\a\x7f"), "a\\x1b[31m-\\x07\\x7f");
  EXPECT_EQ(printable("\xff caf\xc3\xa9 \xe4\xb8\xad\xc3"), "\\xff caf\xc3\xa9 \xe4\xb8\xad\\xc3");
  EXPECT_EQ(printable("one\ntwo\tthree"), "one two three");
  EXPECT_EQ(printable("\xc2\x9b"), "\\x9b");  // what some terminals take for ESC [
}

}  // namespace
}  // namespace mjarm
