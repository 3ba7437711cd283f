#include "mjarm/path/hanzi.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

using ::testing::HasSubstr;

/// Strokes of our own, under the names of two characters.
constexpr const char* kStrokes =
    "一 100,400 500,420 900,400\n"
    "上 512,876 512,-124;512,500 800,500;100,0 101,0 924,0\n";

/// A data folder of its own for this process, and what was there before.
class Hanzi : public ::testing::Test {
 protected:
  Hanzi() {
    if (const char* before = std::getenv("XDG_DATA_HOME")) before_ = before;
    ::setenv("XDG_DATA_HOME", folder.path().string().c_str(), 1);
  }
  ~Hanzi() override {
    if (before_.empty()) {
      ::unsetenv("XDG_DATA_HOME");
    } else {
      ::setenv("XDG_DATA_HOME", before_.c_str(), 1);
    }
  }
  void install(const std::string& content) {
    std::filesystem::create_directories(folder.path() / "mjarm/hanzi");
    folder.write("mjarm/hanzi/strokes.txt", content);
  }
  support::TempFolder folder;

 private:
  std::string before_;
};

TEST_F(Hanzi, StrokesStandInASquareOfTheHeight) {
  install(kStrokes);
  const auto strokes = letter_strokes("上", 0.1024).value();
  ASSERT_EQ(strokes.size(), 3U);
  for (const Stroke& stroke : strokes) EXPECT_TRUE(stroke.smooth);
  EXPECT_NEAR(strokes[0].points[0].x(), 0.0512, 1e-12);
  EXPECT_NEAR(strokes[0].points[0].y(), 0.1, 1e-12);
  EXPECT_NEAR(strokes[0].points[1].y(), 0, 1e-12);
  // A point a unit beside the one before is left out.
  ASSERT_EQ(strokes[2].points.size(), 2U);
  EXPECT_NEAR(strokes[2].points[1].x(), 0.0924, 1e-12);
}

TEST_F(Hanzi, StandBesideLettersAndWideSpaces) {
  install(kStrokes);
  const auto strokes = letter_strokes("I一　一", 1.024).value();
  ASSERT_EQ(strokes.size(), 3U);
  EXPECT_FALSE(strokes[0].smooth);
  const double first = strokes[1].points[0].x();
  EXPECT_GT(first, strokes[0].points[0].x() + 0.2);
  EXPECT_NEAR(strokes[2].points[0].x(), first + 2 * 1.024, 1e-12);
}

TEST_F(Hanzi, SaysWhatIsMissing) {
  const auto what = [](const char* text) {
    const auto strokes = letter_strokes(text, 0.1);
    return strokes ? std::string("none") : strokes.error().what;
  };
  EXPECT_THAT(what("A一"), HasSubstr("mjarm models install hanzi"));
  EXPECT_EQ(letter_strokes("一", 0.1).error().code, Errc::not_available);
  EXPECT_THAT(what("A!"), HasSubstr("\"!\""));
  install(kStrokes);
  EXPECT_EQ(what("一上"), "none");
  EXPECT_THAT(what("一下"), HasSubstr("\"下\""));
  EXPECT_EQ(letter_strokes("下", 0.1).error().code, Errc::bad_input);
}

TEST_F(Hanzi, ADamagedLineIsNamed) {
  for (const char* line : {"一", "一 ", "一 1,2", "一 1,2 3", "一 1,2 3,4x", "一 1,2 3,4;",
                           "一 1,2;3,4", "一 a,b c,d", "一 5,5 5,6", "一 99999999999,1 2,2"}) {
    install(std::string("上 1,1 9,9\n") + line + "\n");
    const auto strokes = letter_strokes("一", 0.1);
    if (std::string(line) == "一 1,2 3,4;") continue;  // an end that parts nothing
    ASSERT_FALSE(strokes.has_value()) << line;
    EXPECT_THAT(strokes.error().what, HasSubstr("strokes.txt:2")) << line;
    EXPECT_TRUE(letter_strokes("上", 0.1).has_value()) << line;
  }
}

}  // namespace
}  // namespace mjarm
