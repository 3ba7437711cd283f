#include "apps/mjarm/commands/train_task.hpp"

#include <array>

#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/messages/train.hpp"
#include "mjarm/core/nearest_word.hpp"

namespace mjarm::app {

void add_task_argument(CLI::App& app, TaskArguments& arguments) {
  add_option(app, "task", arguments.task, msg::train_option_task, "reach");
}

void add_task_options(CLI::App& app, TaskArguments& arguments) {
  add_option(app, "--region", arguments.region, msg::train_option_region, "tutorial|wide");
  add_flag(app, "--orientation", arguments.orientation, msg::train_option_orientation);
  add_flag(app, "--obstacle", arguments.obstacle, msg::train_option_obstacle);
  add_flag(app, "--guide", arguments.guide, msg::train_option_guide);
  add_option(app, "--seed", arguments.seed, msg::train_option_seed, "N");
  add_option(app, "--threads", arguments.threads, msg::train_option_threads, "N");
}

Result<rl::TrainingOptions> with_task(const TaskArguments& arguments, rl::TrainingOptions options) {
  if (arguments.task != "reach") {
    return fail(Errc::usage,
                arguments.task.empty()
                    ? text(msg::train_which_task)
                    : text(msg::train_unknown_task, arguments.task) +
                          did_you_mean(arguments.task, std::array{std::string("reach")}));
  }
  if (arguments.guide) {
    const int environments = options.task.environments;
    options.task = rl::guide_options();
    options.task.environments = environments;
  }
  if (!arguments.region.empty()) {
    const Result<rl::ReachRegion> region = rl::reach_region(arguments.region);
    if (!region) return fail(in_option("--region", region.error()));
    options.task.region = *region;
  }
  options.task.orientation |= arguments.orientation;
  options.task.obstacle |= arguments.obstacle;
  if (!arguments.seed.empty()) {
    const Result<std::uint64_t> seed = parse_whole("--seed", arguments.seed);
    if (!seed) return fail(seed.error());
    options.ppo.seed = *seed;
  }
  options.ppo.threads = rl::training_threads();
  if (!arguments.threads.empty()) {
    const Result<int> threads = parse_threads(arguments.threads);
    if (!threads) return fail(threads.error());
    options.ppo.threads = *threads;
  }
  options.task.threads = options.ppo.threads;
  return options;
}

}  // namespace mjarm::app
