#include "mjarm/core/base64.hpp"

#include <gtest/gtest.h>

#include "mjarm/core/sha256.hpp"

namespace mjarm {
namespace {

/// The vectors of RFC 4648, section 10, and all bytes.
TEST(Base64, IsThatOfTheStandard) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64(std::string("\xFB\xEF\xFF\0", 4)), "++//AA==");
}

/// FIPS 180-2, appendix B.1; a policy of a page names the same hash so.
TEST(Sha256, BytesAreThoseOfTheDigits) {
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(base64(sha256_bytes("abc")), "ungWv48Bz+pBQUDeXa4iI7ADYaOWF3qctBD/YfIAFa0=");
}

}  // namespace
}  // namespace mjarm
