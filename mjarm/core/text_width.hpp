#pragma once

#include <string>
#include <string_view>

namespace mjarm {

/// Columns that UTF-8 text takes on a terminal: Chinese characters and full-width signs count two.
[[nodiscard]] int text_width(std::string_view utf8) noexcept;

/// `text` with blanks behind it until it is `width` columns wide.
[[nodiscard]] std::string padded(std::string_view text, int width);

}  // namespace mjarm
