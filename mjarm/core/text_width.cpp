#include "mjarm/core/text_width.hpp"

namespace mjarm {

int text_width(std::string_view utf8) noexcept {
  int width = 0;
  for (const char c : utf8) {
    const auto byte = static_cast<unsigned char>(c);
    // Only lead bytes count. Three and four bytes begin at U+0800; of what mjarm prints there,
    // everything is two columns wide (Chinese, full-width punctuation).
    if (byte < 0x80 || (byte >= 0xC0 && byte < 0xE0)) width += 1;
    if (byte >= 0xE0) width += 2;
  }
  return width;
}

std::string padded(std::string_view text, int width) {
  std::string result(text);
  const int missing = width - text_width(text);
  if (missing > 0) result.append(static_cast<std::size_t>(missing), ' ');
  return result;
}

}  // namespace mjarm
