#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mjarm {

/// `words` as one field of a CSV table (RFC 4180): quoted where it has commas, quotes or breaks.
[[nodiscard]] std::string csv_field(const std::string& words);

/// The fields of one line of a CSV table, without their quotes and the blanks round them; a byte
/// order mark at the beginning, as spreadsheets write it, is passed over. No field goes on over a
/// line break.
[[nodiscard]] std::vector<std::string> csv_fields(std::string_view line);

}  // namespace mjarm
