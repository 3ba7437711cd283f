#include "mjarm/core/messages.hpp"

#include <gtest/gtest.h>

#include <string>
#include <thread>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/messages/core.hpp"

namespace mjarm {
namespace {

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
