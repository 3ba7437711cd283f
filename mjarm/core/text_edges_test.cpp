// Words, lines and numbers that a user writes, at their edges.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/line_reader.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/number.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/core/text_width.hpp"
#include "mjarm/core/units.hpp"
#include "mjarm/core/utf8.hpp"
#include "mjarm/core/yaml_tree.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

using ::testing::HasSubstr;

/// A code point by the plain rule of RFC 3629, whether it may be written or not.
std::string encoded(std::uint32_t code) {
  const auto tail = [code](int shift) {
    return static_cast<char>(0x80 | ((code >> shift) & 0x3F));
  };
  if (code < 0x80) return {static_cast<char>(code)};
  if (code < 0x800) return {static_cast<char>(0xC0 | code >> 6), tail(0)};
  if (code < 0x10000) return {static_cast<char>(0xE0 | code >> 12), tail(6), tail(0)};
  return {static_cast<char>(0xF0 | code >> 18), tail(12), tail(6), tail(0)};
}

TEST(TextEdges, EveryCodePointIsOneCharacterAndNoOtherBytesAre) {
  for (std::uint32_t code = 0; code < 0x120000; ++code) {
    const std::string bytes = encoded(code);
    const bool is_surrogate = code >= 0xD800 && code < 0xE000;
    const bool is_one = code <= 0x10FFFF && !is_surrogate;
    ASSERT_EQ(utf8_length(bytes), is_one ? bytes.size() : 0U) << code;
    if (bytes.size() > 1) {
      ASSERT_EQ(utf8_length(bytes.substr(0, bytes.size() - 1)), 0U) << code;
    }
  }
  // Of all pairs of bytes those are characters which stand for U+0080 to U+07FF.
  int pairs = 0;
  for (int a = 0x80; a < 0x100; ++a) {
    for (int b = 0; b < 0x100; ++b) {
      pairs += utf8_length(std::string{static_cast<char>(a), static_cast<char>(b)}) == 2;
    }
  }
  EXPECT_EQ(pairs, 0x800 - 0x80);
}

TEST(TextEdges, WidthsAddAndPaddedTextsStandInColumns) {
  const std::vector<std::string> words = {"", "a", "关节", "Zürich", "（6）", "\xF0\x9F\xA4\x96"};
  for (const std::string& a : words) {
    for (const std::string& b : words) {
      EXPECT_EQ(text_width(a + b), text_width(a) + text_width(b));
    }
    for (int width = -1; width < 12; ++width) {
      const std::string filled = padded(a, width);
      EXPECT_EQ(text_width(filled), std::max(width, text_width(a)));
      EXPECT_TRUE(filled.starts_with(a));
    }
  }
}

TEST(TextEdges, DecimalUnitsAreExactToTheLastBit) {
  Rng rng(41);
  for (int i = 0; i < 20000; ++i) {
    // 12345 um is what the compiler makes of 12345e-6, and so are the others.
    const auto whole = static_cast<long long>(rng.below(2'000'001)) - 1'000'000;
    const std::string digits = std::to_string(whole);
    const auto exact = [&](const char* exponent) {
      return std::strtod((digits + exponent).c_str(), nullptr);
    };
    ASSERT_EQ(parse_quantity(digits + "um", Quantity::length).value(), exact("e-6"));
    ASSERT_EQ(parse_quantity(digits + " mm", Quantity::length).value(), exact("e-3"));
    ASSERT_EQ(parse_quantity(digits + "cm/s", Quantity::speed).value(), exact("e-2"));
    ASSERT_EQ(parse_quantity(digits + "us", Quantity::time).value(), exact("e-6"));
    const double x = std::ldexp(rng.uniform(-1, 1), static_cast<int>(rng.below(80)) - 40);
    ASSERT_EQ(parse_quantity(number(x) + "rad", Quantity::angle).value(), x);
  }
}

TEST(TextEdges, UnitsAreTakenAsWrittenAndRefusedByName) {
  const std::vector<std::pair<const char*, const char*>> cases = {
      {"90°", "unknown unit \"°\" in \"90°\" (known here: rad, mrad, deg)"},
      {"1DEG", "unknown unit \"DEG\" in \"1DEG\" (known here: rad, mrad, deg)"},
      {"0x10", "unknown unit \"x10\" in \"0x10\" (known here: rad, mrad, deg)"},
      {"1..5", "unknown unit \".5\" in \"1..5\" (known here: rad, mrad, deg)"},
      {"１", "\"１\" is not a number"},
      {"1e400deg", "\"1e400deg\" is not a finite number"}};
  for (const auto& [written, what] : cases) {
    const Result<double> read = parse_quantity(written, Quantity::angle);
    ASSERT_FALSE(read) << written;
    EXPECT_EQ(read.error().what, what);
  }
  EXPECT_EQ(parse_quantity("3m", Quantity::number).error().what,
            "no unit is expected here, but \"m\" stands in \"3m\"");
  const LanguageScope chinese(Language::chinese);
  EXPECT_EQ(parse_quantity("x", Quantity::length).error().what, "“x”不是数字");
}

TEST(TextEdges, AListNamesItsEntryThatIsWrong) {
  EXPECT_EQ(parse_quantities("1deg, 2, 3mm", Quantity::angle).error().what,
            "unknown unit \"mm\" in \"3mm\" (known here: rad, mrad, deg)");
  EXPECT_EQ(parse_quantities(" ", Quantity::angle).error().what, "\"\" is not a number");
  EXPECT_TRUE(split_list(" \t ").empty());
  const std::string words = " a b,c ,, d ";
  const std::vector<std::string_view> parts = split_list(words);
  EXPECT_EQ(parts, (std::vector<std::string_view>{"a b", "c", "", "d"}));
  for (const std::string_view part : parts) {  // views into what was given
    if (part.empty()) continue;
    EXPECT_TRUE(part.data() >= words.data() && part.data() <= words.data() + words.size());
  }
}

TEST(TextEdges, TheNearestWordIsOneThatNoOtherIsNearerTo) {
  Rng rng(42);
  const auto word = [&rng] {
    std::string w(1 + rng.below(7), 'a');
    for (char& c : w) c = static_cast<char>('a' + rng.below(4));
    return w;
  };
  for (int i = 0; i < 2000; ++i) {
    std::vector<std::string> known(rng.below(6));
    for (std::string& w : known) w = word();
    const std::string slip = word();
    const auto nearest = nearest_word(slip, known);
    const int most = std::max(2, static_cast<int>(slip.size()) / 3);
    for (const std::string& w : known) {
      const int distance = edit_distance(slip, w);
      if (distance == 0) continue;  // the word itself is no hint
      if (nearest) {
        ASSERT_LE(edit_distance(slip, *nearest), std::max(distance, most));
        if (distance < edit_distance(slip, *nearest)) {
          ASSERT_EQ(distance, static_cast<int>(std::max(slip.size(), w.size())));
        }
      } else {
        const bool shares_nothing = distance == static_cast<int>(std::max(slip.size(), w.size()));
        ASSERT_TRUE(distance > most || shares_nothing) << slip << ' ' << w;
      }
    }
  }
  EXPECT_EQ(listed({}), "");
  EXPECT_EQ(listed(std::vector<std::string>{"a", "b c", ""}), "a, b c, ");
  const LanguageScope chinese(Language::chinese);
  EXPECT_EQ(listed(std::vector<std::string>{"a", "b c"}), "a、b c");
  EXPECT_EQ(did_you_mean("hme", std::vector<std::string>{"home"}), "（是否想输入“home”？）");
}

std::vector<std::string> lines_read(const std::string& content, std::size_t longest = 100) {
  const support::TempFolder folder;
  Result<LineReader> reader = LineReader::open(folder.write("f", content).string(), longest);
  EXPECT_TRUE(reader);
  std::vector<std::string> lines;
  for (;;) {
    const auto line = reader->next();
    if (!line) return {"refused"};
    if (!*line) break;
    lines.emplace_back(**line);
  }
  EXPECT_FALSE(reader->next().value());  // the end stays the end
  return lines;
}

TEST(TextEdges, LinesEndAtLineFeedsAlone) {
  using Lines = std::vector<std::string>;
  EXPECT_EQ(lines_read(""), Lines{});
  EXPECT_EQ(lines_read("\xEF\xBB\xBF"), Lines{});
  EXPECT_EQ(lines_read("\n\r\n \n"), Lines{});
  EXPECT_EQ(lines_read("a\rb\n"), Lines{"a\rb"});
  EXPECT_EQ(lines_read(std::string("a\0b\nc", 5)), (Lines{std::string("a\0b", 3), "c"}));
  EXPECT_EQ(lines_read("a\n\xEF\xBB\xBF"
                       "b\n"),
            (Lines{"a",
                   "\xEF\xBB\xBF"
                   "b"}));
  EXPECT_EQ(lines_read("  a \n"), Lines{"  a "});
  EXPECT_EQ(lines_read("12345\r\n", 6), Lines{"12345"});
  EXPECT_EQ(lines_read("1234567", 6), Lines{"refused"});
  EXPECT_EQ(lines_read(std::string(1 << 20, ' ') + "\n", 1 << 20), Lines{});
}

TEST(TextEdges, AliasesCannotGrowATreeBeyondItsBound) {
  // Each level has ten times the one before: a billion values in a few lines.
  std::string bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 10; ++i) {
    const std::string alias = "*a" + std::to_string(i - 1), own = "a" + std::to_string(i);
    bomb += own + ": &" + own + " [" + alias;
    for (int k = 0; k < 9; ++k) bomb += ", " + alias;
    bomb += "]\n";
  }
  const Result<YamlNode> read = read_yaml(bomb, "bomb.yaml");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, Errc::bad_input);
  EXPECT_THAT(read.error().what, HasSubstr("more than 200000 values"));
  EXPECT_THAT(read.error().what, ::testing::StartsWith("bomb.yaml:"));
}

TEST(TextEdges, ScalarsOfYamlKeepTheirTextAndPlace) {
  const Result<YamlNode> root =
      read_yaml("键: 值 # note\r\nlong: |\r\n  one\r\n  two\r\nno: !!str 7\nempty:\n", "f");
  ASSERT_TRUE(root) << root.error().what;
  ASSERT_EQ(root->members.size(), 4U);
  EXPECT_EQ(root->members[0].key.text, "键");
  EXPECT_EQ(root->members[0].value.text, "值");
  EXPECT_FALSE(root->members[0].value.quoted);
  EXPECT_EQ(root->members[1].value.text, "one\ntwo\n");
  EXPECT_TRUE(root->members[1].value.quoted);
  EXPECT_TRUE(root->members[2].value.quoted);
  EXPECT_EQ(root->members[2].key.place.line, 5);
  EXPECT_EQ(root->members[3].value.kind, YamlNode::Kind::nothing);
}

TEST(TextEdges, MessagesTakeValuesThatLookLikePlaceholders) {
  EXPECT_EQ(text(msg::core_cannot_read, "{}", "{0} {:d} }{ %s"),
            "{}: cannot be read: {0} {:d} }{ %s");
  EXPECT_EQ(text(msg::core_cannot_read, "a", "b", "one too many"), "a: cannot be read: b");
  EXPECT_EQ(text(msg::core_file_too_large, "f", std::size_t{1} << 62),
            "f: larger than the 4611686018427387904 bytes that are read at most");
}

}  // namespace
}  // namespace mjarm
