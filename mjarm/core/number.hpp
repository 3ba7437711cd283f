#pragma once

#include <span>
#include <string>
#include <string_view>

namespace mjarm {

/// Appends `value` to `out` with the fewest digits that read back as the same double, always marked
/// as a real number (`1.0`, `0.1`, `1e-07`); the same bytes on every machine and in every locale.
/// JSON knows no NaN and no infinity: both become `null`.
void append_number(std::string& out, double value);

/// Appends `[a,b,...]`.
void append_numbers(std::string& out, std::span<const double> values);

/// `value` as `append_number` writes it.
[[nodiscard]] std::string number(double value);

/// Appends `text` as a JSON string with its quotes; bytes that are no UTF-8 become U+FFFD.
void append_json_string(std::string& out, std::string_view text);

}  // namespace mjarm
