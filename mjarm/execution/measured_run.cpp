#include "mjarm/execution/measured_run.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mjarm {

std::vector<MeasuredRun> measured_runs(const Recorder& recorder,
                                       std::span<const MeasuredSpan> spans) {
  std::vector<MeasuredRun> runs;
  for (const MeasuredSpan& span : spans) {
    runs.push_back({.rows = {}, .curve = span.curve ? &*span.curve : nullptr});
  }
  // Runs follow each other; a row at the border of two belongs to both. Where there are two rows of
  // one time, another execution began, and the arm may have been put somewhere else in between: the
  // first one is of what ends there, the second one of what begins.
  std::size_t first = 0;
  RecordRow row, next;
  if (recorder.size() > 0) next = recorder.row(0);
  for (std::size_t i = 0; i < recorder.size(); ++i) {
    const bool second = i > 0 && row.time == next.time;
    row = std::move(next);
    if (i + 1 < recorder.size()) next = recorder.row(i + 1);
    const bool former = i + 1 < recorder.size() && next.time == row.time;
    while (first < runs.size() && spans[first].to < row.time) ++first;
    for (std::size_t k = first; k < runs.size() && spans[k].from <= row.time; ++k) {
      const bool lasts = spans[k].to > spans[k].from;
      if (lasts && second && spans[k].to <= row.time) continue;
      if (lasts && former && spans[k].from >= row.time) continue;
      RecordRow& kept = runs[k].rows.emplace_back(row);
      kept.X_ref = kept.X_ref * spans[k].X_TU;
      kept.X_WT = kept.X_WT * spans[k].X_TU;
    }
  }
  for (MeasuredRun& run : runs) {
    if (run.curve == nullptr) continue;
    std::vector<Eigen::Vector3d> p_W;
    for (const RecordRow& kept : run.rows) p_W.push_back(kept.X_WT.p);
    run.error = path_error(*run.curve, p_W);
  }
  return runs;
}

std::optional<PathError> path_error(std::span<const MeasuredRun> runs) {
  PathError all;
  double sum2 = 0, covered = 0, length = 0;
  std::size_t count = 0;
  for (const MeasuredRun& run : runs) {
    if (!run.error) continue;
    const PathError& error = *run.error;
    sum2 += error.rms * error.rms * static_cast<double>(run.rows.size());
    count += run.rows.size();
    covered += error.coverage * run.curve->length();
    length += run.curve->length();
    if (error.max >= all.max) {
      all.max = error.max;
      all.at = error.at;
    }
  }
  if (count == 0 || length == 0) return std::nullopt;
  all.rms = std::sqrt(sum2 / static_cast<double>(count));
  all.coverage = covered / length;
  return all;
}

std::optional<double> max_tool_speed(std::span<const MeasuredRun> runs) {
  std::optional<double> max;
  for (const MeasuredRun& run : runs) {
    if (!run.error) continue;
    for (std::size_t i = 1; i < run.rows.size(); ++i) {
      const RecordRow &before = run.rows[i - 1], &row = run.rows[i];
      const double speed = (row.X_WT.p - before.X_WT.p).norm() / (row.time - before.time);
      max = std::max(max.value_or(0), speed);
    }
  }
  return max;
}

}  // namespace mjarm
