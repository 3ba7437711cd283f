#include "apps/mjarm/learn/json_file.hpp"

#include <algorithm>

#include "mjarm/core/file.hpp"
#include "mjarm/core/messages/core.hpp"

namespace mjarm::app {
namespace {

constexpr std::size_t kMaxExerciseBytes = std::size_t{1} << 24;

/// As a reader's editor counts: the line, and the column in it.
std::string line_at(const std::string& content, JsonFailure& failure) {
  if (failure.byte == 0) return "";
  const std::size_t byte = std::min(failure.byte - 1, content.size());
  const std::string_view before = std::string_view(content).substr(0, byte);
  const auto line = 1 + std::ranges::count(before, '\n');
  if (const std::size_t end = before.rfind('\n'); end != std::string_view::npos) {
    failure.byte -= end + 1;
  }
  return ":" + std::to_string(line);
}

}  // namespace

Result<JsonObject> read_json_file(const std::string& file) {
  const Result<std::string> content = read_file(file, kMaxExerciseBytes);
  if (!content) return fail(content.error());
  Result<JsonObject, JsonFailure> object = JsonObject::parse(*content, {.bytes = content->size()});
  if (object) return std::move(*object);
  JsonFailure failure = object.error();
  const std::string line = line_at(*content, failure);
  return fail(Errc::bad_input, text(msg::core_at_place, file + line, describe(failure)));
}

double number_in(const JsonValue& object, std::string_view key) {
  const JsonValue* const value = object.find(key);
  return value == nullptr ? 0 : value->number();
}

std::string word_in(const JsonValue& object, std::string_view key) {
  const JsonValue* const value = object.find(key);
  return value == nullptr ? std::string() : value->string();
}

Error in_file(const std::string& file, const Error& error) {
  return {error.code, text(msg::core_at_place, file, error.what)};
}

}  // namespace mjarm::app
