// Fonts for Chinese: what fontconfig is asked for, and what is drawn.
#include "mjarm/render/fonts.hpp"

#include <fontconfig/fontconfig.h>
#include <gtest/gtest.h>

#include <memory>
#include <numeric>

#include "mjarm/render/canvas_internal.hpp"
#include "mjarm/render/glyph.hpp"

namespace mjarm::render {
namespace {

constexpr Msg kDrawnMessages[] = {
#define MJARM_MSG(id, english, chinese) {english, chinese},
#include "mjarm/core/messages/panels.inc"
#include "mjarm/core/messages/run_charts.inc"
#include "mjarm/core/messages/show.inc"
#include "mjarm/core/messages/target.inc"
#include "mjarm/core/messages/view.inc"
#undef MJARM_MSG
};

/// Whether fontconfig knows a font of that family with this letter (UTF-8).
bool has_letter(const std::string& family, const std::string& letter) {
  FcChar32 code = 0;
  FcUtf8ToUcs4(reinterpret_cast<const FcChar8*>(letter.c_str()), &code,
               static_cast<int>(letter.size()));
  const std::unique_ptr<FcPattern, decltype(&FcPatternDestroy)> pattern(FcPatternCreate(),
                                                                        FcPatternDestroy);
  const std::unique_ptr<FcCharSet, decltype(&FcCharSetDestroy)> letters(FcCharSetCreate(),
                                                                        FcCharSetDestroy);
  FcPatternAddString(pattern.get(), FC_FAMILY, reinterpret_cast<const FcChar8*>(family.c_str()));
  FcCharSetAddChar(letters.get(), code);
  FcPatternAddCharSet(pattern.get(), FC_CHARSET, letters.get());
  const std::unique_ptr<FcFontSet, decltype(&FcFontSetDestroy)> found(
      FcFontList(nullptr, pattern.get(), nullptr), FcFontSetDestroy);
  return found && found->nfont > 0;
}

double ink_of(const Glyph& glyph) {
  return std::accumulate(glyph.ink.begin(), glyph.ink.end(), 0.0) / 255;
}

class ChineseFont : public ::testing::Test {
 protected:
  void SetUp() override {
    if (chinese_font().empty()) GTEST_SKIP() << "no Chinese font (fonts-wqy-microhei)";
  }
};

/// The few letters that are asked for stand for all that plots and windows say.
TEST_F(ChineseFont, HasEveryLetterOfPlotsAndWindows) {
  for (const Msg& message : kDrawnMessages) {
    for (const canvas::Run& run : canvas::runs_of(message.chinese)) {
      if (!run.cjk) continue;
      for (const std::string& letter : letters_of(run.text)) {
        EXPECT_TRUE(has_letter(chinese_font(), letter)) << letter << " in " << message.chinese;
      }
    }
  }
}

/// Chinese letters are full-width: all equally wide, about twice a Latin one, and none is the box
/// that stands for a letter no font has.
TEST_F(ChineseFont, DrawsFullWidthLetters) {
  const Glyph box = draw_glyph("\xF3\xBF\xBF\xBD", 20);  // no character
  std::vector<std::vector<std::uint8_t>> seen;
  for (const char* letter : {"关", "节", "误", "差", "，", "（"}) {
    const Glyph glyph = draw_glyph(letter, 20);
    EXPECT_NEAR(glyph.advance, 20, 1) << letter;
    EXPECT_GT(ink_of(glyph), 5) << letter;
    EXPECT_NE(glyph.ink, box.ink) << letter;
    for (const auto& other : seen) EXPECT_NE(glyph.ink, other) << letter;
    seen.push_back(glyph.ink);
  }
  EXPECT_NEAR(draw_glyph("a", 20).advance, 12, 2);
}

/// Rows run upwards from `bottom`: a comma's ink is low, a quotation mark's is high.
TEST(Glyphs, StandOnTheirBaseLine) {
  const auto middle = [](const Glyph& glyph) {
    double sum = 0, moment = 0;
    for (int y = 0; y < glyph.height; ++y) {
      for (int x = 0; x < glyph.width; ++x) {
        const double ink = glyph.ink[static_cast<std::size_t>(y * glyph.width + x)];
        sum += ink;
        moment += ink * (glyph.bottom + y + 0.5);
      }
    }
    return moment / sum;
  };
  EXPECT_NEAR(middle(draw_glyph(".", 20)), 1.2, 1);
  EXPECT_NEAR(middle(draw_glyph("-", 20)), 6, 2);
  EXPECT_GT(middle(draw_glyph("'", 20)), 11);
  EXPECT_LT(middle(draw_glyph("_", 20)), -1);
}

TEST(Glyphs, LettersOfAnyBytesAreWhole) {
  const std::vector<std::string> expected = {"a", "误", "\xEF\xBF\xBD", "b"};
  EXPECT_EQ(letters_of("a误\xFF"
                       "b"),
            expected);
  EXPECT_TRUE(letters_of("").empty());
}

}  // namespace
}  // namespace mjarm::render
