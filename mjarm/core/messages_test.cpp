#include "mjarm/core/messages.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <thread>
#include <vector>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/messages/core.hpp"

namespace mjarm {
namespace {

constexpr Msg kCatalogue[] = {
#define MJARM_MSG(id, english, chinese) {english, chinese},
#include "mjarm/core/messages/app.inc"
#include "mjarm/core/messages/bench.inc"
#include "mjarm/core/messages/bench_plan.inc"
#include "mjarm/core/messages/bench_rl.inc"
#include "mjarm/core/messages/check.inc"
#include "mjarm/core/messages/collision.inc"
#include "mjarm/core/messages/control.inc"
#include "mjarm/core/messages/control_suite.inc"
#include "mjarm/core/messages/core.inc"
#include "mjarm/core/messages/demo.inc"
#include "mjarm/core/messages/execution.inc"
#include "mjarm/core/messages/guard.inc"
#include "mjarm/core/messages/install.inc"
#include "mjarm/core/messages/kinematics.inc"
#include "mjarm/core/messages/model.inc"
#include "mjarm/core/messages/motion_program.inc"
#include "mjarm/core/messages/path.inc"
#include "mjarm/core/messages/path_command.inc"
#include "mjarm/core/messages/plan.inc"
#include "mjarm/core/messages/plan_show.inc"
#include "mjarm/core/messages/planning.inc"
#include "mjarm/core/messages/policy_file.inc"
#include "mjarm/core/messages/program.inc"
#include "mjarm/core/messages/reach.inc"
#include "mjarm/core/messages/render.inc"
#include "mjarm/core/messages/render_command.inc"
#include "mjarm/core/messages/rl.inc"
#include "mjarm/core/messages/run.inc"
#include "mjarm/core/messages/run_charts.inc"
#include "mjarm/core/messages/sim.inc"
#include "mjarm/core/messages/target.inc"
#include "mjarm/core/messages/train.inc"
#include "mjarm/core/messages/trajectory.inc"
#include "mjarm/core/messages/verify.inc"
#include "mjarm/core/messages/view.inc"
#include "mjarm/core/messages/workspace.inc"
#undef MJARM_MSG
};

struct Placeholder {
  std::string name;    ///< index in braces, usually empty
  std::string format;  ///< after the colon
  friend bool operator==(const Placeholder&, const Placeholder&) = default;
};

/// The placeholders of a template in order; `{{` and `}}` are not any.
std::vector<Placeholder> placeholders(std::string_view pattern) {
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

bool is_number_format(const std::string& format) {
  return !format.empty() && std::string("eEfFgG").find(format.back()) != std::string::npos;
}
bool is_integer_format(const std::string& format) {
  return !format.empty() && std::string("dxX").find(format.back()) != std::string::npos;
}

bool has_chinese(std::string_view text) {
  return std::any_of(text.begin(), text.end(),
                     [](char c) { return static_cast<unsigned char>(c) >= 0xE2; });
}

class EveryMessage : public ::testing::Test {
 protected:
  ~EveryMessage() override { set_language(Language::english); }
  template <class Check>
  void for_each(Check check) {
    for (const Msg& message : kCatalogue) {
      SCOPED_TRACE(message.english);
      check(message);
    }
  }
};

TEST_F(EveryMessage, HasBothLanguages) {
  for_each([](const Msg& message) {
    EXPECT_FALSE(message.in(Language::english).empty());
    EXPECT_FALSE(message.in(Language::chinese).empty());
    // English stays ASCII, so that it shows everywhere.
    EXPECT_FALSE(has_chinese(message.in(Language::english)));
  });
}

TEST_F(EveryMessage, HasTheSamePlaceholdersInBoth) {
  for_each([](const Msg& message) {
    const auto english = placeholders(message.in(Language::english));
    const auto chinese = placeholders(message.in(Language::chinese));
    EXPECT_EQ(english.size(), chinese.size());
    // Numbered placeholders may change places, the others keep their order and format.
    auto by_index = [](const Placeholder& a, const Placeholder& b) { return a.name < b.name; };
    auto a = english, b = chinese;
    std::stable_sort(a.begin(), a.end(), by_index);
    std::stable_sort(b.begin(), b.end(), by_index);
    EXPECT_TRUE(a == b);
  });
}

TEST_F(EveryMessage, FormatsInBothLanguages) {
  for_each([](const Msg& message) {
    // As many values as placeholders, each of the kind its format asks for.
    const auto wanted = placeholders(message.in(Language::english));
    ASSERT_LE(wanted.size(), 9u);
    auto value = [&](std::size_t i) -> MsgArg {
      if (i >= wanted.size()) return std::string("unused");
      if (is_number_format(wanted[i].format)) return 1.5;
      if (is_integer_format(wanted[i].format)) return 7LL;
      return std::string("X");
    };
    for (const Language language : {Language::english, Language::chinese}) {
      set_language(language);
      const std::string formatted =
          format_message(message, {value(0), value(1), value(2), value(3), value(4), value(5),
                                   value(6), value(7), value(8)});
      EXPECT_TRUE(formatted.find("{}") == std::string::npos &&
                  formatted.find("{:") == std::string::npos)
          << formatted;
    }
  });
}

TEST(Messages, LanguageOfNames) {
  EXPECT_EQ(language_of("zh-CN"), Language::chinese);
  EXPECT_EQ(language_of("zh_CN.UTF-8"), Language::chinese);
  EXPECT_EQ(language_of("ZH"), Language::chinese);
  EXPECT_EQ(language_of("en"), Language::english);
  EXPECT_EQ(language_of("C.UTF-8"), Language::english);
  EXPECT_EQ(language_of("de_DE"), Language::english);
  EXPECT_EQ(language_of("z"), Language::english);
  EXPECT_EQ(language_of(""), Language::english);
}

TEST(Messages, FillsInOrderAndInTheLanguageInUse) {
  EXPECT_EQ(text(msg::core_cannot_read, "a.txt", "why"), "a.txt: cannot be read: why");
  set_language(Language::chinese);
  EXPECT_EQ(text(msg::core_cannot_read, "a.txt", "why"), "a.txt：无法读取：why");
  set_language(Language::english);
}

TEST(Messages, AScopeIsForItsThreadAlone) {
  set_language(Language::chinese);
  {
    const LanguageScope scope(Language::english);
    EXPECT_EQ(text(msg::core_cannot_read, "a", "b"), "a: cannot be read: b");
    std::thread([] { EXPECT_EQ(language(), Language::chinese); }).join();
    const LanguageScope inner(Language::chinese);
    EXPECT_EQ(language(), Language::chinese);
  }
  EXPECT_EQ(text(msg::core_cannot_read, "a", "b"), "a：无法读取：b");
  set_language(Language::english);
  EXPECT_EQ(language(), Language::english);
}

TEST(Messages, TooFewValuesDoNotThrow) {
  EXPECT_EQ(text(msg::core_cannot_read, "a.txt"), "{}: cannot be read: {}");
  EXPECT_EQ(text(msg::core_progress_rate, "no number"), "{:.1f}/s");
}

}  // namespace
}  // namespace mjarm
