#pragma once

#include <string>
#include <string_view>

/// What the system calls of Windows take and give is UTF-16; all else in mjarm is UTF-8.
namespace mjarm {

[[nodiscard]] std::wstring utf16(std::string_view utf8);
[[nodiscard]] std::string utf8(std::wstring_view utf16);

/// What Windows says about error number `code` (GetLastError), in one line.
[[nodiscard]] std::string windows_message(unsigned long code);

}  // namespace mjarm
