#include <fontconfig/fontconfig.h>

#include <memory>

#include "mjarm/render/fonts_internal.hpp"

namespace mjarm::render {
namespace {

/// Simplified characters and a full-width sign, all in the catalogue: a font for Japanese or
/// traditional Chinese, which would leave boxes, lacks some of them.
constexpr char32_t kNeededLetters[] = U"中文规划误差关节轨迹实际力矩，（）";

using CharSet = std::unique_ptr<FcCharSet, decltype(&FcCharSetDestroy)>;
using Pattern = std::unique_ptr<FcPattern, decltype(&FcPatternDestroy)>;
using FontSet = std::unique_ptr<FcFontSet, decltype(&FcFontSetDestroy)>;

const FcChar8* fc_text(const char* text) { return reinterpret_cast<const FcChar8*>(text); }

}  // namespace

std::string find_chinese_font() {
  const CharSet needed(FcCharSetCreate(), FcCharSetDestroy);
  for (const char32_t letter : kNeededLetters) {
    if (letter != 0) FcCharSetAddChar(needed.get(), letter);
  }
  const Pattern wanted(FcPatternCreate(), FcPatternDestroy);
  FcPatternAddString(wanted.get(), FC_FAMILY, fc_text("sans-serif"));
  FcPatternAddString(wanted.get(), FC_LANG, fc_text("zh-cn"));
  FcPatternAddBool(wanted.get(), FC_SCALABLE, FcTrue);
  FcConfigSubstitute(nullptr, wanted.get(), FcMatchPattern);
  FcDefaultSubstitute(wanted.get());
  FcResult result = FcResultNoMatch;
  const FontSet sorted(FcFontSort(nullptr, wanted.get(), FcTrue, nullptr, &result),
                       FcFontSetDestroy);
  for (int i = 0; sorted && i < sorted->nfont; ++i) {
    FcCharSet* letters = nullptr;
    FcChar8* family = nullptr;
    if (FcPatternGetCharSet(sorted->fonts[i], FC_CHARSET, 0, &letters) == FcResultMatch &&
        FcPatternGetString(sorted->fonts[i], FC_FAMILY, 0, &family) == FcResultMatch &&
        FcCharSetIsSubset(needed.get(), letters) == FcTrue) {
      return reinterpret_cast<const char*>(family);
    }
  }
  return {};
}

}  // namespace mjarm::render
