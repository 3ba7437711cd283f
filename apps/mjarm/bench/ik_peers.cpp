#include "apps/mjarm/bench/ik_peers.hpp"

#include <utility>

#include "apps/mjarm/bench/peers.hpp"
#include "apps/mjarm/bench/robots.hpp"

namespace mjarm::app {
namespace {

/// All that a peer has to know.
Result<nlohmann::json> job_of(const IkProblem& problem, int rounds) {
  Result<nlohmann::json> job = robot_job(problem.robot);
  if (!job) return job;
  (*job)["rounds"] = rounds;
  (*job)["fk"] = problem.q;
  for (const IkCaseSet& set : problem.sets) {
    nlohmann::json cases = nlohmann::json::array();
    for (const IkCase& entry : set.cases) {
      cases.push_back(pose_json(entry.X_WT));
      cases.back()["seed"] = entry.seed;
    }
    (*job)["sets"].push_back({{"name", set.name}, {"cases", std::move(cases)}});
  }
  return job;
}

}  // namespace

Result<std::vector<IkRun>> run_ik_peers(const IkProblem& problem,
                                        const std::filesystem::path& environment, int rounds) {
  Result<nlohmann::json> job = job_of(problem, rounds);
  if (!job) return fail(std::move(job.error()));
  std::vector<IkRun> runs;
  const auto take = [&](BenchEntry entry, const nlohmann::json& line) -> Result<void> {
    IkRun run{std::move(entry)};
    for (const nlohmann::json& q : line.value("q", nlohmann::json::array())) {
      run.q.push_back(q.is_null() ? std::vector<double>() : q.get<std::vector<double>>());
    }
    runs.push_back(std::move(run));
    return {};
  };
  const auto done = run_peers(environment, "ik", std::move(*job), take);
  if (!done) return fail(done.error());
  return runs;
}

}  // namespace mjarm::app
