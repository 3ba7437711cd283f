#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "mjarm/core/json.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/episode/options.hpp"

namespace mjarm::episode {

inline constexpr std::uint64_t kMaxNumber = 1'000'000'000;  ///< of an episode

/// Reads members of an object that nobody vouches for; the first that does not fit is kept.
class FieldReader {
 public:
  /// @param source  of the object, for messages; both outlive this.
  FieldReader(const JsonValue& object, const std::string& source)
      : object_(object), source_(source) {}

  std::uint64_t whole(const char* name, std::uint64_t most);
  std::string string(const char* name);
  bool boolean(const char* name);
  /// The members task, robot, seed, size and fps; check() has still to be asked.
  EpisodeOptions options();

  /// One line; empty where all fitted.
  [[nodiscard]] const std::string& fault() const { return fault_; }

 private:
  const JsonValue* member(const char* name, const char* kind,
                          bool (JsonValue::*is)() const noexcept);
  void miss(const char* name, const std::string& kind);

  const JsonValue& object_;
  const std::string& source_;
  std::string fault_;
};

}  // namespace mjarm::episode
