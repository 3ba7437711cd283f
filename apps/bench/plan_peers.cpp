#include "apps/bench/plan_peers.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/messages/bench_plan.hpp"
#include "apps/bench/peers.hpp"

namespace mjarm::app {
namespace {

/// Index of each of the problems that a peer was asked, by id.
using KnownProblems = std::map<std::string, std::size_t>;

tl::unexpected<Error> broken(const char* member) {
  return fail(Errc::system, text(msg::bench_bad_answer, member));
}

/// Times of another clock; none where the peer has none. Throws `BrokenAnswer`.
Result<std::vector<double>> clock_in(const JsonValue& line, const char* key, std::size_t count) {
  if (!line.contains(key)) return std::vector<double>();
  std::vector<double> us = numbers_in(line, key);
  if (us.size() != count) return broken(key);
  return us;
}

/// The answers of one peer, judged; throws `BrokenAnswer`.
Result<std::vector<SolvedProblem>> answers_in(const PlanSet& set, const KnownProblems& known,
                                              const BenchEntry& entry, const JsonValue& line) {
  const JsonValue& ids = list_in(line, "problems");
  auto paths = tables_in(line, "paths");
  if (paths.size() != ids.size()) return broken("paths");
  if (entry.us.size() != ids.size()) return broken("us");
  const auto world = clock_in(line, "world", ids.size());
  if (!world) return fail(world.error());
  std::vector<SolvedProblem> answers;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const auto problem = known.find(ids[i].string());
    if (problem == known.end()) return broken("problems");
    SolvedProblem& answer = answers.emplace_back(
        SolvedProblem{.problem = problem->second, .path = std::move(paths[i]), .us = entry.us[i]});
    if (!world->empty()) answer.world_us = (*world)[i];
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

Result<std::vector<PlanRun>> run_plan_peers(const PlanSet& set,
                                            std::span<const std::size_t> problems,
                                            const PlanPeers& peers) {
  constexpr double kStart = 60;  // [s] to get ready
  KnownProblems known;
  std::vector<std::string> ids;
  for (const std::size_t index : problems) {
    ids.push_back(set.cases[index].id);
    known.emplace(ids.back(), index);
  }
  JsonDoc job{{"file", std::filesystem::absolute(set.file).string()},
              {"problems", ids},
              {"every", peers.every},
              {"limit", peers.limit},
              {"seconds", kStart + 2 * peers.limit * static_cast<double>(ids.size())}};
  std::vector<PlanRun> runs;
  const auto take = [&](BenchEntry entry, const JsonValue& line) -> Result<void> {
    PlanRun& run = runs.emplace_back(PlanRun{std::move(entry)});
    if (!run.error.empty()) return {};
    auto answers = answers_in(set, known, run, line);
    if (!answers) return fail(std::move(answers.error()));
    run.answers = std::move(*answers);
    const auto own = clock_in(line, "own", run.answers.size());
    if (!own) return fail(own.error());
    if (!own->empty()) runs.push_back(timed_inside(run, *own));
    return {};
  };
  if (auto done = run_peers(peers.environment, "planning", std::move(job), take); !done) {
    return fail(std::move(done.error()));
  }
  return runs;
}

}  // namespace mjarm::app
