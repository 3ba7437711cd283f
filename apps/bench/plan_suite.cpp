#include "apps/bench/plan_suite.hpp"

#include <numeric>
#include <utility>

#include "apps/bench/messages/bench_plan.hpp"

namespace mjarm::app {
namespace {

std::vector<std::size_t> all_of(const PlanSet& set) {
  std::vector<std::size_t> indices(set.cases.size());
  std::iota(indices.begin(), indices.end(), 0);
  return indices;
}

/// The first problem once more, so that what is there for the first time costs nobody anything.
void warm_up(const PlanSet& set, const PlanOptions& options) {
  const std::size_t first[] = {0};
  (void)run_plan(set, first, options);
}

/// Runs ours on some problems, as the case `name` of a table.
void add_ours(const PlanSet& set, const std::string& name, std::span<const std::size_t> problems,
              const PlanOptions& options, PlanTable& table) {
  table.runs.push_back(run_plan(set, problems, options));
  table.runs.back().set = name;
}

Result<void> add_plan_peers(const PlanSet& set, const std::string& scene,
                            std::span<const std::size_t> problems, const PlanPeers& peers,
                            PlanTable& table) {
  if (peers.environment.empty()) return {};
  auto runs = run_plan_peers(set, problems, peers);
  if (!runs) return fail(std::move(runs.error()));
  for (PlanRun& run : *runs) {
    if (run.error.empty()) run.set = scene;
    table.runs.push_back(std::move(run));
  }
  return {};
}

Result<void> add_checks(const PlanSet& set, std::uint64_t seed, PlanTable& table) {
  const Result<CheckTimes> times = run_checks(set, seed);
  if (!times) return fail(times.error());
  table.checks.push_back(*times);
  return {};
}

}  // namespace

Result<PlanTable> run_plan_set(const PlanSet& set, std::uint64_t seed, const PlanPeers& peers,
                               const Advance& advance) {
  PlanTable table{.set = &set, .sum = true};
  const PlanOptions options{.seed = seed};
  warm_up(set, options);
  for (const std::string& scene : scenes_of(set)) {
    const std::vector<std::size_t> problems = cases_of(set, scene);
    add_ours(set, scene, problems, options, table);
    if (auto added = add_plan_peers(set, scene, problems, peers, table); !added) {
      return fail(std::move(added.error()));
    }
    if (!advance()) return fail(stopped());
  }
  if (auto added = add_checks(set, seed, table); !added) return fail(std::move(added.error()));
  return table;
}

Result<PlanTable> run_anytime(const PlanSet& set, std::uint64_t seed, const Advance& advance) {
  PlanTable table{.set = &set};
  PlanOptions options{.seed = seed};
  warm_up(set, options);
  for (const int milliseconds : {0, 2, 10}) {
    options.time_budget = 1e-3 * milliseconds;
    const std::string name = milliseconds == 0 ? text(msg::bench_plan_no_budget)
                                               : text(msg::bench_plan_budget, milliseconds);
    add_ours(set, name, all_of(set), options, table);
    if (!advance()) return fail(stopped());
  }
  return table;
}

Result<PlanTable> run_crowds(const std::vector<CrowdedSet>& crowds, std::uint64_t seed,
                             const Advance& advance) {
  PlanTable table;
  const PlanOptions options{.seed = seed};
  for (const CrowdedSet& crowd : crowds) {
    warm_up(crowd.set, options);
    const Msg kind = crowd.points ? msg::bench_plan_crowd_points : msg::bench_plan_crowd_boxes;
    add_ours(crowd.set, text(kind, crowd.obstacles), all_of(crowd.set), options, table);
    if (auto added = add_checks(crowd.set, seed, table); !added) {
      return fail(std::move(added.error()));
    }
    if (!advance()) return fail(stopped());
  }
  return table;
}

}  // namespace mjarm::app
