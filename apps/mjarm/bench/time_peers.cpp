#include "apps/mjarm/bench/time_peers.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "apps/mjarm/bench/peers.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/messages/bench.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;

constexpr std::size_t kLargest = std::size_t{1} << 30;  // [bytes] of a file of states

std::vector<double> list(const JointVec& values) { return {values.begin(), values.end()}; }

json case_json(const TimeSet& set, const TimeCase& entry) {
  if (set.problem == TimeProblem::p2p) {
    return {{"q0", list(entry.start.q)}, {"v0", list(entry.start.v)}, {"a0", list(entry.start.a)},
            {"q1", list(entry.end.q)},   {"v1", list(entry.end.v)},   {"a1", list(entry.end.a)}};
  }
  json points = json::array();
  for (const JointVec& q : entry.waypoints) points.push_back(list(q));
  return {{"waypoints", std::move(points)}};
}

const char* problem_name(TimeProblem problem) {
  switch (problem) {
    case TimeProblem::p2p:
      return "p2p";
    case TimeProblem::path_va:
      return "path_va";
    case TimeProblem::path_vaj:
      return "path_vaj";
    case TimeProblem::via_vaj:
      return "via_vaj";
  }
  return "";
}

json job_of(const std::vector<TimeSet>& sets, int rounds) {
  json job = {{"rounds", rounds}, {"sets", json::array()}};
  for (const TimeSet& set : sets) {
    json cases = json::array();
    for (const TimeCase& entry : set.cases) cases.push_back(case_json(set, entry));
    job["sets"].push_back({{"name", set.name},
                           {"problem", problem_name(set.problem)},
                           {"samples", samples_of(set.problem)},
                           {"limits",
                            {{"v", list(set.limits.velocity)},
                             {"a", list(set.limits.acceleration)},
                             {"j", list(set.limits.jerk)}}},
                           {"cases", std::move(cases)}});
  }
  return job;
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

/// Judges the motions of one answer; throws json's exceptions.
Result<void> judge(const TimeSet& set, const json& line, TimeRun& run) {
  const Result<std::string> content = read_file(line.at("states").get<std::string>(), kLargest);
  if (!content) return fail(content.error());
  std::vector<double> values(content->size() / sizeof(double));
  std::memcpy(values.data(), content->data(), values.size() * sizeof(double));
  const Eigen::Index dof = set.limits.velocity.size();
  const int count = samples_of(set.problem) + 1;
  const std::size_t size = static_cast<std::size_t>(count * 3 * dof);
  std::size_t at = 0;
  for (const json& duration : line.at("durations")) {
    if (run.motions.size() == set.cases.size()) break;
    if (duration.is_null()) {
      run.motions.push_back({.reason = text(msg::bench_time_none)});
      continue;
    }
    if (values.size() - at < size) {
      return fail(Errc::system, text(msg::bench_bad_answer, line.at("states").get<std::string>()));
    }
    const TimeCase& entry = set.cases[run.motions.size()];
    run.motions.push_back(judge_motion(set, entry, duration.get<double>(),
                                       states_from(values.data() + at, count, dof)));
    at += size;
  }
  return {};
}

}  // namespace

Result<std::vector<TimeRun>> run_time_peers(const std::vector<TimeSet>& sets,
                                            const std::filesystem::path& environment, int rounds) {
  std::vector<TimeRun> runs;
  const auto take = [&](BenchEntry entry, const json& line) -> Result<void> {
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
