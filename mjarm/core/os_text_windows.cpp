#include <windows.h>

#include <cstring>
#include <cwchar>
#include <utility>

#include "mjarm/core/os_text_internal.hpp"

namespace mjarm {

std::wstring utf16(std::string_view utf8) {
  const int size = static_cast<int>(utf8.size());
  std::wstring out(utf8.size(), L'\0');  // never more units than bytes
  out.resize(static_cast<std::size_t>(
      MultiByteToWideChar(CP_UTF8, 0, utf8.data(), size, out.data(), size)));
  return out;
}

std::string utf8(std::wstring_view utf16) {
  const int size = static_cast<int>(utf16.size());
  std::string out(3 * utf16.size(), '\0');  // never more bytes than that
  out.resize(static_cast<std::size_t>(
      WideCharToMultiByte(CP_UTF8, 0, utf16.data(), size, out.data(), 3 * size, nullptr, nullptr)));
  return out;
}

std::string windows_message(unsigned long code) {
  wchar_t words[512];
  const DWORD length =
      FormatMessageW(FORMAT_MESSAGE_FROM_SYSTEM | FORMAT_MESSAGE_IGNORE_INSERTS, nullptr, code, 0,
                     static_cast<wchar_t*>(words), std::size(words), nullptr);
  std::string line = utf8({static_cast<wchar_t*>(words), length});
  while (!line.empty() && (line.back() == '\n' || line.back() == '\r' || line.back() == '.')) {
    line.pop_back();
  }
  return line.empty() ? "error " + std::to_string(code) : line;
}

}  // namespace mjarm

#if defined(__MINGW32__)
// std::filesystem of MinGW-w64 makes paths of narrow strings by these functions of C, and those of
// its C library know no UTF-8; programs that hold this file have its own in their place.
// (Microsoft's library takes the code page of the manifest, which is UTF-8.)
namespace {

constexpr wchar_t kUnknown = 0xFFFD;

/// Number of bytes that a first byte announces; 0 where it cannot be one.
std::size_t bytes_of(unsigned char first) {
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first < 0xE0) return 2;
  if (first >= 0xE0 && first < 0xF0) return 3;
  return first >= 0xF0 && first < 0xF5 ? 4 : 0;
}

/// The character that begins there; 0x110000, which is none, where the bytes are no UTF-8.
unsigned decode(const char* from, std::size_t bytes) {
  constexpr unsigned kNone = 0x110000;
  constexpr unsigned kSmallest[] = {0, 0, 0x80, 0x800, 0x10000};
  unsigned code = static_cast<unsigned char>(from[0]);
  if (bytes > 1) code &= 0x7FU >> bytes;
  for (std::size_t i = 1; i < bytes; ++i) {
    const auto byte = static_cast<unsigned char>(from[i]);
    if ((byte & 0xC0U) != 0x80U) return kNone;
    code = (code << 6) | (byte & 0x3FU);
  }
  const bool surrogate = code >= 0xD800 && code < 0xE000;
  return code < kSmallest[bytes] || surrogate ? kNone : code;
}

}  // namespace

extern "C" {

/// A character beyond the first plane is two units: the first comes with its first three bytes, the
/// second, kept in `state`, with the last. What is no UTF-8 becomes U+FFFD byte by byte: a path of
/// it is not found, where an error would be thrown.
std::size_t mbrtowc(wchar_t* to, const char* from, std::size_t count, std::mbstate_t* state) {
  static std::mbstate_t own{};
  std::mbstate_t& kept = state != nullptr ? *state : own;
  if (from == nullptr) return kept = 0;
  if (count == 0) return static_cast<std::size_t>(-2);
  wchar_t ignored = 0;
  wchar_t& out = to != nullptr ? *to : ignored;
  if (kept != 0) {
    out = static_cast<wchar_t>(std::exchange(kept, 0));
    return 1;
  }
  const std::size_t bytes = bytes_of(static_cast<unsigned char>(*from));
  const unsigned code = bytes == 0 || bytes > count ? 0x110000 : decode(from, bytes);
  if (code >= 0x110000) {
    out = kUnknown;
    return 1;
  }
  if (code >= 0x10000) {
    out = static_cast<wchar_t>(0xD7C0 + (code >> 10));
    kept = static_cast<std::mbstate_t>(0xDC00 + (code & 0x3FF));
    return 3;
  }
  out = static_cast<wchar_t>(code);
  return code == 0 ? 0 : bytes;
}

std::size_t mbrlen(const char* from, std::size_t count, std::mbstate_t* state) {
  static std::mbstate_t own{};
  return mbrtowc(nullptr, from, count, state != nullptr ? state : &own);
}

std::size_t mbsrtowcs(wchar_t* to, const char** from, std::size_t count, std::mbstate_t* state) {
  std::mbstate_t own{};
  std::size_t done = 0;
  const char* at = *from;
  for (; to == nullptr || done < count; ++done) {
    const std::size_t used = mbrtowc(to != nullptr ? to + done : nullptr, at, std::strlen(at) + 1,
                                     state != nullptr ? state : &own);
    if (used == 0) {
      at = nullptr;
      break;
    }
    at += used;
  }
  if (to != nullptr) *from = at;
  return done;
}

}  // extern "C"
#endif
