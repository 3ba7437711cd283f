#include "mjarm/core/json.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"

namespace mjarm {
namespace {

using Oracle = nlohmann::json;

/// What a value is by another library.
Oracle oracle_of(const JsonValue& value) {
  switch (value.kind()) {
    case JsonValue::Kind::null:
      return nullptr;
    case JsonValue::Kind::boolean:
      return value.boolean();
    case JsonValue::Kind::whole:
      return value.whole();
    case JsonValue::Kind::negative:
      return value.negative();
    case JsonValue::Kind::real:
      return value.number();
    case JsonValue::Kind::string:
      return value.string();
    case JsonValue::Kind::list: {
      Oracle list = Oracle::array();
      for (const JsonValue& entry : value) list.push_back(oracle_of(entry));
      return list;
    }
    case JsonValue::Kind::object: {
      Oracle object = Oracle::object();
      for (const JsonValue& member : value) object[std::string(member.key())] = oracle_of(member);
      return object;
    }
  }
  return {};
}

std::string random_text(Rng& rng) {
  static const char* const kPieces[] = {"a", "q", "\"", "\\", "\n", "\x01", "/", "é", "位", "😀"};
  std::string text;
  for (std::size_t i = rng.below(6); i > 0; --i) text += kPieces[rng.below(std::size(kPieces))];
  return text;
}

Oracle random_value(Rng& rng, int depth) {
  switch (rng.below(depth > 0 ? 8 : 6)) {
    case 0:
      return nullptr;
    case 1:
      return rng.below(2) == 0;
    case 2:
      return rng.below(1'000'000);
    case 3:
      return -static_cast<std::int64_t>(1 + rng.below(1'000'000));
    case 4:
      return std::ldexp(rng.uniform(-1, 1), static_cast<int>(rng.below(400)) - 200);
    case 5:
      return random_text(rng);
    case 6: {
      Oracle list = Oracle::array();
      for (std::size_t i = rng.below(20); i > 0; --i) list.push_back(random_value(rng, depth - 1));
      return list;
    }
    default: {
      Oracle object = Oracle::object();
      for (std::size_t i = rng.below(25); i > 0; --i) {
        object[random_text(rng)] = random_value(rng, depth - 1);
      }
      return object;
    }
  }
}

TEST(Json, ReadsWhatAnotherLibraryReads) {
  Rng rng(1);
  for (int i = 0; i < 300; ++i) {
    const Oracle written{{"all", random_value(rng, 4)}};
    const std::string text = written.dump(i % 2 == 0 ? -1 : 2);
    const auto read = JsonObject::parse(text);
    ASSERT_TRUE(read) << text;
    EXPECT_EQ(oracle_of(**read), written) << text;
  }
}

TEST(Json, TakesAndRefusesDamagedTextsAsAnotherLibraryDoes) {
  Rng rng(2);
  const std::string bytes = "{}[]\",:0e.-tnu\\ \x80\xff";
  int refused = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string text = Oracle{{"all", random_value(rng, 2)}}.dump();
    text[rng.below(text.size())] = bytes[rng.below(bytes.size())];
    if (i % 3 == 0) text.resize(rng.below(text.size() + 1));
    const auto read = JsonObject::parse(text);
    try {
      const Oracle expected = Oracle::parse(text);
      if (!expected.is_object()) {
        ASSERT_FALSE(read) << text;
        EXPECT_EQ(read.error().code, JsonErrc::no_object);
        continue;
      }
      ASSERT_TRUE(read) << text;
      EXPECT_EQ(oracle_of(**read), expected) << text;
    } catch (const Oracle::parse_error& error) {
      ++refused;
      ASSERT_FALSE(read) << text;
      EXPECT_EQ(read.error().code, JsonErrc::syntax);
      EXPECT_EQ(read.error().byte, error.byte) << text;
    } catch (const Oracle::exception&) {
      ASSERT_FALSE(read) << text;
      EXPECT_EQ(read.error().code, JsonErrc::number_range) << text;
    }
  }
  EXPECT_GT(refused, 500);
}

JsonErrc refusal(std::string_view text, const JsonLimits& limits = {}) {
  const auto read = JsonObject::parse(text, limits);
  EXPECT_FALSE(read) << text;
  return read ? JsonErrc::syntax : read.error().code;
}

std::string nested(int depth) {
  const auto lists = static_cast<std::size_t>(depth - 1);
  return "{\"a\":" + std::string(lists, '[') + std::string(lists, ']') + "}";
}

TEST(Json, KeepsItsLimits) {
  EXPECT_TRUE(JsonObject::parse(nested(32)));
  EXPECT_EQ(refusal(nested(33)), JsonErrc::too_deep);
  EXPECT_TRUE(JsonObject::parse(nested(3), {.depth = 3}));
  EXPECT_EQ(refusal(nested(4), {.depth = 3}), JsonErrc::too_deep);
  // Brackets within strings open nothing, and a text that never ends is stopped where it is deep.
  EXPECT_TRUE(JsonObject::parse("{\"a\":\"" + std::string(100, '[') + "\"}"));
  EXPECT_EQ(refusal("{\"a\":" + std::string(1'000'000, '[')), JsonErrc::too_deep);
  EXPECT_TRUE(JsonObject::parse(R"({"a":[1,2]})", {.values = 4}));
  EXPECT_EQ(refusal(R"({"a":[1,2,3]})", {.values = 4}), JsonErrc::too_many);
  EXPECT_TRUE(JsonObject::parse("{}", {.bytes = 2}));
  EXPECT_EQ(refusal("{ }", {.bytes = 2}), JsonErrc::too_long);
  EXPECT_EQ(refusal("{\"a\":1e999}"), JsonErrc::number_range);
  EXPECT_EQ(refusal("[]"), JsonErrc::no_object);
  EXPECT_EQ(refusal(""), JsonErrc::syntax);
}

TEST(Json, OfEqualKeysTheLastOneCountsOrNone) {
  const std::string text = R"({"b":1,"a":2,"b":[3],"c":4,"a":5})";
  const auto read = JsonObject::parse(text, {.unique_keys = false});
  ASSERT_TRUE(read);
  ASSERT_EQ((*read)->size(), 3u);
  EXPECT_EQ((**read)[0].key(), "a");
  EXPECT_EQ((*read)->find("a")->number(), 5);
  EXPECT_EQ((*read)->find("b")->size(), 1u);
  const auto strict = JsonObject::parse(text);
  ASSERT_FALSE(strict);
  EXPECT_EQ(strict.error().code, JsonErrc::key_twice);
  EXPECT_EQ(strict.error().key, "a");
  EXPECT_NE(describe(strict.error()).find("\"a\""), std::string::npos);
}

TEST(Json, MisspeltKeysAreRefusedWithTheOneThatIsMeant) {
  constexpr std::string_view kKnown[] = {"v0", "a0", "id", "max_step", "speed", "q"};
  const auto fault = [&](const std::string& text) {
    const auto read = JsonObject::parse(text);
    EXPECT_TRUE(read) << text;
    const auto checked = check_keys(**read, kKnown);
    return checked ? std::string() : checked.error().what;
  };
  EXPECT_EQ(fault(R"({"V0":1})"), "the key \"V0\" is not known here (did you mean \"v0\"?)");
  EXPECT_NE(fault(R"({"maxstep":1})").find("\"max_step\""), std::string::npos);
  EXPECT_NE(fault(R"({"sped":1,"max_step":2})").find("\"speed\""), std::string::npos);
  // What others write beside it is none of our business.
  EXPECT_EQ(fault(R"({"v0":1,"a":2,"kind":"rest","us":3,"name":"x","index":4})"), "");
  EXPECT_EQ(fault("{\"" + std::string(100000, 'x') + "\":1}"), "");
}

TEST(Json, ValuesStayWhereTheirObjectIsMoved) {
  auto read = JsonObject::parse(R"({"name":"ur5e","q":[0,-1.5,true]})");
  ASSERT_TRUE(read);
  const JsonObject moved = std::move(*read);
  const JsonValue& q = *moved->find("q");
  EXPECT_EQ(moved->find("name")->string(), "ur5e");
  EXPECT_EQ(q[1].number(), -1.5);
  // What a value is not reads as nothing.
  EXPECT_EQ(q.number(), 0);
  EXPECT_EQ(q[0].string(), "");
  EXPECT_TRUE(q[0].empty());
  EXPECT_EQ(q.find("name"), nullptr);
  EXPECT_FALSE(q[1].boolean());
  EXPECT_TRUE(q[2].boolean());
  EXPECT_TRUE(JsonObject()->is_null());
}

std::string complaint(const std::string& text, std::size_t size) {
  const Result<JsonObject> object = parse_json_object(text);
  EXPECT_TRUE(object) << text;
  const auto numbers = number_list(**object, "q", size);
  return numbers ? "" : numbers.error().what;
}

TEST(Json, ListsOfNumbersSayWhatIsWrong) {
  EXPECT_EQ(complaint(R"({"q":[1,-2,3e-1]})", 3), "");
  EXPECT_EQ(complaint(R"({"Q":[1]})", 1), "\"q\" is missing (there is \"Q\" instead)");
  EXPECT_EQ(complaint(R"({"zero":[1]})", 1), "\"q\" is missing");
  EXPECT_EQ(complaint(R"({"q":1})", 1), "\"q\" must be a list of 1 numbers");
  EXPECT_EQ(complaint(R"({"q":[1,2]})", 3), "\"q\" must have 3 numbers, it has 2");
  EXPECT_EQ(complaint(R"({"q":[1,"2"]})", 2), "entry 1 of \"q\" is not a number");
  EXPECT_EQ(complaint(R"({"q":[null]})", 1), "entry 0 of \"q\" is not a number");
}

TEST(Json, PosesAreReadBackAsTheyWereWritten) {
  Rng rng(3);
  for (int i = 0; i < 100; ++i) {
    const Quat q(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(0.1, 1));
    const Quat unit = q.normalized();
    const double p[] = {rng.uniform(-2, 2), rng.uniform(-2, 2), rng.uniform(-2, 2)};
    const Oracle written{{"pos", p}, {"quat", {unit.w(), unit.x(), unit.y(), unit.z()}}};
    const Result<JsonObject> object = parse_json_object(written.dump());
    ASSERT_TRUE(object);
    const Result<Pose> X = pose_of(**object);
    ASSERT_TRUE(X);
    EXPECT_EQ(X->p, Eigen::Vector3d(p[0], p[1], p[2]));
    EXPECT_LT((X->R - unit.toRotationMatrix()).norm(), 1e-14);
  }
}

TEST(Json, QuaternionsMayBeRoundedButNoMore) {
  for (const double w : {0.99, 1.0, 1.015}) {
    const Result<Eigen::Matrix3d> R = rotation_of_quat(std::vector{w, 0.0, 0.0, 0.0});
    ASSERT_TRUE(R);
    EXPECT_LT((*R - Eigen::Matrix3d::Identity()).norm(), 1e-15);
  }
  for (const double w : {0.0, 0.9, 1.1, 1e300, std::numeric_limits<double>::infinity()}) {
    EXPECT_FALSE(rotation_of_quat(std::vector{w, 0.0, 0.0, 0.0})) << w;
  }
  const Result<JsonObject> off = parse_json_object(R"({"pos":[0,0,0],"quat":[2,0,0,0]})");
  ASSERT_TRUE(off);
  EXPECT_NE(pose_of(**off).error().what.find("length 1"), std::string::npos);
}

}  // namespace
}  // namespace mjarm
