#include <algorithm>
#include <memory>
#include <utility>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/suite.hpp"
#include "apps/bench/suites.hpp"
#include "apps/bench/time_peers.hpp"
#include "apps/bench/time_report.hpp"

namespace mjarm::app {
namespace {

/// Where no shortest durations are known ours stand in for them: for path_vaj those without jerk
/// limits, for the other sets its own.
std::vector<double> reference(const TimeSet& set, const std::vector<TimeRun>& ours) {
  if (!set.best.empty()) return set.best;
  const std::string name = set.name == "path_vaj" ? "path_va" : set.name;
  std::vector<double> durations;
  for (const TimeRun& run : ours) {
    if (run.set != name) continue;
    for (const TimedMotion& motion : run.motions) durations.push_back(motion.duration);
  }
  return durations;
}

Result<BenchResult> measure(const BenchOptions& options, const std::string& robot, int rounds) {
  const Result<std::vector<TimeSet>> sets = load_time_sets(robot, options.data);
  if (!sets) return fail(sets.error());
  BenchResult result{std::filesystem::path(robot).stem().string(), {}, {}};
  const auto ours = run_sets<TimeRun>(
      text(msg::bench_time_progress, result.robot), *sets, rounds,
      [&](const TimeSet& set, const Advance& advance) { return run_time(set, rounds, advance); });
  if (!ours) return fail(ours.error());
  std::vector<TimeRun> runs = *ours;
  const auto run_peers = [&] { return run_time_peers(*sets, options.peers, rounds); };
  if (auto added = add_peers(options, result.robot, runs, run_peers); !added) {
    return fail(std::move(added.error()));
  }
  int wrong = 0;
  for (const TimeRun& run : runs) {
    const auto set = std::find_if(sets->begin(), sets->end(),
                                  [&](const TimeSet& known) { return known.name == run.set; });
    if (set == sets->end()) {  // a peer that failed
      result.entries.push_back(run);
      continue;
    }
    wrong += run.version.empty() ? wrong_motions(run) : 0;
    result.entries.push_back(time_entry(*set, run, reference(*set, *ours)));
  }
  if (wrong > 0) result.wrong = text(msg::bench_time_wrong, result.robot, wrong);
  return result;
}

}  // namespace

BenchSuite add_bench_time(CLI::App& bench) {
  auto options = std::make_shared<BenchOptions>();
  CLI::App& app = add_subcommand(bench, "time", msg::bench_time_summary, msg::bench_time_examples);
  add_bench_options(app, *options, msg::bench_time_option_data);
  return {&app, [options] {
            return run_suite(*options, {"ur5e", "panda"}, time_columns(),
                             [&](const std::string& robot, int rounds) {
                               return measure(*options, robot, rounds);
                             });
          }};
}

}  // namespace mjarm::app
