#include "mjarm/rl/training.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "mjarm/rl/reach_env.hpp"
#include "mjarm/rl/reach_test.hpp"
#include "mjarm/rl/safetensors.hpp"
#include "tests/support/rounds.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::rl {
namespace {

using ::testing::HasSubstr;
using testing::task_model;

constexpr const char* kFiles[] = {Training::kLast, Training::kBest, Training::kProgress,
                                  Training::kEvents};

/// A training of a few seconds at most: small networks, few goals.
TrainingOptions small_training() {
  TrainingOptions options;
  options.task.environments = 8;
  options.ppo.threads = options.task.threads = 1;
  options.ppo.rollout_steps = 16;
  options.ppo.minibatch = 64;
  options.ppo.epochs = 2;
  options.ppo.actor = options.ppo.critic = {16};
  options.ppo.total_steps = 6 * 8 * 16;
  options.evaluate_every = 2 * 8 * 16;
  options.evaluation.episodes = 4;
  return options;
}

Result<Training> begin(const TrainingOptions& options, const support::TempFolder& folder) {
  return Training::create(task_model(), options, folder.path());
}

void train(Training& training, int iterations) {
  for (int i = 0; i < iterations && !training.done(); ++i) {
    const auto step = training.advance();
    ASSERT_TRUE(step) << step.error().what;
  }
}

TEST(TrainingFiles, AreThereAfterEveryIteration) {
  const support::TempFolder folder;
  auto training = begin(small_training(), folder);
  ASSERT_TRUE(training) << training.error().what;
  train(*training, 1);
  EXPECT_TRUE(folder.exists(Training::kLast));
  EXPECT_FALSE(folder.exists(Training::kBest));  // not evaluated yet
  train(*training, 1);
  ASSERT_TRUE(training->best_evaluation());
  EXPECT_EQ(training->best_evaluation()->episodes, 4);
  const auto best = load_safetensors(folder.path() / Training::kBest);
  ASSERT_TRUE(best) << best.error().what;
  EXPECT_EQ(best->metadata.at("task"), "reach");
  EXPECT_EQ(best->metadata.at("steps"), "256");
  const auto policy = Policy::from(*best);
  ASSERT_TRUE(policy) << policy.error().what;
  const auto again =
      evaluate(task_model(), small_training().task, *policy, small_training().evaluation);
  ASSERT_TRUE(again) << again.error().what;
  EXPECT_EQ(again->median, training->best_evaluation()->median);
  const auto rows = support::lines_of(folder.read(Training::kProgress));
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_THAT(rows[0], ::testing::StartsWith("step,mean_return,"));
  EXPECT_THAT(rows[2], ::testing::StartsWith("256,"));
}

TEST(TrainingFiles, CorruptEvaluationsInACheckpointAreRefused) {
  const support::TempFolder folder;
  auto training = begin(small_training(), folder);
  ASSERT_TRUE(training) << training.error().what;
  train(*training, 2);
  const auto file = folder.path() / Training::kLast;
  const auto good = load_safetensors(file);
  ASSERT_TRUE(good) << good.error().what;
  const auto refused = [&](const char* name, std::size_t place, double value) {
    TensorSet set = *good;
    std::get<std::vector<double>>(set.tensors.at(name).values).at(place) = value;
    EXPECT_TRUE(save_safetensors(file, set));
    auto other = begin(small_training(), folder);
    const auto resumed = other->resume(file);
    EXPECT_FALSE(resumed) << name << place;
    return resumed ? std::string() : resumed.error().what;
  };
  for (const char* name : {"training.best", "training.last"}) {
    for (const double value : {double{INFINITY}, double{NAN}, -0.1, 1.5}) {
      EXPECT_THAT(refused(name, 3, value), HasSubstr("last.safetensors: the tensor \"training."));
    }
    EXPECT_THAT(refused(name, 0, 0), HasSubstr(name));
    EXPECT_THAT(refused(name, 6, NAN), HasSubstr(name));
  }
  EXPECT_TRUE(save_safetensors(file, *good));
  EXPECT_TRUE(begin(small_training(), folder)->resume(file));
}

TEST(TrainingFiles, OfAResumedTrainingAreThoseOfOneThatNeverStopped) {
  const support::TempFolder whole, parts;
  auto straight = begin(small_training(), whole);
  ASSERT_TRUE(straight) << straight.error().what;
  train(*straight, 6);
  EXPECT_TRUE(straight->done());
  {
    auto first = begin(small_training(), parts);
    ASSERT_TRUE(first) << first.error().what;
    train(*first, 3);
    const std::string checkpoint = parts.read(Training::kLast);
    train(*first, 1);  // killed after its rows and before its checkpoint
    parts.write(Training::kLast, checkpoint);
  }
  auto second = begin(small_training(), parts);
  ASSERT_TRUE(second) << second.error().what;
  const auto resumed = second->resume(parts.path() / Training::kLast);
  ASSERT_TRUE(resumed) << resumed.error().what;
  EXPECT_EQ(second->trainer().iterations(), 3);
  train(*second, 3);
  EXPECT_TRUE(second->done());
  for (const char* file : kFiles) EXPECT_EQ(parts.read(file), whole.read(file)) << file;
}

TEST(TrainingFiles, AreTheSameForAnyNumberOfThreads) {
  const support::TempFolder one, three;
  TrainingOptions options = small_training();
  auto first = begin(options, one);
  options.ppo.threads = options.task.threads = 3;
  auto second = begin(options, three);
  ASSERT_TRUE(first && second);
  train(*first, 4);
  train(*second, 4);
  for (const char* file : kFiles) EXPECT_EQ(one.read(file), three.read(file)) << file;
}

TEST(TrainingFiles, OfAnotherTrainingAreRefused) {
  const support::TempFolder folder;
  auto small = begin(small_training(), folder);
  ASSERT_TRUE(small);
  train(*small, 2);
  TrainingOptions wider = small_training();
  wider.ppo.actor = {32};
  auto other = begin(wider, folder);
  ASSERT_TRUE(other);
  const auto mixed = other->resume(folder.path() / Training::kLast);
  ASSERT_FALSE(mixed);
  EXPECT_THAT(mixed.error().what, HasSubstr("actor.0"));
  EXPECT_FALSE(small->resume(folder.path() / Training::kBest));  // a policy is no checkpoint
  EXPECT_FALSE(small->resume(folder.path() / "none.safetensors"));
}

TEST(TrainingFiles, AVanishedFolderIsAnErrorAndNoHalfFile) {
  const support::TempFolder folder;
  auto training = Training::create(task_model(), small_training(), folder.path() / "gone");
  ASSERT_TRUE(training);
  const auto step = training->advance();
  ASSERT_FALSE(step);
  EXPECT_EQ(step.error().code, Errc::system);
  EXPECT_THAT(step.error().what, HasSubstr("gone"));
  EXPECT_FALSE(folder.exists("gone"));
}

TEST(TrainingEnds, WhereThePolicyIsGoodEnough) {
  const support::TempFolder folder;
  TrainingOptions options = small_training();
  options.stop_within = 0.05;
  options.stop_share = 1e-9;  // any policy that reaches one goal; the untrained one reaches none
  auto training = begin(options, folder);
  ASSERT_TRUE(training);
  train(*training, 100);
  EXPECT_TRUE(training->done());
  EXPECT_EQ(training->trainer().steps(), options.ppo.total_steps);
}

TEST(TrainingEnds, SoonWithNineteenOfTwentyGoalsWithin5cm) {
  if (!testing::is_long()) GTEST_SKIP() << testing::kLongOnly;
  const support::TempFolder folder;
  TrainingOptions options;
  options.task.threads = options.ppo.threads = 2;
  options.ppo.total_steps = 100000;
  options.evaluate_every = 10000;
  options.stop_within = 0.05;
  options.stop_share = 0.95;
  auto training = begin(options, folder);
  ASSERT_TRUE(training) << training.error().what;
  train(*training, 1000);
  ASSERT_TRUE(training->last_evaluation());
  EXPECT_EQ(training->last_evaluation()->episodes, 200);
  EXPECT_GE(training->last_evaluation()->within_5cm, 0.95);
  EXPECT_LT(training->trainer().steps(), 70000);
}

TEST(Score, OrdersBySharesAndThenByDistance) {
  Evaluation few, more, nearer;
  few.episodes = more.episodes = nearer.episodes = 200;
  few.within_5cm = 0.5;
  few.median = 0.001;
  more.within_5cm = 0.505;  // one goal more
  more.median = 0.2;
  nearer = more;
  nearer.median = 0.1;
  EXPECT_LT(score(few), score(more));
  EXPECT_LT(score(more), score(nearer));
  nearer.median = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(std::isfinite(score(nearer)));
}

TEST(Score, SharesAreThoseOfTheNextSmallerDistance) {
  Evaluation evaluation;
  evaluation.within_5cm = 0.9;
  evaluation.within_2cm = 0.8;
  evaluation.within_1cm = 0.7;
  evaluation.within_5mm = 0.6;
  EXPECT_EQ(share_within(evaluation, 0.1), 0.9);
  EXPECT_EQ(share_within(evaluation, 0.02), 0.8);
  EXPECT_EQ(share_within(evaluation, 0.019), 0.7);
  EXPECT_EQ(share_within(evaluation, 0.005), 0.6);
  EXPECT_EQ(share_within(evaluation, 0.004), 0);
}

}  // namespace
}  // namespace mjarm::rl
