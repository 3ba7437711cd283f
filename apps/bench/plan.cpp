#include <cstdio>
#include <deque>
#include <memory>
#include <utility>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/messages/bench_plan.hpp"
#include "apps/bench/plan_plot.hpp"
#include "apps/bench/plan_suite.hpp"
#include "apps/bench/suites.hpp"
#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/output_folder.hpp"

namespace mjarm::app {
namespace {

struct Options {
  std::string set, data, peers, peer_every = "10", seed = "1", out = "mjarm-out/bench-plan";
  bool json = false, no_timing = false;
};

const std::vector<std::string> kArms = {"panda", "ur5"};

/// What is asked for, read from the options.
struct Job {
  std::vector<std::string> arms = kArms;  ///< whose problems are solved
  bool anytime = true, scaling = true;
  std::uint64_t seed = 1;
  PlanPeers peers = {};
  bool timing = true;
};

Result<Job> job_of(const Options& options) {
  constexpr int kMaxEvery = 1000;
  Job job{.timing = !options.no_timing};
  const auto seed = parse_whole("--seed", options.seed);
  if (!seed) return fail(seed.error());
  const Result<int> every = parse_count("--peer-every", options.peer_every, kMaxEvery);
  if (!every) return fail(every.error());
  job.seed = *seed;
  job.peers = {.environment = options.peers, .every = *every};
  job.anytime = job.timing;  // what it finds depends on the clock
  if (options.set.empty()) return job;
  const std::vector<std::string> names = {kArms[0], kArms[1], "anytime", "scaling"};
  const Result<std::size_t> asked = parse_choice("--set", options.set, names);
  if (!asked) return fail(asked.error());
  job.anytime = options.set == "anytime";
  job.scaling = options.set == "scaling";
  if (job.anytime && !job.timing) {
    return fail(Errc::usage, text(msg::app_exclusive_options, "--set anytime", "--no-timing"));
  }
  job.arms.clear();
  if (!job.anytime && !job.scaling) job.arms = {options.set};
  return job;
}

/// All that was measured. The tables look at the sets, which stay where they are.
struct Measured {
  std::deque<PlanSet> sets;
  std::vector<CrowdedSet> crowds;
  std::vector<PlanTable> solved, anytime;
  PlanTable crowded;
};

/// The set of an arm, read where it is asked for first.
Result<const PlanSet*> set_of(const std::string& arm, const Options& options, Measured& all) {
  for (const PlanSet& set : all.sets) {
    if (set.name == arm) return &set;
  }
  Result<PlanSet> set = load_plan_set(options.data, arm);
  if (!set) return fail(std::move(set.error()));
  return &all.sets.emplace_back(std::move(*set));
}

/// Reads everything before anything is measured.
Result<Measured> prepare(const Options& options, const Job& job) {
  Measured all;
  std::vector<std::string> arms = job.arms;
  if (job.anytime) arms = kArms;
  if (job.scaling) arms.push_back(kArms.front());
  for (const std::string& arm : arms) {
    const auto set = set_of(arm, options, all);
    if (!set) return fail(set.error());
  }
  if (!job.scaling) return all;
  auto crowds = make_crowded_sets(all.sets.front(), job.seed);
  if (!crowds) return fail(std::move(crowds.error()));
  all.crowds = std::move(*crowds);
  return all;
}

Result<void> measure(const Job& job, Measured& all) {
  constexpr std::uint64_t kBudgets = 3;
  std::uint64_t steps = all.crowds.size();
  for (const PlanSet& set : all.sets) {
    steps += job.arms.empty() ? 0 : scenes_of(set).size();
    steps += job.anytime ? kBudgets : 0;
  }
  const Advance advance = show_rounds(text(msg::bench_plan_progress), steps);
  for (const PlanSet& set : all.sets) {
    if (!job.arms.empty()) {
      if (!job.peers.environment.empty()) log_info(text(msg::bench_running_peers, set.name));
      auto table = run_plan_set(set, job.seed, job.peers, advance);
      if (!table) return fail(std::move(table.error()));
      all.solved.push_back(std::move(*table));
    }
    if (job.anytime) {
      auto table = run_anytime(set, job.seed, advance);
      if (!table) return fail(std::move(table.error()));
      all.anytime.push_back(std::move(*table));
    }
  }
  auto crowded = run_crowds(all.crowds, job.seed, advance);
  if (!crowded) return fail(std::move(crowded.error()));
  all.crowded = std::move(*crowded);
  return {};
}

BenchResult result_of(const std::string& name, const PlanTable& table, bool timing) {
  const std::string file = table.set == nullptr ? "" : table.set->file.filename().string();
  BenchResult result{name, file, plan_entries(table, timing)};
  int wrong = 0;
  for (const PlanRun& run : table.runs) wrong += run.version.empty() ? wrong_paths(run) : 0;
  if (wrong > 0) result.wrong = text(msg::bench_plan_wrong, name, wrong);
  return result;
}

std::vector<BenchResult> results_of(const Measured& all, bool timing) {
  std::vector<BenchResult> results;
  for (const PlanTable& table : all.solved) {
    results.push_back(result_of(table.set->name, table, timing));
  }
  for (const PlanTable& table : all.anytime) {
    const std::string name = text(msg::bench_plan_anytime, table.set->name);
    results.push_back(result_of(name, table, timing));
  }
  if (!all.crowds.empty()) {
    const std::string name = text(msg::bench_plan_scaling, all.sets.front().name);
    results.push_back(result_of(name, all.crowded, timing));
  }
  return results;
}

Result<int> write_all(const Options& options, const Job& job, const Measured& all) {
  const std::filesystem::path out = options.out;
  const std::vector<BenchResult> results = results_of(all, job.timing);
  const Result<OutputFolder> held = OutputFolder::open(out);
  if (!held) return fail(held.error());
  const std::string json = bench_json(results, job.timing);
  if (auto written = write_file(out / "bench.json", json); !written) return fail(written.error());
  for (const PlanTable& table : all.solved) {
    if (auto written = write_paths(table, job.timing, out); !written) return fail(written.error());
  }
  if (job.timing) {
    auto drawn = draw_plan_times(all.solved, all.crowds, all.crowded, out);
    if (!drawn) return fail(std::move(drawn.error()));
  }
  const std::string answer =
      options.json ? json : bench_table(results, plan_columns(job.timing), job.timing);
  std::fputs(answer.c_str(), stdout);
  log_info(text(msg::bench_plan_folder, options.out));
  for (const BenchResult& result : results) {
    if (!result.wrong.empty()) return fail(Errc::impossible, result.wrong);
  }
  return 0;
}

Result<int> run_suite_of_plans(const Options& options) {
  const Result<Job> job = job_of(options);
  if (!job) return fail(job.error());
  catch_interrupts();
  Result<Measured> all = prepare(options, *job);
  if (!all) return fail(std::move(all.error()));
  if (auto done = measure(*job, *all); !done) return fail(std::move(done.error()));
  return write_all(options, *job, *all);
}

}  // namespace

BenchSuite add_bench_plan(CLI::App& bench) {
  auto options = std::make_shared<Options>();
  CLI::App& app = add_subcommand(bench, "plan", msg::bench_plan_summary, msg::bench_plan_examples);
  add_option(app, "--set", options->set, msg::bench_plan_option_set, "SET");
  add_option(app, "--data", options->data, msg::bench_plan_option_data, "DIR");
  add_option(app, "--peers", options->peers, msg::bench_option_peers, "VENV");
  add_option(app, "--peer-every", options->peer_every, msg::bench_plan_option_every, "N");
  add_option(app, "--seed", options->seed, msg::bench_plan_option_seed, "N");
  add_option(app, "--out", options->out, msg::bench_plan_option_out, "DIR");
  add_flag(app, "--json", options->json, msg::app_option_json);
  add_flag(app, "--no-timing", options->no_timing, msg::app_option_no_timing);
  return {&app, [options] { return run_suite_of_plans(*options); }};
}

}  // namespace mjarm::app
