#include "mjarm/core/number.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "mjarm/core/rng.hpp"

namespace mjarm {
namespace {

TEST(Number, ShortestForm) {
  EXPECT_EQ(number(0.1), "0.1");
  EXPECT_EQ(number(1), "1.0");
  EXPECT_EQ(number(-2), "-2.0");
  EXPECT_EQ(number(0), "0.0");
  EXPECT_EQ(number(-0.0), "-0.0");
  EXPECT_EQ(number(1e-7), "1e-07");
  EXPECT_EQ(number(1.0 / 3), "0.3333333333333333");
  EXPECT_EQ(number(std::numeric_limits<double>::quiet_NaN()), "null");
  EXPECT_EQ(number(-std::numeric_limits<double>::infinity()), "null");
}

TEST(Number, EveryDoubleReadsBack) {
  Rng rng(1);
  for (int i = 0; i < 50000; ++i) {
    const double value = std::bit_cast<double>(rng.next());
    if (!std::isfinite(value)) continue;
    const nlohmann::json parsed = nlohmann::json::parse(number(value));
    ASSERT_TRUE(parsed.is_number_float()) << number(value);
    ASSERT_EQ(std::bit_cast<std::uint64_t>(parsed.get<double>()),
              std::bit_cast<std::uint64_t>(value));
  }
}

TEST(Number, Lists) {
  std::string out = "q=";
  append_numbers(out, std::vector<double>{1, 0.5});
  append_numbers(out, {});
  EXPECT_EQ(out, "q=[1.0,0.5][]");
}

TEST(JsonString, AnyBytesBecomeValidJson) {
  Rng rng(2);
  for (int i = 0; i < 20000; ++i) {
    std::string bytes(rng.below(12), ' ');
    for (char& c : bytes) c = static_cast<char>(rng.below(256));
    std::string out;
    append_json_string(out, bytes);
    ASSERT_TRUE(nlohmann::json::accept(out)) << i;
  }
}

TEST(JsonString, KeepsText) {
  for (const std::string text :
       {"plain", "中文，“引号”", "\"q\" \\ \n\t\x01\x1f", "\xF0\x9F\xA4\x96"}) {
    std::string out;
    append_json_string(out, text);
    EXPECT_EQ(nlohmann::json::parse(out), text);
  }
}

TEST(JsonString, NothingThatATerminalWouldObey) {
  std::string out;
  append_json_string(out,
                     "a\x1b[\x7f-\xc2\x9b"
                     "1m\xc2\xa0\xe4\xb8\xad");
  EXPECT_EQ(out, "\"a\\u001b[\\u007f-\\u009b1m\xc2\xa0\xe4\xb8\xad\"");
  EXPECT_EQ(nlohmann::json::parse(out),
            "a\x1b[\x7f-\xc2\x9b"
            "1m\xc2\xa0\xe4\xb8\xad");
}

}  // namespace
}  // namespace mjarm
