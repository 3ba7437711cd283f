#include "apps/bench/plan.hpp"

#include <algorithm>
#include <cstdint>
#include <deque>
#include <memory>
#include <utility>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/peers.hpp"
#include "apps/bench/plan_near.hpp"
#include "apps/bench/scratch_folder.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/units.hpp"

namespace mjarm::app {
namespace {

struct PlanWords : ReportOptions {
  std::string set, data, peers, peer_every = "10", goals = "200", seed = "1",
                                out = "mjarm-out/bench-plan";
  Replace replace;
};

const std::vector<std::string> kArms = {"panda", "ur5"};
constexpr const char* kCrowdedArm = "panda";

/// What is asked for, read from the options.
struct Job {
  std::vector<std::string> arms = kArms;  ///< whose problems are solved
  bool anytime = true, scaling = true, near = true;
  int goals = 200;  ///< of near
  std::uint64_t seed = 1;
  PlanPeers peers = {};
  bool timing = true;
};

/// @param set  of `--set`.
Result<void> add_set(const std::string& set, Job& job) {
  const std::vector<std::string> names = {kArms[0], kArms[1], "anytime", "scaling", "near"};
  const Result<std::size_t> asked = parse_choice("--set", set, names);
  if (!asked) return fail(asked.error());
  if (set == "anytime" && !job.timing) {
    return fail(Errc::usage, text(msg::app_exclusive_options, "--set anytime", "--no-timing"));
  }
  bool* const flag = set == "anytime"   ? &job.anytime
                     : set == "scaling" ? &job.scaling
                     : set == "near"    ? &job.near
                                        : nullptr;
  if (flag != nullptr) {
    *flag = true;
  } else if (std::ranges::count(job.arms, set) == 0) {
    job.arms.push_back(set);
  }
  return {};
}

Result<Job> job_of(const PlanWords& options) {
  constexpr int kMaxEvery = 1000, kMaxGoals = 10'000;
  Job job{.timing = !options.no_timing};
  const auto seed = parse_whole("--seed", options.seed);
  if (!seed) return fail(seed.error());
  const Result<int> every = parse_count("--peer-every", options.peer_every, kMaxEvery);
  if (!every) return fail(every.error());
  const Result<int> goals = parse_count("--goals", options.goals, kMaxGoals);
  if (!goals) return fail(goals.error());
  if (Result<void> there = check_peers(options.peers); !there) return fail(there.error());
  job.seed = *seed;
  job.goals = *goals;
  job.peers = {.environment = options.peers, .every = *every};
  job.anytime = job.timing;  // what it finds depends on the clock
  if (options.set.empty()) return job;
  job.arms.clear();
  job.anytime = job.scaling = job.near = false;
  std::vector<std::string_view> sets = split_list(options.set);
  if (sets.empty()) sets.emplace_back(options.set);  // blanks are no set
  for (const std::string_view set : sets) {
    if (auto added = add_set(std::string(set), job); !added) return fail(std::move(added.error()));
  }
  return job;
}

/// All that was measured. The tables look at the sets, which stay where they are.
struct Measured {
  std::deque<PlanSet> sets;
  std::vector<CrowdedSet> crowds;
  std::unique_ptr<ScratchFolder> models = {};  ///< of near
  std::vector<NearSet> near = {};
  std::vector<PlanTable> solved, anytime;
  PlanTable crowded;
};

/// The scenes of `near` and their problems.
Result<void> prepare_near(const PlanWords& options, const Job& job, Measured& all) {
  all.models = std::make_unique<ScratchFolder>("bench_near");
  const auto robots = near_robots(options.data, all.models->path());
  if (!robots) return fail(robots.error());
  auto sets = draw_near_sets(*robots, job.goals, job.seed);
  if (!sets) return fail(std::move(sets.error()));
  all.near = std::move(*sets);
  return {};
}

bool is_solved(const Job& job, const PlanSet& set) {
  return std::ranges::count(job.arms, set.name) > 0;
}

/// Reads everything before anything is measured.
Result<Measured> prepare(const PlanWords& options, const Job& job) {
  Measured all;
  std::vector<std::string> arms = job.arms;
  if (job.anytime) arms.insert(arms.end(), kArms.begin(), kArms.end());
  if (job.scaling) arms.push_back(kCrowdedArm);
  for (const std::string& arm : arms) {
    if (std::ranges::count(all.sets, arm, &PlanSet::name) > 0) continue;
    Result<PlanSet> set = load_plan_set(options.data, arm);
    if (!set) return fail(std::move(set.error()));
    all.sets.push_back(std::move(*set));
  }
  if (job.near) {
    if (auto drawn = prepare_near(options, job, all); !drawn) return fail(std::move(drawn.error()));
  }
  if (!job.scaling) return all;
  auto crowds =
      make_crowded_sets(*std::ranges::find(all.sets, kCrowdedArm, &PlanSet::name), job.seed);
  if (!crowds) return fail(std::move(crowds.error()));
  all.crowds = std::move(*crowds);
  return all;
}

Result<void> measure(const Job& job, Measured& all) {
  constexpr std::uint64_t kBudgets = 3;
  std::uint64_t steps = all.crowds.size();
  for (const PlanSet& set : all.sets) {
    steps += is_solved(job, set) ? scenes_of(set).size() : 0;
    steps += job.anytime ? kBudgets : 0;
  }
  for (const NearSet& set : all.near) steps += set.scenes.size();
  Progress progress(text(msg::bench_plan_progress), steps);
  for (const PlanSet& set : all.sets) {
    if (is_solved(job, set)) {
      (void)wants_peers(job.peers.environment.string(), set.name);
      auto table = run_plan_set(set, job.seed, job.peers, progress);
      if (!table) return fail(std::move(table.error()));
      all.solved.push_back(std::move(*table));
    }
    if (job.anytime) {
      auto table = run_anytime(set, job.seed, progress);
      if (!table) return fail(std::move(table.error()));
      all.anytime.push_back(std::move(*table));
    }
  }
  for (const NearSet& set : all.near) {
    auto table = run_near_set(set, job.seed, job.peers, progress);
    if (!table) return fail(std::move(table.error()));
    all.solved.push_back(std::move(*table));
  }
  auto crowded = run_crowds(all.crowds, job.seed, progress);
  if (!crowded) return fail(std::move(crowded.error()));
  all.crowded = std::move(*crowded);
  return {};
}

std::vector<BenchResult> results_of(const Measured& all, const Job& job) {
  std::vector<BenchResult> results;
  const auto add = [&](const std::string& name, const PlanTable& table) {
    results.push_back(plan_result(name, table, job.timing, job.near));
  };
  for (const PlanTable& table : all.solved) {
    add(table.name, table);
  }
  for (const PlanTable& table : all.anytime) {
    add(text(msg::bench_plan_anytime, table.name), table);
  }
  if (!all.crowds.empty()) {
    add(text(msg::bench_plan_scaling, kCrowdedArm), all.crowded);
  }
  return results;
}

/// Every path and, where times are told, a picture.
Result<void> write_more(const Job& job, const Measured& all, const std::string& folder) {
  for (const PlanTable& table : all.solved) {
    if (auto written = write_paths(table, job.timing, folder); !written) return written;
  }
  if (!job.timing) return {};
  return draw_plan_times(all.solved, all.crowds, all.crowded, folder);
}

Result<int> run_plans(const PlanWords& options) {
  const Result<Job> job = job_of(options);
  if (!job) return fail(job.error());
  Result<Measured> all = prepare(options, *job);
  if (!all) return fail(std::move(all.error()));
  const Result<OutputFolder> folder = OutputFolder::open(options.out, options.replace);
  if (!folder) return fail(folder.error());
  if (auto done = measure(*job, *all); !done) return fail(std::move(done.error()));
  return report_in_folder(
      options, results_of(*all, *job), plan_columns(job->timing, job->near), *folder,
      [&] { return write_more(*job, *all, options.out); }, msg::bench_plan_folder);
}

}  // namespace

Command plan_suite() {
  return {"plan", msg::bench_plan_summary, msg::bench_plan_examples, [](CLI::App& app) -> Run {
            auto options = std::make_shared<PlanWords>();
            add_option(app, "--set", options->set, msg::bench_plan_option_set, "SET");
            add_option(app, "--data", options->data, msg::bench_plan_option_data, "DIR");
            add_option(app, "--peers", options->peers, msg::bench_option_peers, "VENV");
            add_option(app, "--peer-every", options->peer_every, msg::bench_plan_option_every, "N");
            add_option(app, "--goals", options->goals, msg::bench_plan_option_goals, "N");
            add_option(app, "--seed", options->seed, msg::bench_plan_option_seed, "N");
            add_option(app, "--out", options->out, msg::bench_plan_option_out, "DIR");
            add_overwrite_option(app, options->replace);
            add_report_options(app, *options);
            return [options] { return run_plans(*options); };
          }};
}

}  // namespace mjarm::app
