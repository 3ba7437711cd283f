#include "mjarm/core/yaml_tree.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ctime>
#include <string>

#include "mjarm/core/language_scope.hpp"

namespace mjarm {
namespace {

using ::testing::HasSubstr;

std::string error_of(const std::string& text) {
  const Result<YamlNode> root = read_yaml(text, "f.yaml");
  if (root) return "none";
  EXPECT_EQ(root.error().code, Errc::bad_input);
  return root.error().what;
}

TEST(YamlTree, KnowsWhatStandsWhere) {
  const Result<YamlNode> root = read_yaml("a: [1, '2', ~]\nb:\n  c: x\n", "f.yaml");
  ASSERT_TRUE(root) << root.error().what;
  ASSERT_EQ(root->kind, YamlNode::Kind::map);
  ASSERT_EQ(root->members.size(), 2U);
  const YamlNode& list = root->members[0].value;
  ASSERT_EQ(list.items.size(), 3U);
  EXPECT_EQ(list.items[0].text, "1");
  EXPECT_FALSE(list.items[0].quoted);
  EXPECT_TRUE(list.items[1].quoted);
  EXPECT_EQ(list.items[2].kind, YamlNode::Kind::nothing);
  EXPECT_EQ(list.items[1].place.line, 1);
  EXPECT_EQ(list.items[1].place.column, 8);
  const YamlNode& inner = root->members[1].value;
  EXPECT_EQ(inner.members[0].key.place.line, 3);
  EXPECT_EQ(inner.members[0].key.place.column, 3);
}

TEST(YamlTree, AliasesAreCopies) {
  const Result<YamlNode> root = read_yaml("a: &way [1, 2]\nb: *way\n", "f.yaml");
  ASSERT_TRUE(root) << root.error().what;
  EXPECT_EQ(root->members[1].value.items.size(), 2U);
  EXPECT_EQ(root->members[1].value.items[1].text, "2");
  EXPECT_THAT(error_of("a: *way"), HasSubstr("f.yaml:1:"));
}

/// Who reads programs says something else of it than who reads trainings.
TEST(YamlTree, AnEmptyTextIsNothingAtNoPlace) {
  for (const char* text : {"", "\n\n", "# only a comment\n"}) {
    const Result<YamlNode> root = read_yaml(text, "f.yaml");
    ASSERT_TRUE(root) << root.error().what;
    EXPECT_EQ(root->kind, YamlNode::Kind::nothing);
    EXPECT_EQ(root->place.line, 0);
  }
  EXPECT_EQ(read_yaml("~", "f.yaml")->place.line, 1);
}

TEST(YamlTree, FaultsHaveAPlaceInBothLanguages) {
  EXPECT_THAT(error_of("a: 1\na: 2"), HasSubstr("f.yaml:2:1: \"a\" stands here a second time"));
  EXPECT_THAT(error_of("[1, 2]: 3"), HasSubstr("f.yaml:1:1: expected a word"));
  EXPECT_THAT(error_of("a: 1\n---\nb: 2"), HasSubstr("f.yaml:3:1: expected one document"));
  EXPECT_THAT(error_of("a: [1"), HasSubstr("no YAML: a [ is not closed"));
  EXPECT_THAT(error_of(std::string(33, '[') + std::string(33, ']')), HasSubstr("32 levels"));
  EXPECT_EQ(error_of(std::string(32, '[') + std::string(32, ']')), "none");
  const LanguageScope chinese(Language::chinese);
  EXPECT_THAT(error_of("a: 1\na: 2"), HasSubstr("f.yaml:2:1：“a”重复出现"));
}

/// Whatever the library finds wrong is said in our words, and where.
TEST(YamlTree, NothingOfTheLibrarysOwnWordsIsLeft) {
  const std::pair<const char*, const char*> wrong[] = {
      {"a: b: c", "f.yaml:1:5: no YAML: a colon is not expected here"},
      {"a: 1\n  b: 2\n", "f.yaml:2:4: no YAML: a colon is not expected here"},
      {"a: {x: 1\nb: 2\n", "f.yaml:1:4: no YAML: a { is not closed"},
      {"a: [1, 2\n", "f.yaml:1:4: no YAML: a [ is not closed"},
      {"a:\n  - 臂: {x: [1], y: [2]\n  - b\n", "f.yaml:2:8: no YAML: a { is not closed"},
      {"a: {x: [1, 2, y: 3}\nb: 2\n", "f.yaml:1:8: no YAML: a [ is not closed"},
      {"a: 'it''s [' # {\nb: [x\n", "f.yaml:2:4: no YAML: a [ is not closed"},
      {"a: {x: 1 y: 2}\n", "no YAML: "},
      {"a: ]\n", "no YAML: a bracket closes here that was not opened"},
      {"a: \"\\q\"\n", "no YAML: unknown escape"},
      {"a: @x\n", "no YAML: a sign stands here that can begin no value"},
      {"- a\n b: 2\n- c\n", "no YAML: "},
      {"a: *\n", "no YAML: expected a name after & or *"},
      {"a:\n\t- 1\n", "f.yaml:2:1: no YAML: a tab stands in the indentation"},
      {"a:\n  b: 1\n c: 2\n", "no YAML: this line is indented otherwise"},
      {"%YAML 3.0\n---\na: 1\n", "no YAML: lines that begin with % are directives"}};
  for (const auto& [text, says] : wrong) {
    EXPECT_THAT(error_of(text), HasSubstr(says)) << text;
    for (const char* theirs : {"illegal", "token", "flow", "scalar", "end of map"}) {
      EXPECT_EQ(error_of(text).find(theirs), std::string::npos) << error_of(text);
    }
    const LanguageScope chinese(Language::chinese);
    EXPECT_THAT(error_of(text), HasSubstr("不是 YAML：")) << text;
    EXPECT_EQ(error_of(text).find_first_of("ghjlopquvxz", 8), std::string::npos) << error_of(text);
  }
}

TEST(YamlTree, APlaceIsLeftOutWhereThereIsNone) {
  EXPECT_EQ(at_place("f.yaml", {3, 7}, "wrong"), "f.yaml:3:7: wrong");
  EXPECT_EQ(at_place("f.yaml", {}, "wrong"), "f.yaml: wrong");
  EXPECT_EQ(at_place("", {}, "wrong"), "wrong");
}

TEST(YamlTree, ManyKeysTakeTimeInProportion) {
  std::string text;
  for (int i = 0; i < 99'000; ++i) text += "key" + std::to_string(i) + ": 1\n";
  const std::clock_t begun = std::clock();
  EXPECT_TRUE(read_yaml(text, "many.yaml"));
  EXPECT_LT(static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC, 5) << "[s] computing";
}

}  // namespace
}  // namespace mjarm
