#include "apps/bench/ik.hpp"

#include <fmt/format.h>

#include "apps/bench/ik_all.hpp"
#include "apps/bench/ik_hard.hpp"
#include "apps/bench/messages/bench.hpp"
#include "apps/bench/peers.hpp"
#include "apps/bench/robots.hpp"
#include "apps/mjarm/cli/usage.hpp"

namespace mjarm::app {
namespace {

/// Right answers of those asked for; what is right to the last case shows no decimals. Who was slow
/// did only the first cases.
std::string share_of(const IkRun& run) {
  const std::size_t asked = run.q.size();
  if (asked == 0) return "-";
  const double share = 100.0 * run.right / static_cast<double>(asked);
  const std::string words = fmt::format("{:.{}f} %", share, run.wrong.empty() ? 0 : 1);
  return asked == run.cases ? words : words + " " + text(msg::bench_first, asked);
}

/// The cell of a judged run and, for the JSON document, every miss.
void describe(IkRun& run) {
  run.cells = {share_of(run)};
  if (!run.q.empty()) {
    std::vector<JsonDoc> misses;
    for (const std::size_t at : run.wrong) {
      misses.push_back({{"case", at}, {"reason", at < run.reasons.size() ? run.reasons[at] : ""}});
    }
    run.details = {{"cases", run.q.size()},
                   {"right", run.right},
                   {"false_ok", run.false_ok},
                   {"misses", std::move(misses)}};
  }
  if (run.set == "path" || run.set == "track") run.details.set("max_step", run.max_step);
}

Result<BenchResult> measure_ik(const BenchOptions& options, const std::string& robot, int rounds) {
  const auto seed = parse_whole("--seed", options.seed);
  if (!seed) return fail(seed.error());
  const auto problem = load_ik_problem({.robot = robot, .tip = options.tip}, options.data, *seed);
  if (!problem) return fail(problem.error());
  const auto judge_run = [&](IkRun& run) { return judge_and_describe(*problem, run); };
  return compare(
      options.peers, {problem->name, problem->robot.model.file().filename().string()},
      run_ik(*problem, rounds), [&] { return run_ik_peers(*problem, options.peers, rounds); },
      judge_run, msg::bench_ik_wrong);
}

}  // namespace

Result<std::vector<IkRun>> run_ik_peers(const IkProblem& problem,
                                        const std::filesystem::path& environment, int rounds) {
  Result<JsonDoc> job = robot_job(problem.robot, rounds);
  if (!job) return fail(std::move(job.error()));
  std::vector<JsonDoc> sets;
  for (const IkCaseSet& set : problem.sets) {
    sets.push_back({{"name", set.name}, {"cases", cases_json(set)}});
  }
  job->set("fk", problem.q);
  job->set("sets", std::move(sets));
  return peer_runs<IkRun>(environment, "ik", std::move(*job),
                          [](const JsonValue& line, IkRun& run) { run.q = rows_in(line, "q"); });
}

std::vector<JsonDoc> cases_json(const IkCaseSet& set) {
  std::vector<JsonDoc> cases;
  for (const IkCase& entry : set.cases) {
    cases.push_back(pose_json(entry.X_WT));
    cases.back().set("seed", entry.seed);
  }
  return cases;
}

Result<int> judge_and_describe(const IkProblem& problem, IkRun& run) {
  if (Result<void> judged = judge(problem, run); !judged) return fail(judged.error());
  describe(run);
  return run.false_ok;
}

Command ik_suite() {
  return {"ik", msg::bench_ik_summary, msg::bench_ik_examples, [](CLI::App& app) {
            return setup_robots(app, msg::bench_ik_option_data, true, {msg::bench_ik_right},
                                measure_ik, {ik_all_variant(), ik_hard_variant()});
          }};
}

}  // namespace mjarm::app
