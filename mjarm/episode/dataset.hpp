#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "mjarm/core/ranks.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/episode/options.hpp"
#include "mjarm/episode/record.hpp"

namespace mjarm::episode {

/// A folder of episodes: `episode_NNNNNN.zip` those that succeeded, `failed/` those that did not,
/// `dataset.json` what all have in common.
struct DatasetOptions {
  EpisodeOptions episode = {};
  std::uint64_t first = 0;      ///< number of the first episode
  std::uint64_t episodes = 10;  ///< numbers `first` and on; at least 1
  int processes = 1;            ///< episodes that are made at the same time, >= 1
  /// Processes that fill the folder together, on one machine or over a file system that all share:
  /// each makes every size()-th episode. Null: this one alone. Outlives the call.
  Ranks* ranks = nullptr;
  StopCheck stop = {};
  /// Called after each episode that was written, from one thread at a time. May be empty.
  std::function<void(const Episode& episode)> after_episode = {};
};

/// What was done, by all ranks together.
struct DatasetOutcome {
  std::uint64_t made = 0;       ///< in this call
  std::uint64_t found = 0;      ///< that were there before
  std::uint64_t succeeded = 0;  ///< of all there are now
  std::uint64_t failed = 0;     ///< likewise
  bool stopped = false;         ///< before all were made
  EpisodeTimes times;           ///< of those made, summed over all threads
};

/// Makes the episodes that a folder does not hold yet. Each is written in one step, so whatever
/// ends this, those that were written are whole and the next call goes on. Bytes of all files are
/// the same however many are made at once, and whatever stopped in between.
/// @return usage where the folder was made with other options, naming the first; impossible where
///         another process works in it; else fails as Studio does.
[[nodiscard]] Result<DatasetOutcome> record_dataset(const std::filesystem::path& folder,
                                                    const DatasetOptions& options);

}  // namespace mjarm::episode
