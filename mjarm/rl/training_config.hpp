#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/rl/tensor_set.hpp"
#include "mjarm/rl/training.hpp"

namespace mjarm::rl {

/// A training as YAML: sections `task`, `reward`, `ppo` and `training`, each with the names of the
/// fields of the options it sets. What is left out keeps what `options` holds. Numbers are read in
/// full and must be in their ranges, those on the fields of the options.
/// @param name  of the file, for messages.
/// @return bad_input with file, line and column, and the nearest right word.
[[nodiscard]] Result<TrainingOptions> read_config(const std::string& yaml, const std::string& name,
                                                  TrainingOptions options = {});
/// The same from a file of at most 1 MiB.
[[nodiscard]] Result<TrainingOptions> load_config(const std::filesystem::path& file);
/// All options as such a file, with every number in full: `read_config` gives them back.
[[nodiscard]] std::string config_text(const TrainingOptions& options);

/// The configuration that a checkpoint of `Training` was made with.
/// @return bad_input where it holds none.
[[nodiscard]] Result<TrainingOptions> config_of_checkpoint(const std::filesystem::path& file);
/// The same where it is already read; none where it holds none, as those of others.
/// @param file  for messages.
[[nodiscard]] Result<std::optional<TrainingOptions>> config_in(const TensorSet& checkpoint,
                                                               const std::filesystem::path& file);

}  // namespace mjarm::rl
