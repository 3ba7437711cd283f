#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "mjarm/rl/progress_log_internal.hpp"

namespace mjarm::rl::detail {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// A column of the CSV, its name for TensorBoard, and where it comes from.
struct Column {
  const char* name;
  const char* tag;
  double (*value)(const TrainingStep& step);
};

double of(const TrainingStep& step, double IterationReport::* member) {
  return step.iteration.*member;
}
double of(const TrainingStep& step, double Evaluation::* member) {
  return step.evaluation ? (*step.evaluation).*member : kNone;
}
double of_episodes(const TrainingStep& step, double IterationReport::* member) {
  return step.iteration.episodes > 0 ? step.iteration.*member : kNone;
}

using Step = TrainingStep;
constexpr Column kColumns[] = {
    {"mean_return", "rollout/mean_return",
     [](const Step& s) { return of_episodes(s, &IterationReport::mean_return); }},
    {"mean_length", "rollout/mean_length",
     [](const Step& s) { return of_episodes(s, &IterationReport::mean_length); }},
    {"policy_loss", "train/policy_loss",
     [](const Step& s) { return of(s, &IterationReport::policy_loss); }},
    {"value_loss", "train/value_loss",
     [](const Step& s) { return of(s, &IterationReport::value_loss); }},
    {"entropy", "train/entropy", [](const Step& s) { return of(s, &IterationReport::entropy); }},
    {"kl", "train/kl", [](const Step& s) { return of(s, &IterationReport::kl); }},
    {"clip_fraction", "train/clip_fraction",
     [](const Step& s) { return of(s, &IterationReport::clip_fraction); }},
    {"explained_variance", "train/explained_variance",
     [](const Step& s) { return of(s, &IterationReport::explained_variance); }},
    {"gradient_norm", "train/gradient_norm",
     [](const Step& s) { return of(s, &IterationReport::gradient_norm); }},
    {"learning_rate", "train/learning_rate",
     [](const Step& s) { return of(s, &IterationReport::learning_rate); }},
    {"mean_std", "train/mean_std", [](const Step& s) { return of(s, &IterationReport::mean_std); }},
    {"within_5cm", "evaluation/within_5cm",
     [](const Step& s) { return of(s, &Evaluation::within_5cm); }},
    {"within_2cm", "evaluation/within_2cm",
     [](const Step& s) { return of(s, &Evaluation::within_2cm); }},
    {"within_1cm", "evaluation/within_1cm",
     [](const Step& s) { return of(s, &Evaluation::within_1cm); }},
    {"within_5mm", "evaluation/within_5mm",
     [](const Step& s) { return of(s, &Evaluation::within_5mm); }},
    {"median", "evaluation/median", [](const Step& s) { return of(s, &Evaluation::median); }},
    {"p95", "evaluation/p95", [](const Step& s) { return of(s, &Evaluation::p95); }}};

}  // namespace

Result<ProgressLog> ProgressLog::open(const std::filesystem::path& folder, std::int64_t keep) {
  std::vector<std::string> names, tags;
  for (const Column& column : kColumns) {
    names.emplace_back(column.name);
    tags.emplace_back(column.tag);
  }
  Result<CsvLog> csv = CsvLog::open(folder / Training::kProgress, std::move(names), keep);
  if (!csv) return fail(std::move(csv.error()));
  Result<EventLog> events = EventLog::open(folder / Training::kEvents, std::move(tags), keep);
  if (!events) return fail(std::move(events.error()));
  return ProgressLog(std::move(*csv), std::move(*events));
}

Result<void> ProgressLog::add(const TrainingStep& step) {
  std::vector<double> values;
  for (const Column& column : kColumns) values.push_back(column.value(step));
  if (auto added = csv_.append(step.iteration.steps, values); !added) return added;
  return events_.append(step.iteration.steps, values);
}

}  // namespace mjarm::rl::detail
