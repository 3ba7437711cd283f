#pragma once

#include <string_view>

namespace mjarm {

/// `words` without the characters of `blanks` at both ends.
[[nodiscard]] std::string_view trimmed(std::string_view words,
                                       std::string_view blanks = " \t\r\n") noexcept;

}  // namespace mjarm
