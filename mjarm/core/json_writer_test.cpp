#include "mjarm/core/json_writer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "mjarm/core/json.hpp"
#include "mjarm/core/rng.hpp"

namespace mjarm {
namespace {

using OrderedOracle = nlohmann::ordered_json;

TEST(JsonWriter, PutsCommasWhereTheyBelong) {
  std::string out;
  JsonWriter json(out);
  json.object()
      .member("ok", true)
      .member("at", 3)
      .member("least", -1)
      .member("s", 0.5)
      .member("why", "a \"b\"\n")
      .member("name", std::string("位"))
      .key("none")
      .value(nullptr)
      .member("q", joint_vec(std::vector{1.0, -2.5}))
      .member("rows", std::vector{joint_vec(std::vector{1.0}), joint_vec(std::vector{2.0})})
      .member("words", std::vector<std::string>{"a", "b"})
      .member("p", Eigen::Vector3d(0, 1, 2))
      .member("empty", std::vector<double>{});
  json.key("list").list().object().end_object().list().end_list().value(1).end_list();
  json.member_us("us", 12.3456).end_object();
  EXPECT_EQ(out,
            R"({"ok":true,"at":3,"least":-1,"s":0.5,"why":"a \"b\"\n","name":"位","none":null,)"
            R"("q":[1.0,-2.5],"rows":[[1.0],[2.0]],"words":["a","b"],"p":[0.0,1.0,2.0],"empty":[],)"
            R"("list":[{},[],1],"us":12.3})");
}

TEST(JsonWriter, ALineBreakStandsBetweenEntriesOnly) {
  std::string out;
  JsonWriter json(out);
  json.object();
  for (const char* id : {"a", "b"}) json.line_break().key(id).list().end_list();
  json.end_object();
  EXPECT_EQ(out, "{\"a\":[],\n \"b\":[]}");
}

TEST(JsonWriter, ALineBreakMayBeginAPieceOfItsOwn) {
  std::string piece;
  JsonWriter(piece).line_break().key("a").list().end_list();
  EXPECT_EQ(piece, R"("a":[])");
}

TEST(JsonWriter, NumbersComeBackToTheLastBit) {
  Rng rng(1);
  for (int i = 0; i < 1000; ++i) {
    const double value = std::ldexp(rng.uniform(-1, 1), static_cast<int>(rng.below(600)) - 300);
    std::string out;
    JsonWriter(out).object().member("x", value).end_object();
    const Result<JsonObject> read = parse_json_object(out);
    ASSERT_TRUE(read);
    EXPECT_EQ((*read)->find("x")->number(), value) << out;
  }
  std::string out;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  JsonWriter(out).list().value(nan).value(std::numeric_limits<double>::infinity()).end_list();
  EXPECT_EQ(out, "[null,null]");
}

TEST(JsonDoc, WritesWhatAnotherLibraryReads) {
  JsonDoc doc{{"name", "ur5e"},
              {"range", {0.0, 1.0}},
              {"rows", std::vector<std::vector<double>>{{1, 2}, {}}},
              {"q", joint_vec(std::vector{0.1, 0.2})},
              {"words", std::vector<std::string>{"a", "b"}},
              {"none", nullptr},
              {"on", true},
              {"count", std::size_t{3}}};
  doc.set("more", std::vector<JsonDoc>{JsonDoc{{"a", -1}}, 2.5, "x"});
  doc.set("name", std::string("panda"));
  const JsonDoc copy = doc;
  JsonDoc all;
  all.set("first", 1);
  all.set_all(copy);
  const OrderedOracle expected = OrderedOracle::parse(
      R"({"first":1,"name":"panda","range":[0.0,1.0],"rows":[[1.0,2.0],[]],"q":[0.1,0.2],
          "words":["a","b"],"none":null,"on":true,"count":3,"more":[{"a":-1},2.5,"x"]})");
  EXPECT_EQ(all.line(), expected.dump());
  EXPECT_EQ(all.document(), expected.dump(2) + "\n");
}

TEST(JsonDoc, WhatIsNoUtf8OrNoNumberIsReplaced) {
  const JsonDoc doc{{"name", "a\xff"}, {"x", std::numeric_limits<double>::infinity()}};
  EXPECT_EQ(doc.line(), "{\"name\":\"a\xEF\xBF\xBD\",\"x\":null}");
}

TEST(JsonDoc, NothingThatATerminalWouldObey) {
  const std::string name =
      "\xc2\x9b"
      "1m\x7f\x1b\xc2\xa0";
  const JsonDoc doc{{name.c_str(), name}};
  EXPECT_EQ(doc.line(), R"({"\u009b1m\u007f\u001b)"
                        "\xc2\xa0"
                        R"(":"\u009b1m\u007f\u001b)"
                        "\xc2\xa0\"}");
  EXPECT_EQ(nlohmann::json::parse(doc.document()).at(name), name);
}

}  // namespace
}  // namespace mjarm
