#pragma once

#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/rl/training.hpp"

namespace mjarm::app {

/// A training as YAML: sections `task`, `reward`, `ppo` and `training`, each with the names of the
/// fields of the options it sets. What is left out keeps what `options` holds.
/// @param name  of the file, for messages.
/// @return an error with file, line and column, and the nearest right word.
[[nodiscard]] Result<rl::TrainingOptions> read_config(const std::string& yaml,
                                                      const std::string& name,
                                                      rl::TrainingOptions options = {});

/// All options as such a file, with every number in full: `read_config` gives them back.
[[nodiscard]] std::string config_text(const rl::TrainingOptions& options);

}  // namespace mjarm::app
