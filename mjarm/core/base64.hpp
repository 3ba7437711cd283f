#pragma once

#include <string>
#include <string_view>

namespace mjarm {

/// Bytes as letters, digits, `+` and `/`, filled up with `=` (RFC 4648, section 4), without breaks.
[[nodiscard]] std::string base64(std::string_view bytes);

}  // namespace mjarm
