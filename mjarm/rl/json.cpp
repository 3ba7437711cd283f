#include "mjarm/core/messages/policy_file.hpp"
#include "mjarm/rl/json_internal.hpp"

namespace mjarm::rl {

Result<JsonObject> parse_json_object(std::string_view text_of_it, int max_depth,
                                     const std::string& source, const std::string& part) {
  Result<JsonObject, JsonFailure> parsed =
      JsonObject::parse(text_of_it, {.depth = max_depth, .unique_keys = true});
  if (parsed) return std::move(*parsed);
  const JsonFailure& failure = parsed.error();
  switch (failure.code) {
    case JsonErrc::too_deep:
      return fail(Errc::bad_input, text(msg::policy_file_json_deep, source, part, max_depth));
    case JsonErrc::key_twice:
      return fail(Errc::bad_input,
                  text(msg::policy_file_json_twice, source, part, in_quotes(failure.key)));
    case JsonErrc::no_object:
      return fail(Errc::bad_input, text(msg::policy_file_json_object, source, part));
    case JsonErrc::syntax:
      return fail(Errc::bad_input, text(msg::policy_file_json_bad, source, part, failure.byte));
    default:
      return fail(Errc::bad_input, text(msg::policy_file_json_bad, source, part, 0));
  }
}

}  // namespace mjarm::rl
