#include "mjarm/core/stored_zip.hpp"

#include <gmock/gmock.h>

namespace mjarm {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string two_entries() {
  StoredZipWriter zip;
  zip.add("b.txt", "123456789");
  zip.add("a/empty", "");
  return std::move(zip).finish();
}

TEST(StoredZip, ReadsWhatItWrites) {
  const std::string bytes = two_entries();
  const auto zip = StoredZip::open(bytes, "x.zip");
  ASSERT_TRUE(zip) << zip.error().what;
  EXPECT_THAT(zip->names(), ElementsAre("a/empty", "b.txt"));
  EXPECT_EQ(zip->read_checked("b.txt").value(), "123456789");
  EXPECT_EQ(zip->read_checked("a/empty").value(), "");
}

TEST(StoredZip, WritesTheFieldsOfTheFormat) {
  const std::string bytes = two_entries();
  // CRC-32 of "123456789" is 0xCBF43926 (its check value), little-endian at byte 14.
  EXPECT_EQ(bytes.substr(0, 4), "PK\3\4");
  EXPECT_EQ(bytes.substr(14, 4), "\x26\x39\xF4\xCB");
  EXPECT_EQ(bytes.substr(12, 2), std::string("\x21\x00", 2)) << "1 January 1980";
  EXPECT_EQ(bytes.size(), 2 * (30 + 46) + 2 * (5 + 7) + 9 + 22u);
  EXPECT_EQ(bytes, two_entries());
}

TEST(StoredZip, NoticesAChangedByteAndACutFile) {
  std::string bytes = two_entries();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(StoredZip::open(std::string_view(bytes).substr(0, size), "x.zip")) << size;
  }
  bytes[30 + 5] ^= 1;
  const auto zip = StoredZip::open(bytes, "x.zip");
  ASSERT_TRUE(zip);
  const auto content = zip->read_checked("b.txt");
  ASSERT_FALSE(content);
  EXPECT_THAT(content.error().what, HasSubstr("x.zip: \"b.txt\" is damaged"));
}

}  // namespace
}  // namespace mjarm
