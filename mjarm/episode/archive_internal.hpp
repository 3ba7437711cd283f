#pragma once

#include <string>

#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/stored_zip.hpp"
#include "mjarm/episode/demonstrate_internal.hpp"

namespace mjarm::episode {

/// What `episode.json` says of itself; another number where its meaning changes.
inline constexpr const char* kSchema = "mjarm.episode/1";

/// Task of episodes that somebody made by leading an arm.
inline constexpr const char* kLedTask = "teleop";

/// What was made, and by what.
struct Origin {
  EpisodeOptions options;
  std::uint64_t number = 0;
  std::string model_hash;
};

/// Of the compiled scene: MuJoCo's own binary of it, so its version counts as well.
[[nodiscard]] Result<std::string> hash_of_model(const Model& model);

/// `episode.json`.
[[nodiscard]] std::string episode_json(const Robot& robot, const Origin& origin, const Task& task,
                                       const Demonstration& done);

/// Every column as `NAME.npy`, one row a sample.
void add_columns(const Demonstration& done, StoredZipWriter& out);

/// Names, units and meaning of the columns, in the order in which they are added.
[[nodiscard]] JsonDoc columns_doc();

}  // namespace mjarm::episode
