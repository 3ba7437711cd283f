#include "apps/bench/time_peers.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/peers.hpp"
#include "mjarm/core/file.hpp"

namespace mjarm::app {
namespace {

constexpr std::size_t kMaxStateBytes = std::size_t{1} << 30;  // [bytes] of a file of states

JsonDoc case_json(const TimeSet& set, const TimeCase& entry) {
  if (set.problem == TimeProblem::p2p) {
    return {{"q0", entry.start.q}, {"v0", entry.start.v}, {"a0", entry.start.a},
            {"q1", entry.end.q},   {"v1", entry.end.v},   {"a1", entry.end.a}};
  }
  std::vector<JsonDoc> points(entry.waypoints.begin(), entry.waypoints.end());
  return {{"waypoints", std::move(points)}};
}

JsonDoc job_of(const std::vector<TimeSet>& sets, int rounds) {
  std::vector<JsonDoc> jobs;
  for (const TimeSet& set : sets) {
    std::vector<JsonDoc> cases;
    for (const TimeCase& entry : set.cases) cases.push_back(case_json(set, entry));
    jobs.push_back(
        {{"name", set.name},
         {"problem", name(set.problem)},
         {"samples", samples_of(set.problem)},
         {"limits",
          {{"v", set.limits.velocity}, {"a", set.limits.acceleration}, {"j", set.limits.jerk}}},
         {"cases", std::move(cases)}});
  }
  return {{"rounds", rounds}, {"sets", std::move(jobs)}};
}

/// The states of one motion from raw doubles: of each state q, v and a.
std::vector<JointState> states_from(const double* values, int count, Eigen::Index dof) {
  std::vector<JointState> states;
  for (int i = 0; i < count; ++i, values += 3 * dof) {
    const auto part = [&](int k) {
      return joint_vec({values + k * dof, static_cast<std::size_t>(dof)});
    };
    states.push_back({part(0), part(1), part(2)});
  }
  return states;
}

/// Judges the motions of one answer; throws `BrokenAnswer`.
Result<void> judge(const TimeSet& set, const JsonValue& line, TimeRun& run) {
  const std::string file = text_in(line, "states");
  const Result<std::string> content = read_file(file, kMaxStateBytes);
  if (!content) return fail(content.error());
  std::vector<double> values(content->size() / sizeof(double));
  std::memcpy(values.data(), content->data(), values.size() * sizeof(double));
  const Eigen::Index dof = set.limits.velocity.size();
  const int count = samples_of(set.problem) + 1;
  const std::size_t size = static_cast<std::size_t>(count * 3 * dof);
  std::size_t at = 0;
  for (const double duration : numbers_in(line, "durations")) {
    if (run.motions.size() == set.cases.size()) break;
    if (std::isnan(duration)) {
      run.motions.push_back({.reason = text(msg::bench_time_none)});
      continue;
    }
    if (values.size() - at < size) {
      return fail(Errc::system, text(msg::bench_bad_answer, file));
    }
    const TimeCase& entry = set.cases[run.motions.size()];
    run.motions.push_back(
        judge_motion(set, entry, duration, states_from(values.data() + at, count, dof)));
    at += size;
  }
  return {};
}

}  // namespace

Result<std::vector<TimeRun>> run_time_peers(const std::vector<TimeSet>& sets,
                                            const std::filesystem::path& environment, int rounds) {
  std::vector<TimeRun> runs;
  const auto take = [&](BenchEntry entry, const JsonValue& line) -> Result<void> {
    runs.push_back({std::move(entry)});
    TimeRun& run = runs.back();
    if (!run.error.empty()) return {};
    const auto set = std::find_if(sets.begin(), sets.end(),
                                  [&](const TimeSet& known) { return known.name == run.set; });
    if (set == sets.end()) return fail(Errc::system, text(msg::bench_bad_answer, run.set));
    return judge(*set, line, run);
  };
  const Result<void> done = run_peers(environment, "timing", job_of(sets, rounds), take);
  if (!done) return fail(done.error());
  return runs;
}

}  // namespace mjarm::app
