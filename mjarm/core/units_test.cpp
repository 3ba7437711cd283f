#include "mjarm/core/units.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <string>

namespace mjarm {
namespace {

TEST(Units, ReadsNumbersWithAndWithoutUnits) {
  EXPECT_EQ(parse_quantity("0.3", Quantity::length).value(), 0.3);
  EXPECT_EQ(parse_quantity("25mm", Quantity::length).value(), 0.025);
  EXPECT_EQ(parse_quantity("10cm", Quantity::length).value(), 0.1);
  EXPECT_EQ(parse_quantity("-3 m", Quantity::length).value(), -3);
  EXPECT_EQ(parse_quantity("1e3um", Quantity::length).value(), 1e-3);
  EXPECT_EQ(parse_quantity("+0.5", Quantity::number).value(), 0.5);
  EXPECT_EQ(parse_quantity("  7\t", Quantity::number).value(), 7);
  EXPECT_DOUBLE_EQ(parse_quantity("90deg", Quantity::angle).value(), std::numbers::pi / 2);
  EXPECT_EQ(parse_quantity("1.57rad", Quantity::angle).value(), 1.57);
  EXPECT_EQ(parse_quantity("20 ms", Quantity::time).value(), 0.02);
  EXPECT_EQ(parse_quantity("2min", Quantity::time).value(), 120);
  EXPECT_EQ(parse_quantity("250mm/s", Quantity::speed).value(), 0.25);
}

TEST(Units, RefusesWhatIsNoNumber) {
  for (const char* words : {"", " ", "abc", "deg", "--3", "+-3", "+", "-", ".", "e5", ",", "0x"}) {
    const auto value = parse_quantity(words, Quantity::angle);
    ASSERT_FALSE(value) << words;
    EXPECT_EQ(value.error().code, Errc::bad_input);
    EXPECT_NE(value.error().what.find(words), std::string::npos);
  }
}

TEST(Units, RefusesWhatIsNotFinite) {
  for (const char* words : {"nan", "inf", "-inf", "infinity", "1e999", "-1e999deg"}) {
    EXPECT_FALSE(parse_quantity(words, Quantity::angle)) << words;
  }
}

TEST(Units, RefusesUnitsOfOtherQuantities) {
  const auto metres = parse_quantity("3mm", Quantity::angle);
  ASSERT_FALSE(metres);
  EXPECT_EQ(metres.error().what, "unknown unit \"mm\" in \"3mm\" (known here: rad, mrad, deg)");
  EXPECT_FALSE(parse_quantity("3deg", Quantity::length));
  EXPECT_FALSE(parse_quantity("3 m m", Quantity::length));
  EXPECT_FALSE(parse_quantity("3m", Quantity::number));
  EXPECT_FALSE(parse_quantity("1,5m", Quantity::length));
}

TEST(Units, ValuesThatLackTheirUnitAreRefusedWithIt) {
  EXPECT_EQ(parse_quantity("180", Quantity::angle).error().what,
            "180 without a unit would be 180 rad, more than a whole turn: write 180deg, or 180rad "
            "where radians are meant");
  EXPECT_EQ(parse_quantity("-600", Quantity::length).error().what,
            "-600 without a unit would be -600 m: write -600mm, or -600m where metres are meant");
  // A rounded turn is none too many, and who writes the unit means it.
  for (const char* words : {"6.28319", "-6.29", "180deg", "180rad"}) {
    EXPECT_TRUE(parse_quantity(words, Quantity::angle)) << words;
  }
  for (const char* words : {"10", "-10", "10.1m", "600m"}) {
    EXPECT_TRUE(parse_quantity(words, Quantity::length)) << words;
  }
  for (const char* words : {"6.3", "90"}) {
    EXPECT_FALSE(parse_quantity(words, Quantity::angle)) << words;
    EXPECT_FALSE(parse_quantity(words + std::string(", 0"), Quantity::length) &&
                 parse_quantities(words + std::string(", 0"), Quantity::angle));
  }
  EXPECT_FALSE(parse_quantity("10.1", Quantity::length));
  EXPECT_TRUE(parse_quantity("600", Quantity::time));
  EXPECT_TRUE(parse_quantity("600", Quantity::number));
}

TEST(Units, LongInputIsShownShort) {
  const auto value = parse_quantity(std::string(100000, 'x'), Quantity::angle);
  ASSERT_FALSE(value);
  EXPECT_LT(value.error().what.size(), 100u);
}

TEST(Units, ReadsLists) {
  using Values = std::vector<double>;
  EXPECT_EQ(parse_quantities("1,2,3", Quantity::number).value(), Values({1, 2, 3}));
  EXPECT_EQ(parse_quantities(" 1 , 2 cm,-3 ", Quantity::length).value(), Values({1, 0.02, -3}));
  EXPECT_EQ(parse_quantities("1  2\t3", Quantity::number).value(), Values({1, 2, 3}));
  EXPECT_EQ(parse_quantities("4", Quantity::number).value(), Values({4}));
  for (const char* words : {"", "1,,2", ",1", "1,", "1;2", "1,2 3"}) {
    EXPECT_FALSE(parse_quantities(words, Quantity::number)) << words;
  }
}

}  // namespace
}  // namespace mjarm
