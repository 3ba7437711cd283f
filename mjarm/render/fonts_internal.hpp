#pragma once

#include <string>

namespace mjarm::render {

/// As `chinese_font`, looked up anew.
[[nodiscard]] std::string find_chinese_font();

}  // namespace mjarm::render
