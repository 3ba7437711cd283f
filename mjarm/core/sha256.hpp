#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "mjarm/core/result.hpp"

namespace mjarm {

/// SHA-256 of `content`, as 64 lower-case hexadecimal digits.
[[nodiscard]] std::string sha256(std::string_view content);

/// The same as 32 bytes.
[[nodiscard]] std::string sha256_bytes(std::string_view content);

/// SHA-256 of a file. @return an error that names the file.
[[nodiscard]] Result<std::string> sha256_of_file(const std::filesystem::path& file);

}  // namespace mjarm
