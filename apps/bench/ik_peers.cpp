#include "apps/bench/ik_peers.hpp"

#include <utility>

#include "apps/bench/peers.hpp"
#include "apps/bench/robots.hpp"

namespace mjarm::app {
namespace {

/// All that a peer has to know.
Result<JsonDoc> job_of(const IkProblem& problem, int rounds) {
  Result<JsonDoc> job = robot_job(problem.robot);
  if (!job) return job;
  std::vector<JsonDoc> sets;
  for (const IkCaseSet& set : problem.sets) {
    std::vector<JsonDoc> cases;
    for (const IkCase& entry : set.cases) {
      cases.push_back(pose_json(entry.X_WT));
      cases.back().set("seed", entry.seed);
    }
    sets.push_back({{"name", set.name}, {"cases", std::move(cases)}});
  }
  job->set("rounds", rounds);
  job->set("fk", problem.q);
  job->set("sets", std::move(sets));
  return job;
}

}  // namespace

Result<std::vector<IkRun>> run_ik_peers(const IkProblem& problem,
                                        const std::filesystem::path& environment, int rounds) {
  Result<JsonDoc> job = job_of(problem, rounds);
  if (!job) return fail(std::move(job.error()));
  std::vector<IkRun> runs;
  const auto take = [&](BenchEntry entry, const JsonValue& line) -> Result<void> {
    IkRun run{std::move(entry)};
    run.q = rows_in(line, "q");
    runs.push_back(std::move(run));
    return {};
  };
  const auto done = run_peers(environment, "ik", std::move(*job), take);
  if (!done) return fail(done.error());
  return runs;
}

}  // namespace mjarm::app
