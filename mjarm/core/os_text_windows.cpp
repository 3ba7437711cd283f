#include <windows.h>

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
