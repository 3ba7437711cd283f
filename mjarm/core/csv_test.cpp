#include "mjarm/core/csv.hpp"

#include <gmock/gmock.h>

namespace mjarm {
namespace {

using ::testing::ElementsAre;

TEST(Csv, FieldsOfALine) {
  EXPECT_THAT(csv_fields("time [s], left ,right"), ElementsAre("time [s]", "left", "right"));
  EXPECT_THAT(csv_fields("\xEF\xBB\xBFtime,a"), ElementsAre("time", "a"));
  EXPECT_THAT(csv_fields(""), ElementsAre(""));
  EXPECT_THAT(csv_fields(",,"), ElementsAre("", "", ""));
  EXPECT_THAT(csv_fields("\"a,b\" ,\"say \"\"hi\"\"\",c"), ElementsAre("a,b", "say \"hi\"", "c"));
  EXPECT_THAT(csv_fields("\"no end"), ElementsAre("no end"));
}

TEST(Csv, AFieldComesBackAsItWent) {
  for (const char* words : {"plain", "with, comma", "with \"quotes\"", "关节"}) {
    EXPECT_THAT(csv_fields(csv_field(words) + "," + csv_field(words)), ElementsAre(words, words));
  }
}

}  // namespace
}  // namespace mjarm
