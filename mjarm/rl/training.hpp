#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "mjarm/core/ranks.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/rl/evaluate.hpp"
#include "mjarm/rl/ppo.hpp"
#include "mjarm/rl/ppo_trainer.hpp"
#include "mjarm/rl/reach_options.hpp"

namespace mjarm::rl {

/// PPO as it learns to reach fast, found by trying on the default task.
[[nodiscard]] PpoOptions reach_ppo();

/// How long to train, how often to look how good it is, and when that is good enough.
struct TrainingOptions {
  ReachOptions task = {};
  PpoOptions ppo = reach_ppo();         ///< `total_steps` is where the training ends at the latest
  std::int64_t evaluate_every = 50000;  ///< steps between evaluations, > 0; the end has one too
  EvaluateOptions evaluation = {};      ///< of the mean actions, on goals never trained on
  double stop_within = 0.02;            ///< [m] see `share_within`
  double stop_share = 0;                ///< ends once so many goals are reached within
                                        ///< `stop_within`, 0 to 1; 0: never
};

/// The defaults for a region: a wider one has longer ways and takes more steps to learn.
[[nodiscard]] TrainingOptions reach_training(ReachRegion region);

/// Threads for a small network on this machine: one a core, and no more than it can feed.
[[nodiscard]] int training_threads();

/// What one iteration brought.
struct TrainingStep {
  IterationReport iteration;
  std::optional<Evaluation> evaluation = {};  ///< where it was time for one
  bool best = false;                          ///< better than every evaluation before
};

/// Orders evaluations: the sum of the four shares, and below that, so that small steps count, how
/// near the middle one came.
[[nodiscard]] double score(const Evaluation& evaluation) noexcept;

/// Share of the goals reached within the largest of 5, 2, 1 and 0.5 cm that is not above `distance`
/// [m]; 0 below.
[[nodiscard]] double share_within(const Evaluation& evaluation, double distance) noexcept;

/// True where as many goals are reached as the options ask for, or where they ask for none.
[[nodiscard]] bool is_good_enough(const TrainingOptions& options,
                                  const std::optional<Evaluation>& evaluation) noexcept;

/// A training with its files in one folder, each of which is whole at any time:
///
/// - `last.safetensors`: everything to go on from, after each iteration
/// - `best.safetensors`: the policy with the best score so far; both hold the options, see
/// `config_of_checkpoint`
/// - `progress.csv`: one line an iteration
/// - `events.out.tfevents.mjarm`: the same for TensorBoard
///
/// A process that is killed loses the iteration it was in, no more. With several ranks the first
/// writes these files and evaluates; the others keep `last.rank1.safetensors` and so on.
class Training {
 public:
  static constexpr const char* kLast = "last.safetensors";
  static constexpr const char* kBest = "best.safetensors";
  static constexpr const char* kProgress = "progress.csv";
  static constexpr const char* kEvents = "events.out.tfevents.mjarm";

  /// Makes the environment and the trainer.
  /// @param folder    exists before the first `advance`; files of an earlier training in it are
  /// replaced.
  /// @param ranks     null: this process alone; must outlive the training.
  [[nodiscard]] static Result<Training> create(const Model& model, const TrainingOptions& options,
                                               const std::filesystem::path& folder,
                                               Ranks* ranks = nullptr);
  ~Training();
  Training(Training&&) noexcept;
  Training& operator=(Training&&) noexcept;

  /// Goes on from a `last.safetensors`, beside which those of the other ranks stand, as if it had
  /// never stopped: with the same options to the last bit. Call before anything else.
  [[nodiscard]] Result<void> resume(const std::filesystem::path& checkpoint);

  /// True at the end: all steps are done, or the policy is good enough.
  [[nodiscard]] bool done() const noexcept;
  /// One iteration, and its files.
  /// @return an error where a loss is not a number or a file cannot be written; the files then
  ///         stand as after the iteration before.
  [[nodiscard]] Result<TrainingStep> advance();

  [[nodiscard]] const PpoTrainer& trainer() const noexcept;
  /// The last one; none before the first.
  [[nodiscard]] const std::optional<Evaluation>& last_evaluation() const noexcept;
  /// The one of `best.safetensors`.
  [[nodiscard]] const std::optional<Evaluation>& best_evaluation() const noexcept;

 private:
  struct State;
  explicit Training(std::unique_ptr<State> state) noexcept;
  std::unique_ptr<State> state_;
};

}  // namespace mjarm::rl
