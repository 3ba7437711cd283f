#pragma once

#include <cstdio>
#include <filesystem>

namespace mjarm {

/// std::fopen for any path, also one of characters that the system's narrow strings do not have.
/// @param mode  "rb", "wb", "ab", or "wbx" for a file that must not exist.
/// @return null where it cannot be opened; errno says why.
[[nodiscard]] std::FILE* open_file(const std::filesystem::path& path, const char* mode) noexcept;

}  // namespace mjarm
