#include "mjarm/rl/training.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/rl.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/rl/option_table_internal.hpp"
#include "mjarm/rl/progress_log_internal.hpp"
#include "mjarm/rl/reach_env.hpp"
#include "mjarm/rl/safetensors.hpp"
#include "mjarm/rl/training_config.hpp"

namespace mjarm::rl {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();
constexpr const char* kBestEvaluation = "training.best";
constexpr const char* kLastEvaluation = "training.last";

// An evaluation in a checkpoint: what is told of it, without the single distances.
using Numbers = std::array<double Evaluation::*, 11>;
constexpr Numbers kNumbers = {
    &Evaluation::within_5cm, &Evaluation::within_2cm, &Evaluation::within_1cm,
    &Evaluation::within_5mm, &Evaluation::median,     &Evaluation::p95,
    &Evaluation::max,        &Evaluation::steps,      &Evaluation::steps_to_2cm,
    &Evaluation::turn_p95,   &Evaluation::touched};

void store(const std::optional<Evaluation>& evaluation, const char* name, TensorSet& set) {
  if (!evaluation) return;
  std::vector<double> values = {static_cast<double>(evaluation->episodes), evaluation->turn_median};
  for (const auto number : kNumbers) values.push_back((*evaluation).*number);
  set.tensors[name] = {{static_cast<std::int64_t>(values.size())}, std::move(values)};
}

/// @return an error where the file holds something else under that name.
Result<std::optional<Evaluation>> stored(const TensorSet& set, const char* name) {
  const auto found = set.tensors.find(name);
  if (found == set.tensors.end()) return std::nullopt;
  const auto* values = std::get_if<std::vector<double>>(&found->second.values);
  if (values == nullptr || values->size() != kNumbers.size() + 2) {
    return fail(Errc::bad_input, text(msg::rl_tensor_type, name, "float64"));
  }
  constexpr double kMaxEpisodes = 1e5;
  for (std::size_t i = 0; i < values->size(); ++i) {
    // First the number of episodes and the median of the turns; then shares up to the distances,
    // which are infinite where a simulation failed; the last one is a share again.
    const bool share = (i >= 2 && i < 6) || i + 1 == values->size();
    const double value = (*values)[i], most = share ? 1 : i == 0 ? kMaxEpisodes : kNoLimit;
    if (value >= (i == 0 ? 1 : 0) && value <= most) continue;
    const Msg expected = share ? msg::rl_share : msg::rl_not_negative;
    return fail(Errc::bad_input, text(msg::rl_tensor_value, name, value, text(expected)));
  }
  Evaluation evaluation;
  evaluation.episodes = static_cast<int>((*values)[0]);
  evaluation.turn_median = (*values)[1];
  for (std::size_t i = 0; i < kNumbers.size(); ++i) {
    evaluation.*kNumbers[i] = (*values)[i + 2];
  }
  return evaluation;
}

std::string last_name(int rank) {
  return rank == 0 ? Training::kLast : "last.rank" + std::to_string(rank) + ".safetensors";
}

}  // namespace

int training_threads() {
  constexpr int kMaxThreads = 16;
  return std::min(core_count(), kMaxThreads);
}

PpoOptions reach_ppo() {
  PpoOptions options;
  options.rollout_steps = 64;
  options.minibatch = 512;
  options.discount = 0.9;
  options.gae_lambda = 0.9;
  options.initial_log_std = -1.5;
  return options;
}

TrainingOptions reach_training(ReachRegion region) {
  TrainingOptions options;
  options.task.region = region;
  if (region == ReachRegion::wide) {
    options.task.episode_steps = 60;
    options.ppo.total_steps = 400000;
  }
  return options;
}

double score(const Evaluation& evaluation) noexcept {
  const double shares =
      evaluation.within_5cm + evaluation.within_2cm + evaluation.within_1cm + evaluation.within_5mm;
  const double near = std::isfinite(evaluation.median) ? std::exp(-evaluation.median / 0.01) : 0;
  return shares + near / (2 * std::max(evaluation.episodes, 1));
}

double share_within(const Evaluation& evaluation, double distance) noexcept {
  if (distance >= 0.05) return evaluation.within_5cm;
  if (distance >= 0.02) return evaluation.within_2cm;
  if (distance >= 0.01) return evaluation.within_1cm;
  return distance >= 0.005 ? evaluation.within_5mm : 0;
}

bool is_good_enough(const TrainingOptions& options,
                    const std::optional<Evaluation>& evaluation) noexcept {
  return options.stop_share <= 0 ||
         (evaluation && share_within(*evaluation, options.stop_within) >= options.stop_share);
}

struct Training::State {
  State(const Model& task_model, const TrainingOptions& how, ReachEnv made_env)
      : model(task_model), options(how), env(std::move(made_env)) {}

  [[nodiscard]] int rank() const { return ranks == nullptr ? 0 : ranks->rank(); }
  [[nodiscard]] bool is_time_to_evaluate(std::int64_t steps_before) const;
  /// What is asked for, where something is.
  [[nodiscard]] bool reached() const {
    return options.stop_share > 0 && is_good_enough(options, last);
  }
  [[nodiscard]] Result<void> evaluate_now(TrainingStep& step);
  [[nodiscard]] Result<void> save(const TrainingStep& step);
  [[nodiscard]] Result<void> save_best();
  [[nodiscard]] Result<void> add_row(const TrainingStep& step);

  Model model;
  TrainingOptions options;
  ReachEnv env;
  std::optional<PpoTrainer> trainer;
  Ranks* ranks = nullptr;
  std::filesystem::path folder;
  std::map<std::string, std::string> metadata;
  std::optional<detail::ProgressLog> log;  ///< of rank 0
  std::optional<Evaluation> last, best;
  bool stopped = false;
  std::int64_t resumed_at = kNoStep;  ///< steps of the checkpoint
};

bool Training::State::is_time_to_evaluate(std::int64_t steps_before) const {
  const std::int64_t every = options.evaluate_every;
  return trainer->steps() / every != steps_before / every ||
         trainer->steps() >= options.ppo.total_steps;
}

Result<void> Training::State::evaluate_now(TrainingStep& step) {
  Result<Evaluation> found = evaluate(model, options.task, trainer->policy(), options.evaluation);
  if (!found) return fail(std::move(found.error()));
  last = std::move(*found);
  step.evaluation = last;
  step.best = !best || score(*last) > score(*best);
  if (step.best) best = last;
  stopped = reached();
  return {};
}

Result<void> Training::State::save_best() {
  TensorSet set = trainer->policy().tensors();
  set.metadata.insert(metadata.begin(), metadata.end());
  set.metadata["steps"] = std::to_string(trainer->steps());
  store(best, kBestEvaluation, set);
  return save_safetensors(folder / kBest, set);
}

Result<void> Training::State::save(const TrainingStep& step) {
  if (step.best) {
    if (auto saved = save_best(); !saved) return saved;
  }
  if (rank() == 0) {
    if (auto logged = add_row(step); !logged) return logged;
  }
  TensorSet set = trainer->checkpoint();
  set.metadata.insert(metadata.begin(), metadata.end());
  store(best, kBestEvaluation, set);
  store(last, kLastEvaluation, set);
  return save_safetensors(folder / last_name(rank()), set);
}

Result<void> Training::State::add_row(const TrainingStep& step) {
  if (!log) {  // opened so late that a training that cannot begin leaves old files alone
    auto opened = detail::ProgressLog::open(folder, resumed_at);
    if (!opened) return fail(std::move(opened.error()));
    log = std::move(*opened);
  }
  return log->add(step);
}

Training::Training(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
Training::~Training() = default;
Training::Training(Training&&) noexcept = default;
Training& Training::operator=(Training&&) noexcept = default;

Result<Training> Training::create(const Model& model, const TrainingOptions& options,
                                  const std::filesystem::path& folder, Ranks* ranks) {
  detail::RangeCheck ranges;
  detail::visit_training(options, ranges);
  if (auto fine = ranges.result(); !fine) return fail(std::move(fine.error()));
  Result<ReachEnv> env = ReachEnv::create(model, options.task);
  if (!env) return fail(std::move(env.error()));
  auto state = std::make_unique<State>(model, options, std::move(*env));
  state->folder = folder;
  state->metadata = {{"task", "reach"}, {"config", config_text(options)}};
  state->ranks = ranks;
  Result<PpoTrainer> trainer = PpoTrainer::create(state->env, options.ppo, ranks);
  if (!trainer) return fail(std::move(trainer.error()));
  state->trainer = std::move(*trainer);
  return Training(std::move(state));
}

Result<void> Training::resume(const std::filesystem::path& checkpoint) {
  const int rank = state_->rank();
  const Result<TensorSet> set =
      load_safetensors(rank == 0 ? checkpoint : checkpoint.parent_path() / last_name(rank));
  if (!set) return fail(set.error());
  Result<std::optional<Evaluation>> best = stored(*set, kBestEvaluation);
  Result<std::optional<Evaluation>> last = stored(*set, kLastEvaluation);
  for (const auto* evaluation : {&best, &last}) {
    if (*evaluation) continue;
    return fail(evaluation->error().code,
                text(msg::core_at_place, checkpoint.string(), evaluation->error().what));
  }
  if (auto restored = state_->trainer->restore(*set); !restored) return restored;
  state_->best = std::move(*best);
  state_->last = std::move(*last);
  state_->stopped = state_->reached();
  state_->resumed_at = state_->trainer->steps();
  return {};
}

bool Training::done() const noexcept {
  return state_->stopped || state_->trainer->steps() >= state_->options.ppo.total_steps;
}

Result<TrainingStep> Training::advance() {
  const std::int64_t before = state_->trainer->steps();
  Result<IterationReport> iteration = state_->trainer->iterate();
  if (!iteration) return fail(std::move(iteration.error()));
  TrainingStep step{*iteration};
  Result<void> done;
  if (state_->is_time_to_evaluate(before)) {
    if (state_->rank() == 0) done = state_->evaluate_now(step);
    state_->stopped = on_any_rank(state_->ranks, state_->stopped);
  }
  if (done) done = state_->save(step);
  if (on_any_rank(state_->ranks, !done) && done)
    done = fail(Errc::impossible, text(msg::rl_failed_rank));
  if (!done) return fail(std::move(done.error()));
  return step;
}

const PpoTrainer& Training::trainer() const noexcept { return *state_->trainer; }
const std::optional<Evaluation>& Training::last_evaluation() const noexcept { return state_->last; }
const std::optional<Evaluation>& Training::best_evaluation() const noexcept { return state_->best; }

}  // namespace mjarm::rl
