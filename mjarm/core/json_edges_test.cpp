// JSON at the borders of what it can say: the largest whole numbers, escapes, what stands behind
// the end, and values that come back from the writers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "mjarm/core/json.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/number.hpp"
#include "mjarm/core/rng.hpp"

namespace mjarm {
namespace {

using ::testing::HasSubstr;
using Kind = JsonValue::Kind;

JsonObject object_of(const std::string& text) {
  auto read = JsonObject::parse(text);
  EXPECT_TRUE(read) << text << ": " << (read ? "" : describe(read.error()));
  return read ? std::move(*read) : JsonObject();
}

TEST(JsonEdges, WholeNumbersEndWhereSixtyFourBitsDo) {
  struct Case {
    const char* written;
    Kind kind;
    double number;
  };
  for (const Case& c :
       {Case{"0", Kind::whole, 0}, Case{"18446744073709551615", Kind::whole, 0x1p64},
        Case{"18446744073709551616", Kind::real, 0x1p64},
        Case{"-9223372036854775808", Kind::negative, -0x1p63},
        Case{"-9223372036854775809", Kind::real, -0x1p63}, Case{"1.0", Kind::real, 1},
        Case{"1e2", Kind::real, 100}, Case{"-0.0", Kind::real, 0},
        Case{"1.7976931348623157e308", Kind::real, 1.7976931348623157e308},
        Case{"5e-324", Kind::real, 5e-324}, Case{"1e-400", Kind::real, 0}}) {
    const JsonObject object = object_of(std::string("{\"x\":") + c.written + "}");
    const JsonValue* x = object->find("x");
    ASSERT_NE(x, nullptr) << c.written;
    EXPECT_EQ(x->kind(), c.kind) << c.written;
    EXPECT_EQ(x->number(), c.number) << c.written;
    EXPECT_EQ(x->is_whole(), c.kind == Kind::whole) << c.written;
    if (c.kind != Kind::whole) {
      EXPECT_EQ(x->whole(), 0U) << c.written;
    }
    if (c.kind != Kind::negative) {
      EXPECT_EQ(x->negative(), 0) << c.written;
    }
  }
  const JsonObject ends =
      object_of(R"({"most":18446744073709551615,"least":-9223372036854775808})");
  EXPECT_EQ(ends->find("most")->whole(), std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(ends->find("least")->negative(), std::numeric_limits<std::int64_t>::min());
}

TEST(JsonEdges, EscapesAreTheCharactersTheyStandFor) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {R"(\u0041)", "A"},
      {R"(\u00e9)", "\xC3\xA9"},
      {R"(\u81C2)", "\xE8\x87\x82"},
      {R"(\ud83e\udd16)", "\xF0\x9F\xA4\x96"},
      {R"(\/\"\\\b\f\n\r\t)", "/\"\\\b\f\n\r\t"},
      {R"(a\u0000b)", std::string("a\0b", 3)}};
  for (const auto& [written, meant] : cases) {
    // As a value and as a key.
    const JsonObject object = object_of("{\"v\":\"" + written + "\",\"k" + written + "\":1}");
    EXPECT_EQ(object->find("v")->string(), meant) << written;
    EXPECT_TRUE(object->contains("k" + meant)) << written;
  }
  for (const char* bad : {R"(\ud83e)", R"(\udd16)", R"(\ud83e\u0041)", R"(\u12g4)", R"(\x41)", "\n",
                          "\x1f", "\xC0\x80", "\xED\xA0\x80"}) {
    const auto read = JsonObject::parse("{\"v\":\"" + std::string(bad) + "\"}");
    ASSERT_FALSE(read) << bad;
    EXPECT_EQ(read.error().code, JsonErrc::syntax) << bad;
    EXPECT_GT(read.error().byte, 5U) << bad;
  }
}

TEST(JsonEdges, OnlyBlanksMayStandAroundTheObject) {
  EXPECT_TRUE(JsonObject::parse(" \t\r\n{}\r\n "));
  EXPECT_TRUE(JsonObject::parse("\xEF\xBB\xBF{}"));  // as editors of Windows write it
  for (const std::string text : {"{} {}", "{},", "{}x", "{}\v", "\xEF\xBB{}", "// note\n{}",
                                 "{\"a\":1,}", "{'a':1}", "{\"a\":+1}", "{\"a\":01}", "{\"a\":.5}",
                                 "{\"a\":1.}", "{\"a\":NaN}", "{\"a\":Infinity}"}) {
    const auto read = JsonObject::parse(text);
    ASSERT_FALSE(read) << text;
    EXPECT_EQ(read.error().code, JsonErrc::syntax) << text;
  }
}

TEST(JsonEdges, AManyTimesRepeatedKeyCountsOnceAndMembersAreFoundByBisection) {
  std::string text = "{";
  for (int i = 0; i < 500; ++i) {
    text += (i == 0 ? "\"" : ",\"") + std::to_string(i % 100) + "\":" + std::to_string(i);
  }
  EXPECT_FALSE(JsonObject::parse(text + "}"));  // unless it is said that keys may be repeated
  const JsonObject object = JsonObject::parse(text + "}", {.unique_keys = false}).value();
  ASSERT_EQ(object->size(), 100U);
  for (int i = 0; i < 100; ++i) {
    const JsonValue* member = object->find(std::to_string(i));
    ASSERT_NE(member, nullptr) << i;
    EXPECT_EQ(member->number(), 400 + i);
  }
  for (const char* absent : {"", "100", "-1", "00", "a"}) EXPECT_EQ(object->find(absent), nullptr);
}

TEST(JsonEdges, EachFailureIsASentenceInBothLanguages) {
  for (const JsonErrc code :
       {JsonErrc::syntax, JsonErrc::number_range, JsonErrc::no_object, JsonErrc::too_deep,
        JsonErrc::too_many, JsonErrc::too_long, JsonErrc::key_twice}) {
    const JsonFailure failure{code, 7, "钥匙"};
    const std::string english = describe(failure);
    const LanguageScope scope(Language::chinese);
    const std::string chinese = describe(failure);
    EXPECT_FALSE(english.empty());
    EXPECT_NE(english, chinese);
    EXPECT_EQ(english.find('\n'), std::string::npos);
    if (code == JsonErrc::syntax) {
      EXPECT_THAT(chinese, HasSubstr("7"));
    }
    if (code == JsonErrc::key_twice) {
      EXPECT_THAT(english, HasSubstr("钥匙"));
    }
  }
  EXPECT_EQ(parse_json_object("{\"a\" 1}").error().what, "not valid JSON at column 6");
  EXPECT_EQ(parse_json_object("{\"a\":1e400}").error().what,
            "a number is beyond the range of double");
}

TEST(JsonEdges, APoseSaysWhichOfItsPartsIsWrong) {
  const std::vector<std::pair<const char*, const char*>> cases = {
      {R"({})", "\"pos\" is missing"},
      {R"({"pose":[0,0,0],"quat":[1,0,0,0]})", "\"pos\" is missing (there is \"pose\" instead)"},
      {R"({"pos":[0,0],"quat":[1,0,0,0]})", "\"pos\" must have 3 numbers, it has 2"},
      {R"({"pos":{"x":0},"quat":[1,0,0,0]})", "\"pos\" must be a list of 3 numbers"},
      {R"({"pos":[0,0,false],"quat":[1,0,0,0]})", "entry 2 of \"pos\" is not a number"},
      {R"({"pos":[0,0,0]})", "\"quat\" is missing"},
      {R"({"pos":[0,0,0],"quat":[1,0,0]})", "\"quat\" must have 4 numbers, it has 3"},
      {R"({"pos":[0,0,0],"quat":[0,0,0,0]})", "the quaternion must have length 1, it has 0"},
      {R"({"pos":[0,0,0],"quat":[1e300,1e300,0,0]})",
       "the quaternion must have length 1, it has 1.41421e+300"}};
  for (const auto& [written, what] : cases) {
    const Result<Pose> pose = pose_of(*object_of(written));
    ASSERT_FALSE(pose) << written;
    EXPECT_EQ(pose.error().code, Errc::bad_input);
    EXPECT_EQ(pose.error().what, what);
  }
  const Result<std::vector<double>> named =
      numbers_of(*object_of(R"({"q":[1]})")->find("q"), "第 3 行", 2);
  ASSERT_FALSE(named);
  EXPECT_EQ(named.error().what, "\"第 3 行\" must have 2 numbers, it has 1");
}

TEST(JsonEdges, BothWritersSayTheSame) {
  Rng rng(11);
  const std::vector<std::string> words = {"", "a b", "“引号”\n", "\x01\x7f", "\xF0\x9F\xA4\x96"};
  for (int i = 0; i < 200; ++i) {
    std::vector<double> numbers(rng.below(5));
    for (double& x : numbers) x = std::ldexp(rng.uniform(-1, 1), static_cast<int>(rng.below(60)));
    const double x = std::ldexp(rng.uniform(-1, 1), static_cast<int>(rng.below(2000)) - 1000);
    const std::string& word = words[rng.below(words.size())];
    const bool flag = rng.below(2) == 0;
    std::string out;
    JsonWriter(out)
        .object()
        .member("n", numbers)
        .member("x", x)
        .member("w", word)
        .member("f", flag)
        .end_object();
    const JsonDoc doc{{"n", numbers}, {"x", x}, {"w", word}, {"f", flag}};
    // They may choose other digits or escapes, but not another value.
    for (const std::string& text : {out, doc.line(), doc.document()}) {
      const JsonObject object = object_of(text);
      EXPECT_EQ(object->find("x")->number(), x) << text;
      EXPECT_EQ(object->find("w")->string(), word) << text;
      EXPECT_EQ(object->find("f")->boolean(), flag) << text;
      EXPECT_EQ(number_list(*object, "n", numbers.size()).value(), numbers) << text;
    }
    EXPECT_EQ(out.find('\n'), std::string::npos);
    EXPECT_EQ(doc.line().find('\n'), std::string::npos);
  }
}

TEST(JsonEdges, DocumentsAreGrownFromNothingAndCopiesGoTheirOwnWay) {
  JsonDoc doc;
  EXPECT_EQ(doc.line(), "null");
  doc.set_all(JsonDoc());
  EXPECT_EQ(doc.line(), "null");
  doc.set("a", 1);
  JsonDoc copy = doc;
  copy.set("a", 2);
  copy.set("b", std::vector<JsonDoc>{});
  EXPECT_EQ(doc.line(), R"({"a":1})");
  EXPECT_EQ(copy.line(), R"({"a":2,"b":[]})");
  doc.set_all(copy);
  EXPECT_EQ(doc.line(), copy.line());
  doc = JsonDoc{{"inner", std::move(copy)}};
  EXPECT_EQ(doc.line(), R"({"inner":{"a":2,"b":[]}})");
  EXPECT_EQ(JsonDoc(std::size_t{18446744073709551615ULL}).line(), "18446744073709551615");
  constexpr long kLeast = std::numeric_limits<long>::min();
  EXPECT_EQ(JsonDoc(kLeast).line(), std::to_string(kLeast));
}

TEST(JsonNul, IsNoEndOfTheText) {
  for (const std::string& text :
       {std::string("{}\0", 3), std::string("{\"a\":1}\0,\"b\":2}", 15)}) {
    const auto read = JsonObject::parse(text);
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().code, JsonErrc::syntax);
  }
}

}  // namespace
}  // namespace mjarm
