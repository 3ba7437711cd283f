#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "mjarm/clone/observation.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/episode/options.hpp"

namespace mjarm::clone {

/// One row of an episode as a policy would have seen it, and what was done.
struct Shown {
  Observed seen;
  Answer answer;
};

/// The rows of all episodes of a folder that succeeded.
struct Demonstrated {
  episode::EpisodeOptions options;     ///< that all were made with
  std::vector<std::uint64_t> numbers;  ///< of the episodes, in order
  std::vector<Shown> rows;
};

/// Reads what `mjarm record` wrote, one episode at a time.
/// @param most  episodes, the first ones; 0: all.
/// @return bad_input with the file where one is damaged, of another model, or there is none.
[[nodiscard]] Result<Demonstrated> read_demonstrated(const std::filesystem::path& folder,
                                                     std::size_t most, const StopCheck& stop = {});

/// The same row with the tool beside its way, by up to some 2 cm and 0.1 rad, and with it what it
/// holds; the answer still leads to where the demonstration went: so a policy learns to come back.
[[nodiscard]] Shown blurred(Shown row, Rng& rng);

}  // namespace mjarm::clone
