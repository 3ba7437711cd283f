#pragma once

#include <string_view>
#include <vector>

namespace mjarm {

/// The numbers at the front of an attribute, parted by white space; what follows something else is
/// left.
[[nodiscard]] std::vector<double> numbers_in(std::string_view words);

}  // namespace mjarm
