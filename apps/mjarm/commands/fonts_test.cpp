// Plots on a machine with and without a Chinese font; fontconfig is shown a folder of its own.
#include "mjarm/render/fonts.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "apps/mjarm/commands/program_test.hpp"
#include "mjarm/core/file.hpp"

namespace mjarm::app {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Chinese characters, as UTF-8 begins them; signs such as a minus are not any.
bool has_chinese_letters(const std::string& text) {
  return std::ranges::any_of(text, [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte >= 0xE4 && byte <= 0xE9;
  });
}

class Fonts : public ::testing::Test {
 protected:
  /// Runs `mjarm` where fontconfig knows the fonts of one folder only.
  support::ProgramResult run(const std::string& fonts, std::vector<std::string> arguments) {
    const std::string config =
        folder_
            .write("fonts.conf", "<?xml version=\"1.0\"?><fontconfig><dir>" + fonts +
                                     "</dir><cachedir>" + folder_.path().string() +
                                     "</cachedir></fontconfig>")
            .string();
    return mjarm(arguments, {.environment = {{"FONTCONFIG_FILE", config}}});
  }
  std::string svg() { return read_file(folder_.path() / "map.svg").value_or(""); }
  std::vector<std::string> map(const std::string& language) {
    return {"workspace", "--robot", "ur5e",  "--slice",
            "z=0.4",     "--step",  "150mm", "--position-only",
            "--lang",    language,  "--out", (folder_.path() / "map.svg").string()};
  }

  support::TempFolder folder_;
};

constexpr const char* kLatinFonts = "/usr/share/fonts/truetype/dejavu";
constexpr const char* kAllFonts = "/usr/share/fonts";

TEST_F(Fonts, WithoutChineseOnesPlotsAreEnglishAndOneLineSaysSo) {
  const auto chinese = run(kLatinFonts, map("zh-CN"));
  EXPECT_EQ(chinese.exit_code, 0) << chinese.err;
  EXPECT_THAT(chinese.err, HasSubstr("fonts-wqy-microhei"));
  EXPECT_EQ(chinese.err.find("fonts-wqy-microhei"), chinese.err.rfind("fonts-wqy-microhei"));
  EXPECT_TRUE(has_chinese_letters(chinese.out + chinese.err)) << "the terminal stays Chinese";
  const std::string drawn = svg();
  EXPECT_THAT(drawn, HasSubstr("manipulability"));
  EXPECT_FALSE(has_chinese_letters(drawn));
  const auto english = run(kLatinFonts, map("en"));
  EXPECT_THAT(english.err, Not(HasSubstr("fonts-")));
  EXPECT_EQ(svg(), drawn);
}

TEST_F(Fonts, WithThemPlotsAreChinese) {
  if (render::chinese_font().empty()) GTEST_SKIP() << "no Chinese font (fonts-wqy-microhei)";
  const auto result = run(kAllFonts, map("zh-CN"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, Not(HasSubstr("fonts-wqy-microhei")));
  EXPECT_TRUE(has_chinese_letters(svg()));
}

TEST_F(Fonts, TheDoctorLooksForThem) {
  const auto without = run(kLatinFonts, {"doctor", "--lang", "zh-CN"});
  EXPECT_EQ(without.exit_code, 0) << without.err;
  EXPECT_THAT(without.out, HasSubstr("apt-get install fonts-wqy-microhei"));
  EXPECT_THAT(without.out, Not(HasSubstr("所需一切齐备"))) << "not for who reads Chinese";
  const auto english = run(kLatinFonts, {"doctor"});
  EXPECT_THAT(english.out, HasSubstr("Everything that is needed is here."));
  EXPECT_EQ(nlohmann::json::parse(run(kLatinFonts, {"doctor", "--json"}).out).at("chinese_font"),
            "");
  if (render::chinese_font().empty()) GTEST_SKIP() << "no Chinese font (fonts-wqy-microhei)";
  const auto with = run(kAllFonts, {"doctor", "--lang", "zh-CN"});
  EXPECT_THAT(with.out, HasSubstr("所需一切齐备"));
  EXPECT_THAT(with.out, Not(HasSubstr("fonts-wqy-microhei")));
}

}  // namespace
}  // namespace mjarm::app
