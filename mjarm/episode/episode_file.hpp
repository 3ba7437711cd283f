#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/episode/options.hpp"
#include "mjarm/episode/record.hpp"

namespace mjarm::episode {

/// What an archive says of itself, read from `episode.json`.
struct EpisodeHead {
  EpisodeOptions options;
  std::uint64_t number = 0;
  bool success = false;
  std::string reason;  ///< Verdict::reason
  std::string model_hash;
};

/// An episode as it stands on disk.
struct EpisodeFile {
  EpisodeHead head;
  std::string bytes;
};

/// Reads an archive and checks what it is made again from. Takes time and memory in proportion to
/// its size, of at most 1 GiB: nothing in it is unpacked.
/// @return bad_input with the file and what was expected there.
[[nodiscard]] Result<EpisodeFile> read_episode(const std::filesystem::path& file);

/// "episode_000042.zip".
[[nodiscard]] std::string episode_name(std::uint64_t number);

/// The episodes that lie in a folder itself, by number; empty where there are none.
[[nodiscard]] std::vector<std::filesystem::path> succeeded_files(
    const std::filesystem::path& folder);

/// Those in `failed` in it.
[[nodiscard]] std::vector<std::filesystem::path> failed_files(const std::filesystem::path& folder);

/// Both together, by number.
[[nodiscard]] std::vector<std::filesystem::path> episode_files(const std::filesystem::path& folder);

/// Where two archives differ: "qpos.npy, byte 1234" (from 1), the name of an entry that only one of
/// them has, "archive" where all entries are the same; empty where all bytes are.
[[nodiscard]] Result<std::string> first_difference(std::string_view kept, std::string_view made,
                                                   const std::string& source);

/// Makes an episode again with a studio of its options.
/// @return first_difference(); bad_input where `file` is of another model.
[[nodiscard]] Result<std::string> replay(Studio& studio, const EpisodeFile& file,
                                         const std::string& source, const StopCheck& stop = {});

}  // namespace mjarm::episode
