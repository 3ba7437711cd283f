#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "apps/bench/plan.hpp"

namespace mjarm::app {
namespace {

using Motion = double SolvedProblem::*;

bool has(const SolvedProblem& answer, Motion motion) {
  return answer.valid() && answer.*motion > 0;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / std::max<double>(1, static_cast<double>(values.size()));
}

std::vector<double> motions_of(const PlanRun& run, Motion motion) {
  std::vector<double> out;
  for (const SolvedProblem& answer : run.answers) {
    if (has(answer, motion)) out.push_back(answer.*motion);
  }
  return out;
}

/// Ours over those of a peer, problem by problem.
std::vector<double> ratios_of(const PlanRun& ours, Motion motion, const PlanRun& peer) {
  std::map<std::size_t, double> theirs;
  for (const SolvedProblem& answer : peer.answers) {
    if (has(answer, &SolvedProblem::motion_s)) theirs[answer.problem] = answer.motion_s;
  }
  std::vector<double> out;
  for (const SolvedProblem& answer : ours.answers) {
    const auto same = theirs.find(answer.problem);
    if (same != theirs.end() && has(answer, motion)) out.push_back(answer.*motion / same->second);
  }
  return out;
}

std::string told(const std::vector<double>& ratios) {
  return fmt::format("{:.3f} ({:.2f})", mean_of(ratios), std::ranges::max(ratios));
}

JsonDoc json_of(const std::vector<double>& ratios) {
  return {{"problems", ratios.size()},
          {"mean", mean_of(ratios)},
          {"median", percentile(ratios, 50)},
          {"max", std::ranges::max(ratios)}};
}

}  // namespace

void add_motions(const PlanRun& run, const PlanRun* ours, BenchEntry& entry) {
  const std::vector<double> free = motions_of(run, &SolvedProblem::motion_s);
  const std::vector<double> smooth = motions_of(run, &SolvedProblem::jerk_limited_s);
  std::string seconds = free.empty() ? "-" : fmt::format("{:.3f}", mean_of(free));
  if (!free.empty()) entry.details.set("motion_s", mean_of(free));
  if (!smooth.empty()) {
    seconds += fmt::format(" / {:.3f}", mean_of(smooth));
    entry.details.set("jerk_limited_motion_s", mean_of(smooth));
  }
  entry.cells.push_back(seconds);
  std::string ratio = "-";
  if (ours != nullptr && !run.version.empty()) {
    const std::vector<double> without = ratios_of(*ours, &SolvedProblem::motion_s, run);
    const std::vector<double> with = ratios_of(*ours, &SolvedProblem::jerk_limited_s, run);
    if (!without.empty() && !with.empty()) {
      ratio = told(without) + " / " + told(with);
      entry.details.set("motion_ratio", json_of(without));
      entry.details.set("jerk_limited_motion_ratio", json_of(with));
    }
  }
  entry.cells.push_back(ratio);
}

}  // namespace mjarm::app
