#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace mjarm {

/// Bytes of the UTF-8 character at the front of `text`, which is not empty; 0 where it is malformed
/// (cut off, overlong, half of a surrogate pair, beyond U+10FFFF).
[[nodiscard]] std::size_t utf8_length(std::string_view text) noexcept;

/// True where all of `text` is well-formed UTF-8.
[[nodiscard]] bool is_utf8(std::string_view text) noexcept;

/// `text` as a line that is safe to print: line breaks and tabs become spaces; other control
/// characters, which a terminal would obey, and bytes that are no UTF-8 become `\x1b` and the like.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace mjarm
