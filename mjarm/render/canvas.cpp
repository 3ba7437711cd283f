#include <cstdint>

#include "mjarm/render/canvas_internal.hpp"

namespace mjarm::canvas {
namespace {

struct Letter {
  std::uint32_t code = 0xFFFD;  ///< U+FFFD where the bytes are no UTF-8
  std::size_t bytes = 1;
};

/// The first letter of a text that is not empty.
Letter first_letter(std::string_view text) {
  const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char head = byte(0);
  if (head < 0x80) return {head, 1};
  const std::size_t length = head >= 0xF0 ? 4 : head >= 0xE0 ? 3 : head >= 0xC2 ? 2 : 0;
  if (length == 0 || head > 0xF4 || text.size() < length) return {};
  std::uint32_t code = head & (0x7FU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return {};
    code = (code << 6U) | (byte(i) & 0x3FU);
  }
  constexpr std::uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  if (code < kLeast[length] || code > 0x10FFFF || surrogate) return {};
  return {code, length};
}

/// Blocks of East Asian characters, punctuation and full-width forms.
bool is_cjk(std::uint32_t code) {
  return (code >= 0x2E80 && code <= 0x9FFF) || (code >= 0xAC00 && code <= 0xD7AF) ||
         (code >= 0xF900 && code <= 0xFAFF) || (code >= 0xFE30 && code <= 0xFE4F) ||
         (code >= 0xFF00 && code <= 0xFFEF) || (code >= 0x20000 && code <= 0x3FFFF);
}

}  // namespace

std::vector<Run> runs_of(std::string_view text) {
  std::vector<Run> runs;
  while (!text.empty()) {
    const Letter letter = first_letter(text);
    const bool cjk = is_cjk(letter.code);
    if (runs.empty() || runs.back().cjk != cjk) runs.push_back({{}, cjk});
    runs.back().text +=
        letter.code == 0xFFFD ? std::string_view("\xEF\xBF\xBD") : text.substr(0, letter.bytes);
    text.remove_prefix(letter.bytes);
  }
  return runs;
}

}  // namespace mjarm::canvas
