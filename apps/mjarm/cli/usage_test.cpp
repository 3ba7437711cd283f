// The words of the command line that become numbers, sizes and choices.
#include "apps/mjarm/cli/usage.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <numbers>

#include "mjarm/core/language_scope.hpp"

namespace mjarm::app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// What is said where a value is refused; empty where it is taken.
template <class T>
std::string refusal(const Result<T>& result) {
  if (result) return {};
  EXPECT_TRUE(result.error().code == Errc::usage || result.error().code == Errc::bad_input);
  EXPECT_EQ(result.error().what.find('\n'), std::string::npos) << result.error().what;
  return result.error().what;
}

TEST(Usage, WholeNumbersAreDigitsAndNothingElse) {
  EXPECT_EQ(parse_whole("--seed", "0").value(), 0U);
  EXPECT_EQ(parse_whole("--seed", "007").value(), 7U);
  EXPECT_EQ(parse_whole("--seed", "18446744073709551615").value(), UINT64_MAX);
  for (const char* bad : {"", " ", "-1", "-0", "+1", " 1", "1 ", "1.0", "1e3", "0x10", "1,000",
                          "18446744073709551616", "99999999999999999999999", "seven", "七", "１"}) {
    EXPECT_THAT(refusal(parse_whole("--seed", bad)), StartsWith("--seed: \"")) << bad;
  }
}

TEST(Usage, CountsHaveBothEnds) {
  EXPECT_EQ(parse_count("--rounds", "1", 5).value(), 1);
  EXPECT_EQ(parse_count("--rounds", "5", 5).value(), 5);
  EXPECT_EQ(refusal(parse_count("--rounds", "0", 5)),
            "--rounds must be a whole number from 1 to 5, not 0");
  EXPECT_EQ(refusal(parse_count("--rounds", "6", 5)),
            "--rounds must be a whole number from 1 to 5, not 6");
  EXPECT_EQ(parse_count("--quiet-runs", "0", 5, 0).value(), 0);
  // A number that fits no int is not cut down to one that does.
  EXPECT_THAT(refusal(parse_count("--rounds", "4294967297", 5)), HasSubstr("not 4294967297"));
  EXPECT_THAT(refusal(parse_count("--rounds", "two", 5)), HasSubstr("\"two\""));
  EXPECT_EQ(parse_threads("1024").value(), 1024);
  for (const char* bad : {"0", "1025", "4294967297"}) {
    EXPECT_EQ(refusal(parse_threads(bad)),
              "--threads " + std::string(bad) + ": expected a number from 1 to 1024");
  }
}

TEST(Usage, AChoiceIsOneOfItsWordsExactly) {
  const std::array<std::string, 3> words{"low", "medium", "high"};
  for (std::size_t i = 0; i < words.size(); ++i) {
    EXPECT_EQ(parse_choice("--quality", words[i], words).value(), i);
  }
  EXPECT_EQ(
      refusal(parse_choice("--quality", "hihg", words)),
      "--quality: \"hihg\" is unknown (did you mean \"high\"?); expected one of: low, medium, "
      "high");
  for (const char* bad : {"", "HIGH", "high ", "lowmedium", "xyzzyxyzzy"}) {
    EXPECT_THAT(refusal(parse_choice("--quality", bad, words)), HasSubstr("low, medium, high"));
  }
  const LanguageScope scope(Language::chinese);
  EXPECT_THAT(refusal(parse_choice("--quality", "hihg", words)), HasSubstr("应为以下之一"));
}

TEST(Usage, ListsCountTheirEntriesAfterTheirUnits) {
  EXPECT_THAT(parse_list("--pos", "1, 20cm ,-30mm", Quantity::length, 3).value(),
              ElementsAre(1, 0.2, -0.03));
  EXPECT_THAT(parse_list("--pos", "1 2 3", Quantity::length, 3).value(), ElementsAre(1, 2, 3));
  const std::pair<const char*, const char*> bad[] = {
      {"", "--pos is missing"},
      {"1,2", "--pos: 3 values are needed, 2 are given"},
      {"1,2,3,4", "--pos: 3 values are needed, 4 are given"},
      {"1,,3", "--pos: "},
      {"1,2,3,", "--pos: "},
      {"1;2;3", "--pos: "},
      {"1,2,inf", "--pos: \"inf\" is not a finite number"},
      {"1,2,1e999", "--pos: "},
      {"1,2,3rad", "--pos: unknown unit \"rad\" in \"3rad\""},
      {"1,2,三", "--pos: \"三\" is not a number"}};
  for (const auto& [words, says] : bad) {
    EXPECT_THAT(refusal(parse_list("--pos", words, Quantity::length, 3)), StartsWith(says));
  }
}

/// A hinge and a slide.
Arm crane() {
  Arm arm;
  arm.name = "crane";
  arm.joints.resize(2);
  arm.joints[0].type = JointType::hinge;
  arm.joints[1].type = JointType::slide;
  return arm;
}

TEST(Usage, AJointIsReadInWhatItMoves) {
  const auto q = parse_joints("--q", "-90deg,25mm", crane());
  ASSERT_TRUE(q) << q.error().what;
  EXPECT_DOUBLE_EQ((*q)[0], -std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ((*q)[1], 0.025);
  EXPECT_THAT(refusal(parse_joints("--q", "25mm,25mm", crane())),
              HasSubstr("unknown unit \"mm\" in \"25mm\" (known here: rad, mrad, deg)"));
  EXPECT_THAT(refusal(parse_joints("--q", "1,90deg", crane())),
              HasSubstr("unknown unit \"deg\" in \"90deg\" (known here: m, cm, mm, um)"));
  EXPECT_EQ(refusal(parse_joints("--q", "1", crane())), "--q: 2 values are needed, 1 are given");
  EXPECT_THAT(refusal(parse_joints("--q", "", crane())), StartsWith("--q: "));
  EXPECT_THAT(refusal(parse_joints("--q", "nan,0", crane())), HasSubstr("not a finite number"));
}

TEST(Usage, SizesAreTwoWholeSides) {
  for (const char* good : {"1x1", "4096x4096", "8192x2048", "640X480", "0640x0480"}) {
    EXPECT_TRUE(parse_size("--size", good)) << good;
  }
  const PixelSize size = parse_size("--size", "640x480").value();
  EXPECT_EQ(size.width, 640);
  EXPECT_EQ(size.height, 480);
  for (const char* bad : {"", "x", "640", "640x", "x480", "640x0", "0x480", "8193x1", "1x8193",
                          "-640x480", "640x-480", "640 x 480", "640x480x3", "640*480", "640.5x480",
                          "640×480", "99999999999999999999x1"}) {
    EXPECT_EQ(refusal(parse_size("--size", bad)),
              "--size: \"" + std::string(bad) +
                  "\" is no size; width and height from 1 to 8192 are expected, as 1280x720");
  }
}

TEST(Usage, PicturesThatWouldTakeGigabytesAreRefused) {
  EXPECT_EQ(refusal(parse_size("--size", "8192x8192")),
            "--size: \"8192x8192\" has 67108864 pixels, at most 16777216 are drawn, as 4096x4096");
}

TEST(Usage, AnErrorKeepsItsKindInsideAnOption) {
  for (const Errc code : {Errc::usage, Errc::bad_input, Errc::impossible, Errc::system}) {
    const Error error = in_option("--q", {code, "no"});
    EXPECT_EQ(error.code, code);
    EXPECT_EQ(error.what, "--q: no");
  }
}

}  // namespace
}  // namespace mjarm::app
