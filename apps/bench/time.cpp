#include "apps/bench/time.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

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
void judge_answer(const std::vector<TimeSet>& sets, const JsonValue& line, TimeRun& run) {
  const TimeSet* const set = set_named(sets, run.set);
  if (set == nullptr) broken(run.set);
  const std::string file = text_in(line, "states");
  const Result<std::string> content = read_file(file, kMaxStateBytes);
  if (!content) throw BrokenAnswer{content.error()};
  std::vector<double> values(content->size() / sizeof(double));
  if (!values.empty()) {
    std::memcpy(values.data(), content->data(), values.size() * sizeof(double));
  }
  const Eigen::Index dof = set->limits.velocity.size();
  const int count = samples_of(set->problem) + 1;
  const std::size_t size = static_cast<std::size_t>(count * 3 * dof);
  std::size_t at = 0;
  for (const double duration : numbers_in(line, "durations")) {
    if (run.motions.size() == set->cases.size()) break;
    if (std::isnan(duration)) {
      run.motions.push_back({.reason = text(msg::bench_time_none)});
      continue;
    }
    if (values.size() - at < size) broken(file);
    const TimeCase& entry = set->cases[run.motions.size()];
    run.motions.push_back(
        judge_motion(*set, entry, duration, states_from(values.data() + at, count, dof)));
    at += size;
  }
}

/// Durations over those to compare with.
struct Ratio {
  double mean = 0, worst = 0;
};
Ratio ratio_of(const TimeRun& run, std::span<const double> best) {
  Ratio ratio;
  int count = 0;
  for (std::size_t i = 0; i < std::min(best.size(), run.motions.size()); ++i) {
    if (!run.motions[i].reason.empty() || !(best[i] > 0)) continue;
    const double share = run.motions[i].duration / best[i];
    ratio.mean += share;
    ratio.worst = std::max(ratio.worst, share);
    ++count;
  }
  ratio.mean /= std::max(count, 1);
  return ratio;
}

std::string reason_of(const TimedMotion& motion) {
  if (!motion.reason.empty()) return motion.reason;
  return motion.arrives ? "limit" : "misses";
}

/// The cells of a run and, for the JSON document, every case that is not right.
/// @param best  [s] durations to compare with, one a case; empty where there are none.
/// @return how many cases have no motion, pass a limit or do not arrive.
int describe(const TimeSet& set, std::span<const double> best, TimeRun& run) {
  int solved = 0, beyond = 0;
  double use = 0, outside = 0;
  std::vector<JsonDoc> wrong;
  for (std::size_t i = 0; i < run.motions.size(); ++i) {
    const TimedMotion& motion = run.motions[i];
    solved += motion.reason.empty() && motion.arrives ? 1 : 0;
    beyond += motion.holds ? 0 : 1;
    use = std::max(use, motion.use);
    outside = std::max(outside, motion.outside);
    if (motion.reason.empty() && motion.holds && motion.arrives) continue;
    wrong.push_back(
        {{"case", set.cases[i].id}, {"reason", reason_of(motion)}, {"use", motion.use}});
  }
  const int count = static_cast<int>(wrong.size());
  const std::size_t asked = run.motions.size();
  const Ratio ratio = ratio_of(run, best);
  const auto exact = [](double share) { return share > 0 ? fmt::format("{:.4f}", share) : "-"; };
  run.cells = {count_of(solved, asked, set.cases.size()), exact(ratio.mean), exact(ratio.worst),
               use > 0 ? fmt::format("{:.2f} %", 100 * use) : "-", std::to_string(beyond)};
  run.details = {{"cases", asked},
                 {"solved", solved},
                 {"duration", {{"mean", ratio.mean}, {"worst", ratio.worst}}},
                 {"use", use},
                 {"outside", outside},
                 {"beyond", beyond},
                 {"wrong", std::move(wrong)}};
  return count;
}

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

Result<BenchResult> measure_time(const BenchOptions& options, const std::string& robot,
                                 int rounds) {
  const Result<std::vector<TimeSet>> sets = load_time_sets(robot, options.data);
  if (!sets) return fail(sets.error());
  const std::string name = std::filesystem::path(robot).stem().string();
  Progress progress(text(msg::bench_time_progress, name),
                    sets->size() * static_cast<std::size_t>(rounds));
  std::vector<TimeRun> ours;
  for (const TimeSet& set : *sets) ours.push_back(run_time(set, rounds, progress));
  const auto run_peers = [&] {
    return peer_runs<TimeRun>(
        options.peers, "timing", job_of(*sets, rounds),
        [&](const JsonValue& line, TimeRun& run) { judge_answer(*sets, line, run); });
  };
  const auto judge_run = [&](TimeRun& run) -> Result<int> {
    const TimeSet* const set = set_named(*sets, run.set);
    return set == nullptr ? 0 : describe(*set, reference(*set, ours), run);  // 0: it failed
  };
  return compare(options.peers, {name, {}}, ours, run_peers, judge_run, msg::bench_time_wrong);
}

std::vector<Msg> time_columns() {
  return {msg::bench_time_solved, msg::bench_time_duration, msg::bench_time_longest,
          msg::bench_time_use, msg::bench_time_beyond};
}

}  // namespace

Command time_suite() {
  return {"time", msg::bench_time_summary, msg::bench_time_examples, [](CLI::App& app) {
            return setup_robots(app, msg::bench_time_option_data, false, time_columns(),
                                measure_time);
          }};
}

}  // namespace mjarm::app
