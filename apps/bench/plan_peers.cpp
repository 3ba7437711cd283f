#include <algorithm>
#include <map>
#include <utility>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/peers.hpp"
#include "apps/bench/plan.hpp"

namespace mjarm::app {
namespace {

/// Index of each of the problems that a peer was asked, by id.
using KnownProblems = std::map<std::string, std::size_t>;

/// Times of another clock; none where the peer has none. Throws `BrokenAnswer`.
std::vector<double> clock_in(const JsonValue& line, const char* key, std::size_t count) {
  if (!line.contains(key)) return {};
  std::vector<double> us = numbers_in(line, key);
  if (us.size() != count) broken(key);
  return us;
}

/// The answers of one peer, judged; throws `BrokenAnswer`.
std::vector<SolvedProblem> answers_in(const PlanSet& set, const KnownProblems& known,
                                      const BenchEntry& entry, const JsonValue& line) {
  const JsonValue& ids = list_in(line, "problems");
  auto paths = tables_in(line, "paths");
  if (paths.size() != ids.size()) broken("paths");
  if (entry.us.size() != ids.size()) broken("us");
  const std::vector<double> world = clock_in(line, "world", ids.size());
  std::vector<SolvedProblem> answers;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const auto problem = known.find(ids[i].string());
    if (problem == known.end()) broken("problems");
    SolvedProblem& answer = answers.emplace_back(
        SolvedProblem{.problem = problem->second, .path = std::move(paths[i]), .us = entry.us[i]});
    if (!world.empty()) answer.world_us = world[i];
  }
  judge_answers(set, answers);
  return answers;
}

/// The same run, timed by the clock inside of the peer.
PlanRun timed_inside(PlanRun run, const std::vector<double>& own) {
  run.who += text(msg::bench_plan_own_clock);
  run.timed = "c++";
  for (std::size_t i = 0; i < own.size(); ++i) {
    run.answers[i].us = own[i];
    run.answers[i].world_us = 0;
  }
  return run;
}

}  // namespace

Result<std::vector<PlanRun>> run_plan_peers(const PlanSet& set, const PlanScene& scene,
                                            const PlanPeers& peers) {
  constexpr double kStart = 60;  // [s] to get ready
  KnownProblems known;
  std::vector<std::string> ids;
  for (const std::size_t index : scene.problems) {
    ids.push_back(set.cases[index].id);
    known.emplace(ids.back(), index);
  }
  JsonDoc job{{"file", std::filesystem::absolute(set.file).string()},
              {"problems", ids},
              {"every", peers.every},
              {"limit", peers.limit},
              {"seconds", kStart + 2 * peers.limit * static_cast<double>(ids.size())}};
  std::vector<PlanRun> runs;
  const auto take = [&](BenchEntry entry, const JsonValue& line) {
    PlanRun& run = runs.emplace_back(PlanRun{std::move(entry)});
    if (!run.error.empty()) return;
    run.answers = answers_in(set, known, run, line);
    const std::vector<double> own = clock_in(line, "own", run.answers.size());
    if (!own.empty()) runs.push_back(timed_inside(run, own));
  };
  if (auto done = run_peers(peers.environment, "planning", std::move(job), take); !done) {
    return fail(std::move(done.error()));
  }
  return runs;
}

}  // namespace mjarm::app
