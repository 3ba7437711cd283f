#include <array>
#include <filesystem>
#include <string>

#include "mjarm/core/os.hpp"
#include "mjarm/render/fonts_internal.hpp"

namespace mjarm::render {
namespace {

struct Font {
  const char* file;
  const char* family;
};

/// Windows has the first; the others come with older ones, with Office, or were installed by hand.
constexpr std::array<Font, 6> kFonts = {{{"msyh.ttc", "Microsoft YaHei"},
                                         {"Deng.ttf", "DengXian"},
                                         {"simhei.ttf", "SimHei"},
                                         {"simsun.ttc", "SimSun"},
                                         {"NotoSansSC-VF.ttf", "Noto Sans SC"},
                                         {"wqy-microhei.ttc", "WenQuanYi Micro Hei"}}};

}  // namespace

std::string find_chinese_font() {
  const std::filesystem::path folder =
      std::filesystem::path(environment("WINDIR").value_or("C:\\Windows")) / "Fonts";
  for (const Font& font : kFonts) {
    std::error_code ignored;
    if (std::filesystem::is_regular_file(folder / font.file, ignored)) return font.family;
  }
  return {};
}

}  // namespace mjarm::render
