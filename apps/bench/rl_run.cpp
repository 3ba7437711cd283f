#include "apps/bench/rl_run.hpp"

#include <algorithm>
#include <utility>

#include "apps/bench/suite.hpp"

namespace mjarm::app {

std::vector<LearningSet> learning_sets() {
  constexpr std::int64_t kIteration = 1024;  // steps of the default settings
  rl::TrainingOptions tutorial;
  tutorial.evaluate_every = 10 * kIteration;
  rl::TrainingOptions as_model = tutorial;
  as_model.task.gripper = rl::ReachGripper::as_model;
  as_model.ppo.total_steps = 20 * kIteration;
  as_model.evaluate_every = as_model.ppo.total_steps;
  rl::TrainingOptions wide = rl::reach_training(rl::ReachRegion::wide);
  wide.evaluate_every = 50 * kIteration;
  return {{"tutorial", tutorial, 5}, {"as_model", as_model, 5}, {"wide", wide, 1}};
}

double share_within(const LearningPoint& point, double distance) {
  const auto count = std::count_if(point.distances.begin(), point.distances.end(),
                                   [&](double d) { return d <= distance; });
  return static_cast<double>(count) / static_cast<double>(point.distances.size());
}

Result<LearningRun> run_learner(const Model& model, const LearningSet& set, std::uint64_t seed,
                                const std::filesystem::path& folder, const AdvanceSteps& advance) {
  rl::TrainingOptions options = set.options;
  options.ppo.seed = seed;
  auto training = rl::Training::create(model, options, folder);
  if (!training) return fail(std::move(training.error()));
  LearningRun run{{.who = "mjarm", .set = set.name, .timed = "c++"}, seed, {}};
  double us = 0;
  while (!training->done()) {
    const std::int64_t before = training->trainer().steps();
    const Result<rl::TrainingStep> step = training->advance();
    if (!step) return fail(step.error());
    us += step->iteration.collect_us + step->iteration.update_us;
    if (step->evaluation) {
      run.curve.push_back({step->iteration.steps, 1e-6 * us, step->evaluation->distances});
    }
    if (!advance(static_cast<std::uint64_t>(step->iteration.steps - before))) {
      return fail(stopped());
    }
  }
  run.us = {us / static_cast<double>(training->trainer().steps())};
  return run;
}

}  // namespace mjarm::app
