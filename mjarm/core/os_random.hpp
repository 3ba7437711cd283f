#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "mjarm/core/result.hpp"

namespace mjarm {

/// Random bytes of the operating system, fit for secrets, as lower-case hexadecimal digits, two a
/// byte. For nothing that should be the same twice.
/// @param bytes  1 to 256.
/// @return system where the system has none.
[[nodiscard]] Result<std::string> secret_hex(std::size_t bytes);

/// Whether two texts are equal, in a time that does not tell where they differ.
[[nodiscard]] bool equal_in_constant_time(std::string_view a, std::string_view b) noexcept;

}  // namespace mjarm
