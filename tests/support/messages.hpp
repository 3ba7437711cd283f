#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <span>
#include <string>
#include <vector>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/messages.hpp"

/// What has to hold of every text of a folder `messages/`.
namespace mjarm::support {

struct Placeholder {
  std::string name;    ///< index in braces, usually empty
  std::string format;  ///< after the colon
  friend bool operator==(const Placeholder&, const Placeholder&) = default;
};

/// The placeholders of a template in order; `{{` and `}}` are not any.
inline std::vector<Placeholder> placeholders(std::string_view pattern) {
  std::vector<Placeholder> found;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (pattern[i] != '{') continue;
    if (pattern.substr(i, 2) == "{{") {
      ++i;
      continue;
    }
    const std::size_t end = pattern.find('}', i);
    if (end == std::string_view::npos) return {{"unbalanced", ""}};
    const std::string inside(pattern.substr(i + 1, end - i - 1));
    const std::size_t colon = inside.find(':');
    if (colon == std::string::npos) {
      found.push_back({inside, ""});
    } else {
      found.push_back({inside.substr(0, colon), inside.substr(colon + 1)});
    }
    i = end;
  }
  return found;
}

inline bool is_number_format(const std::string& format) {
  return !format.empty() && std::string("eEfFgG").find(format.back()) != std::string::npos;
}
inline bool is_integer_format(const std::string& format) {
  return !format.empty() && std::string("dxX").find(format.back()) != std::string::npos;
}

inline bool has_chinese(std::string_view text) {
  return std::any_of(text.begin(), text.end(),
                     [](char c) { return static_cast<unsigned char>(c) >= 0xE2; });
}

/// Both languages are there; English is ASCII, so that it shows everywhere.
inline void expect_both_languages(const Msg& message) {
  EXPECT_FALSE(message.in(Language::english).empty());
  EXPECT_FALSE(message.in(Language::chinese).empty());
  EXPECT_FALSE(has_chinese(message.in(Language::english)));
}

/// Chinese and a Latin letter or a digit stand apart by a space, as in "5 mm 以内".
inline void expect_chinese_apart(const Msg& message) {
  const std::string_view text = message.in(Language::chinese);
  const auto begins_ideograph = [&](std::size_t i) {  // U+4000 to U+9FFF in UTF-8
    const auto byte = i < text.size() ? static_cast<unsigned char>(text[i]) : 0;
    return byte >= 0xE4 && byte <= 0xE9;
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (!std::isalnum(static_cast<unsigned char>(text[i]))) continue;
    EXPECT_FALSE(begins_ideograph(i + 1) || (i >= 3 && begins_ideograph(i - 3)))
        << text << ": at \"" << text[i] << '"';
  }
}

/// Numbered placeholders may change places, the others keep their order and format.
inline void expect_same_placeholders(const Msg& message) {
  const auto in_order = [&](Language language) {
    auto found = placeholders(message.in(language));
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.name < b.name; });
    return found;
  };
  EXPECT_TRUE(in_order(Language::english) == in_order(Language::chinese));
}

/// Takes as many values as it has placeholders, each of the kind its format asks for.
inline void expect_formats(const Msg& message) {
  const auto wanted = placeholders(message.in(Language::english));
  ASSERT_LE(wanted.size(), 9u);
  const auto value = [&](std::size_t i) -> MsgArg {
    if (i >= wanted.size()) return std::string("unused");
    if (is_number_format(wanted[i].format)) return 1.5;
    if (is_integer_format(wanted[i].format)) return 7LL;
    return std::string("X");
  };
  for (const Language language : {Language::english, Language::chinese}) {
    const LanguageScope scope(language);
    const std::string formatted = format_message(
        message,
        {value(0), value(1), value(2), value(3), value(4), value(5), value(6), value(7), value(8)});
    EXPECT_TRUE(formatted.find("{}") == std::string::npos &&
                formatted.find("{:") == std::string::npos)
        << formatted;
  }
}

inline void expect_sound(std::span<const Msg> messages) {
  for (const Msg& message : messages) {
    SCOPED_TRACE(message.english);
    expect_both_languages(message);
    expect_chinese_apart(message);
    expect_same_placeholders(message);
    expect_formats(message);
  }
}

}  // namespace mjarm::support
