#pragma once

#include <string>
#include <string_view>

#include "mjarm/core/in_quotes.hpp"
#include "mjarm/core/json.hpp"

namespace mjarm::rl {

/// Parses a JSON object of a file that nobody vouches for.
/// @param part  what is parsed, for messages.
/// @return an error that names `source` and `part` where it is malformed, is no object, nests
///         deeper than `max_depth` or names a key of an object twice.
[[nodiscard]] Result<JsonObject> parse_json_object(std::string_view text, int max_depth,
                                                   const std::string& source,
                                                   const std::string& part);

}  // namespace mjarm::rl
