#include <algorithm>
#include <cstdio>
#include <memory>
#include <utility>

#include "apps/bench/messages/bench_rl.hpp"
#include "apps/bench/rl_peers.hpp"
#include "apps/bench/rl_report.hpp"
#include "apps/bench/rl_run.hpp"
#include "apps/bench/suite.hpp"
#include "apps/bench/suites.hpp"
#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/output_folder.hpp"
#include "mjarm/core/progress.hpp"
#include "mjarm/rl/reach_env.hpp"

namespace mjarm::app {
namespace {

struct Options {
  std::string set, seeds = "5", steps, peers, out = "mjarm-out/bench-rl";
  bool json = false, no_timing = false;
};

/// The sets that are asked for, with so many steps and seeds.
Result<std::vector<LearningSet>> sets_of(const Options& options, int seeds) {
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
Result<std::vector<LearningRun>> run_all(const Options& options,
                                         const std::vector<LearningSet>& sets, int seeds) {
  std::uint64_t total = 0;
  for (const LearningSet& set : sets) {
    total += static_cast<std::uint64_t>(set.options.ppo.total_steps * (seeds + set.peer_seeds));
  }
  Progress progress(text(msg::bench_rl_progress), total);
  const AdvanceSteps advance = [&](std::uint64_t steps) {
    progress.advance(steps);
    return !interrupted();
  };
  std::vector<LearningRun> runs;
  for (const LearningSet& set : sets) {
    const Result<Model> model = rl::reach_model(set.options.task);
    if (!model) return fail(model.error());
    for (int i = 0; i < seeds; ++i) {
      const std::uint64_t seed = set.options.ppo.seed + static_cast<std::uint64_t>(i);
      const std::filesystem::path folder =
          std::filesystem::path(options.out) / (set.name + "-" + std::to_string(seed));
      const Result<OutputFolder> held = OutputFolder::open(folder);
      if (!held) return fail(held.error());
      log_info(text(msg::bench_rl_run, set.name, seed, "mjarm"));
      auto run = run_learner(*model, set, seed, folder, advance);
      if (!run) return fail(std::move(run.error()));
      runs.push_back(std::move(*run));
      if (i >= set.peer_seeds) continue;
      log_info(text(msg::bench_rl_run, set.name, seed, text(msg::bench_rl_peers)));
      auto peers = run_learning_peers(*model, set, seed, options.peers);
      if (!peers) return fail(std::move(peers.error()));
      std::move(peers->begin(), peers->end(), std::back_inserter(runs));
      if (!advance(static_cast<std::uint64_t>(set.options.ppo.total_steps))) return fail(stopped());
    }
  }
  return runs;
}

Result<int> run_rl(const Options& options) {
  constexpr int kMaxSeeds = 100;
  const Result<int> seeds = parse_count("--seeds", options.seeds, kMaxSeeds);
  if (!seeds) return fail(seeds.error());
  const auto sets = sets_of(options, *seeds);
  if (!sets) return fail(sets.error());
  catch_interrupts();
  const auto runs = run_all(options, *sets, *seeds);
  if (!runs) return fail(runs.error());
  const bool timing = !options.no_timing;
  const std::vector<BenchResult> results{
      {text(msg::bench_rl_robot), {}, learning_entries(*runs, timing)}};
  const std::filesystem::path out = options.out;
  const std::string json = bench_json(results, timing);
  if (auto written = write_file(out / "bench.json", json); !written) return fail(written.error());
  if (auto drawn = draw_learning_curves(*runs, timing, out); !drawn) return fail(drawn.error());
  const std::string answer = options.json ? json : bench_table(results, learning_columns(), timing);
  std::fputs(answer.c_str(), stdout);
  log_info(text(msg::bench_rl_folder, options.out));
  return 0;
}

}  // namespace

BenchSuite add_bench_rl(CLI::App& bench) {
  auto options = std::make_shared<Options>();
  CLI::App& app = add_subcommand(bench, "rl", msg::bench_rl_summary, msg::bench_rl_examples);
  add_option(app, "--set", options->set, msg::bench_rl_option_set, "SET");
  add_option(app, "--seeds", options->seeds, msg::bench_rl_option_seeds, "N");
  add_option(app, "--steps", options->steps, msg::bench_rl_option_steps, "N");
  add_option(app, "--peers", options->peers, msg::bench_rl_option_peers, "VENV");
  add_option(app, "--out", options->out, msg::bench_rl_option_out, "DIR");
  add_flag(app, "--json", options->json, msg::app_option_json);
  add_flag(app, "--no-timing", options->no_timing, msg::app_option_no_timing);
  return {&app, [options] { return run_rl(*options); }};
}

}  // namespace mjarm::app
