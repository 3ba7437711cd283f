#pragma once

#include <string>
#include <string_view>

#include "mjarm/core/number.hpp"

namespace mjarm {

/// `name` in double quotes, on one line, cut where it is long: for messages.
[[nodiscard]] inline std::string in_quotes(std::string_view name) {
  constexpr std::size_t kLongest = 80;
  std::string out;
  append_json_string(out, name.substr(0, kLongest));
  if (name.size() > kLongest) out += "...";
  return out;
}

}  // namespace mjarm
