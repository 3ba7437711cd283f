#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mjarm/core/result.hpp"

namespace mjarm::episode {

/// What decides every byte of a data set. Every default is usable as is.
struct EpisodeOptions {
  std::string task = "pick_place";  ///< one of task_names()
  std::string robot = "panda";      ///< one of robot_names()
  std::uint64_t seed = 1;           ///< of all episodes; each has streams of its own
  int size = 128;                   ///< [px] of the square pictures, 16 to 1024
  int fps = 10;                     ///< [1/s] rows and pictures, 1 to 50

  [[nodiscard]] bool operator==(const EpisodeOptions&) const = default;
};

/// "reach", "pick_place", ...: docs/data.md says what each asks for.
[[nodiscard]] std::vector<std::string> task_names();
/// Those with a shipped scene for each task.
[[nodiscard]] std::vector<std::string> robot_names();

/// @return bad_input that names the option, and what there is to choose from.
[[nodiscard]] Result<void> check(const EpisodeOptions& options);

}  // namespace mjarm::episode
