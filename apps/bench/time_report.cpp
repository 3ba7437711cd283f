#include "apps/bench/time_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "apps/bench/messages/bench.hpp"

namespace mjarm::app {
namespace {

bool right(const TimedMotion& motion) {
  return motion.reason.empty() && motion.holds && motion.arrives;
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

}  // namespace

std::vector<Msg> time_columns() {
  return {msg::bench_time_solved, msg::bench_time_duration, msg::bench_time_longest,
          msg::bench_time_use, msg::bench_time_beyond};
}

BenchEntry time_entry(const TimeSet& set, const TimeRun& run, std::span<const double> best) {
  BenchEntry entry = run;
  int solved = 0, beyond = 0;
  double use = 0;
  std::vector<JsonDoc> wrong;
  for (std::size_t i = 0; i < run.motions.size(); ++i) {
    const TimedMotion& motion = run.motions[i];
    solved += motion.reason.empty() && motion.arrives ? 1 : 0;
    beyond += motion.holds ? 0 : 1;
    use = std::max(use, motion.use);
    if (right(motion)) continue;
    wrong.push_back(
        {{"case", set.cases[i].id}, {"reason", reason_of(motion)}, {"use", motion.use}});
  }
  const std::size_t asked = run.motions.size();
  const Ratio ratio = ratio_of(run, best);
  const auto exact = [](double share) { return share > 0 ? fmt::format("{:.4f}", share) : "-"; };
  std::string share = std::to_string(solved) + "/" + std::to_string(asked);
  if (asked < set.cases.size()) share += " " + text(msg::bench_first, asked);
  entry.cells = {share, exact(ratio.mean), exact(ratio.worst),
                 use > 0 ? fmt::format("{:.2f} %", 100 * use) : "-", std::to_string(beyond)};
  entry.details = {{"cases", asked},
                   {"solved", solved},
                   {"duration", {{"mean", ratio.mean}, {"worst", ratio.worst}}},
                   {"use", use},
                   {"beyond", beyond},
                   {"wrong", std::move(wrong)}};
  return entry;
}

int wrong_motions(const TimeRun& run) {
  return static_cast<int>(std::count_if(run.motions.begin(), run.motions.end(),
                                        [](const TimedMotion& m) { return !right(m); }));
}

}  // namespace mjarm::app
