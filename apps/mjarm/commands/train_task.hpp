#pragma once

#include <string>

#include "apps/mjarm/cli/options.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/rl/training.hpp"

namespace mjarm::app {

/// Which task, as it stands on the command line.
struct TaskArguments {
  std::string task = {}, region = {}, seed = {}, threads = {};
  bool orientation = false, obstacle = false, guide = false;
};

/// Adds the argument TASK.
void add_task_argument(CLI::App& app, TaskArguments& arguments);
/// Adds `--region`, `--orientation`, `--obstacle`, `--guide`, `--seed` and `--threads`.
void add_task_options(CLI::App& app, TaskArguments& arguments);

/// `options` with what the command line says of the task; as many threads as there are cores, but
/// for what it says.
/// @return a usage error that names the word that is wrong, and the nearest right one.
[[nodiscard]] Result<rl::TrainingOptions> with_task(const TaskArguments& arguments,
                                                    rl::TrainingOptions options);

}  // namespace mjarm::app
