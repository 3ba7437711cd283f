#include "mjarm/core/messages/episode.hpp"
#include "mjarm/episode/options_json_internal.hpp"

namespace mjarm::episode {

void FieldReader::miss(const char* name, const std::string& kind) {
  if (fault_.empty()) fault_ = text(msg::episode_field, source_, name, kind);
}

const JsonValue* FieldReader::member(const char* name, const char* kind,
                                     bool (JsonValue::*is)() const noexcept) {
  const JsonValue* value = object_.find(name);
  if (value != nullptr && (value->*is)()) return value;
  miss(name, kind);
  return nullptr;
}

std::uint64_t FieldReader::whole(const char* name, std::uint64_t most) {
  const JsonValue* value = object_.find(name);
  if (value != nullptr && value->is_whole() && value->whole() <= most) return value->whole();
  miss(name, "0..." + std::to_string(most));
  return 0;
}

std::string FieldReader::string(const char* name) {
  const JsonValue* value = member(name, "string", &JsonValue::is_string);
  return value != nullptr ? value->string() : std::string();
}

bool FieldReader::boolean(const char* name) {
  const JsonValue* value = member(name, "boolean", &JsonValue::is_boolean);
  return value != nullptr && value->boolean();
}

EpisodeOptions FieldReader::options() {
  constexpr std::uint64_t kMaxInt = std::numeric_limits<int>::max();
  EpisodeOptions out;
  out.task = string("task");
  out.robot = string("robot");
  out.seed = whole("seed", std::numeric_limits<std::uint64_t>::max());
  out.size = static_cast<int>(whole("size", kMaxInt));
  out.fps = static_cast<int>(whole("fps", kMaxInt));
  return out;
}

}  // namespace mjarm::episode
