#include "apps/bench/rl.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/peers.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/rl/reach_env.hpp"

namespace mjarm::app {
namespace {

struct RlWords : ReportOptions {
  std::string set, seeds = "5", steps, peers, out = "mjarm-out/bench-rl";
  Replace replace;
};

/// The tutorial's region with the gripper held open; a short one with the gripper as the model has
/// it, for the rate; and the wide region.
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

/// Trains by mjarm.
/// @param folder  exists; gets the files of the training.
/// @return also an error where it was stopped.
Result<LearningRun> run_learner(const Model& model, const LearningSet& set, std::uint64_t seed,
                                const std::filesystem::path& folder, Progress& progress) {
  rl::TrainingOptions options = set.options;
  options.ppo.seed = seed;
  auto training = rl::Training::create(model, options, folder);
  if (!training) return fail(std::move(training.error()));
  LearningRun run{our_entry("mjarm", set.name, 0), seed, {}};
  double us = 0;
  while (!training->done()) {
    const std::int64_t before = training->trainer().steps();
    const Result<rl::TrainingStep> step = training->advance();
    if (!step) return fail(step.error());
    us += step->iteration.collect_us + step->iteration.update_us;
    if (step->evaluation) {
      run.curve.push_back({step->iteration.steps, 1e-6 * us, step->evaluation->distances});
    }
    progress.advance(static_cast<std::uint64_t>(step->iteration.steps - before));
    if (interrupted()) return fail(stopped());
  }
  run.us = {us / static_cast<double>(training->trainer().steps())};
  return run;
}

/// The sets that are asked for, with so many steps and seeds.
Result<std::vector<LearningSet>> sets_of(const RlWords& options, int seeds) {
  std::vector<LearningSet> sets = learning_sets();
  if (!options.set.empty()) {
    std::vector<std::string> names;
    for (const LearningSet& set : sets) names.push_back(set.name);
    const Result<std::size_t> asked = parse_choice("--set", options.set, names);
    if (!asked) return fail(asked.error());
    sets = {sets[*asked]};
  }
  for (LearningSet& set : sets) {
    set.options.task.threads = set.options.ppo.threads = rl::training_threads();
    set.peer_seeds = options.peers.empty() ? 0 : std::min(set.peer_seeds, seeds);
  }
  if (Result<void> there = check_peers(options.peers); !there) return fail(there.error());
  if (options.steps.empty()) return sets;
  const Result<std::uint64_t> steps = parse_whole("--steps", options.steps);
  if (!steps) return fail(steps.error());
  for (LearningSet& set : sets) {
    set.options.ppo.total_steps = static_cast<std::int64_t>(*steps);
    set.options.evaluate_every = std::min(set.options.evaluate_every, set.options.ppo.total_steps);
  }
  return sets;
}

/// All learners on all sets, seed by seed in turn, so that a busy machine is so for all of them.
Result<std::vector<LearningRun>> run_all(const RlWords& options,
                                         const std::vector<LearningSet>& sets, int seeds) {
  std::uint64_t total = 0;
  for (const LearningSet& set : sets) {
    total += static_cast<std::uint64_t>(set.options.ppo.total_steps * (seeds + set.peer_seeds));
  }
  Progress progress(text(msg::bench_rl_progress), total);
  std::vector<LearningRun> runs;
  for (const LearningSet& set : sets) {
    const Result<Model> model = rl::reach_model(set.options.task);
    if (!model) return fail(model.error());
    for (int i = 0; i < seeds; ++i) {
      const std::uint64_t seed = set.options.ppo.seed + static_cast<std::uint64_t>(i);
      const std::filesystem::path folder =
          std::filesystem::path(options.out) / (set.name + "-" + std::to_string(seed));
      const Result<OutputFolder> held =
          OutputFolder::open(folder, {.overwrite = options.replace.overwrite});
      if (!held) return fail(held.error());
      log_info(text(msg::bench_rl_run, set.name, seed, "mjarm"));
      auto run = run_learner(*model, set, seed, folder, progress);
      if (!run) return fail(std::move(run.error()));
      held->made();
      runs.push_back(std::move(*run));
      if (i >= set.peer_seeds) continue;
      log_info(text(msg::bench_rl_run, set.name, seed, text(msg::bench_rl_peers)));
      auto peers = run_learning_peers(*model, set, seed, options.peers);
      if (!peers) return fail(std::move(peers.error()));
      std::ranges::move(*peers, std::back_inserter(runs));
      progress.advance(static_cast<std::uint64_t>(set.options.ppo.total_steps));
      if (interrupted()) return fail(stopped());
    }
  }
  return runs;
}

Result<int> run_rl(const RlWords& options) {
  constexpr int kMaxSeeds = 100;
  const Result<int> seeds = parse_count("--seeds", options.seeds, kMaxSeeds);
  if (!seeds) return fail(seeds.error());
  const auto sets = sets_of(options, *seeds);
  if (!sets) return fail(sets.error());
  const Result<OutputFolder> folder = OutputFolder::open(options.out, options.replace);
  if (!folder) return fail(folder.error());
  const auto runs = run_all(options, *sets, *seeds);
  if (!runs) return fail(runs.error());
  const bool timing = !options.no_timing;
  const std::vector<BenchResult> results{
      {text(msg::bench_rl_robot), {}, learning_entries(*runs, timing)}};
  return report_in_folder(
      options, results, learning_columns(), *folder,
      [&] { return draw_learning_curves(*runs, timing, options.out); }, msg::bench_rl_folder);
}

}  // namespace

Command rl_suite() {
  return {"rl", msg::bench_rl_summary, msg::bench_rl_examples, [](CLI::App& app) -> Run {
            auto options = std::make_shared<RlWords>();
            add_option(app, "--set", options->set, msg::bench_rl_option_set, "SET");
            add_option(app, "--seeds", options->seeds, msg::bench_rl_option_seeds, "N");
            add_option(app, "--steps", options->steps, msg::bench_rl_option_steps, "N");
            add_option(app, "--peers", options->peers, msg::bench_rl_option_peers, "VENV");
            add_option(app, "--out", options->out, msg::bench_rl_option_out, "DIR");
            add_overwrite_option(app, options->replace);
            add_report_options(app, *options);
            return [options] { return run_rl(*options); };
          }};
}

}  // namespace mjarm::app
