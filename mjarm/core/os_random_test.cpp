#include "mjarm/core/os_random.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace mjarm {
namespace {

TEST(SecretHex, IsNeverTheSameTwice) {
  std::set<std::string> seen;
  for (int i = 0; i < 1000; ++i) {
    const Result<std::string> drawn = secret_hex(16);
    ASSERT_TRUE(drawn) << drawn.error().what;
    EXPECT_EQ(drawn->size(), 32U);
    EXPECT_EQ(drawn->find_first_not_of("0123456789abcdef"), std::string::npos) << *drawn;
    seen.insert(*drawn);
  }
  EXPECT_EQ(seen.size(), 1000U);
}

TEST(EqualInConstantTime, IsEquality) {
  EXPECT_TRUE(equal_in_constant_time("", ""));
  EXPECT_TRUE(equal_in_constant_time("a1b2", "a1b2"));
  EXPECT_FALSE(equal_in_constant_time("a1b2", "a1b3"));
  EXPECT_FALSE(equal_in_constant_time("a1b2", "b1b2"));
  EXPECT_FALSE(equal_in_constant_time("a1b2", "a1b"));
  EXPECT_FALSE(equal_in_constant_time("a1b", ""));
}

}  // namespace
}  // namespace mjarm
