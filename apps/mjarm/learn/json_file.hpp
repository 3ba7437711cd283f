#pragma once

#include <string>
#include <string_view>

#include "mjarm/core/json.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm::app {

/// Reads a file that is one JSON object, of a few MB at most.
/// @return an error that begins with `file:line:` where it is none.
[[nodiscard]] Result<JsonObject> read_json_file(const std::string& file);

/// Member `key` of `object`; 0 where there is no such number.
[[nodiscard]] double number_in(const JsonValue& object, std::string_view key);
/// The same of a string; empty where there is none.
[[nodiscard]] std::string word_in(const JsonValue& object, std::string_view key);

/// Puts `file: ` before an error about something in it.
[[nodiscard]] Error in_file(const std::string& file, const Error& error);

}  // namespace mjarm::app
