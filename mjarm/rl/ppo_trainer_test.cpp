#include "mjarm/rl/ppo_trainer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <barrier>
#include <cmath>
#include <thread>

#include "mjarm/rl/toy_envs_test.hpp"

namespace mjarm::rl {
namespace {

using testing::CashOut;
using ::testing::HasSubstr;
using testing::PointMass;

PpoTrainer trainer_of(VecEnv& env, const PpoOptions& options, Ranks* ranks = nullptr) {
  auto trainer = PpoTrainer::create(env, options, ranks);
  if (!trainer) throw std::runtime_error(trainer.error().what);
  return std::move(*trainer);
}

/// Small nets that learn small tasks in a few seconds, whatever the build.
PpoOptions small_options() {
  return {.threads = 1,
          .rollout_steps = 32,
          .minibatch = 128,
          .epochs = 8,
          .learning_rate = 3e-3,
          .schedule = Schedule::constant,
          .discount = 0.99,
          .actor = {16, 16},
          .critic = {16, 16},
          .initial_log_std = -0.5};
}

/// Options that use every part there is.
PpoOptions all_parts() {
  PpoOptions options = small_options();
  options.total_steps = 3000;
  options.schedule = Schedule::linear;
  options.value_clip = 0.2;
  options.entropy_weight = 1e-3;
  options.target_kl = 0.05;
  options.scale_rewards = true;
  options.minibatch = 200;
  return options;
}

/// Everything of a report but the clock.
std::vector<double> numbers_of(const IterationReport& report) {
  return {double(report.iteration), double(report.steps), double(report.episodes),
          report.mean_return,       report.mean_length,   report.policy_loss,
          report.value_loss,        report.entropy,       report.kl,
          report.clip_fraction,     report.gradient_norm, report.explained_variance,
          report.learning_rate,     report.mean_std,      double(report.epochs)};
}

std::vector<double> run(PpoTrainer& trainer, int iterations) {
  std::vector<double> out;
  for (int i = 0; i < iterations; ++i) {
    const auto report = trainer.iterate();
    if (!report) throw std::runtime_error(report.error().what);
    const std::vector<double> numbers = numbers_of(*report);
    out.insert(out.end(), numbers.begin(), numbers.end());
  }
  return out;
}

TEST(PpoTrainer, LearnsToPushAPointToItsGoal) {
  PointMass env(16);
  PpoTrainer trainer = trainer_of(env, small_options());
  IterationReport report;
  double first_return = 0;
  for (int i = 0; i < 40; ++i) {
    const auto done = trainer.iterate();
    ASSERT_TRUE(done) << done.error().what;
    report = *done;
    if (i == 0) first_return = report.mean_return;
  }
  EXPECT_EQ(report.steps, 40 * 32 * 16);
  // Straight to the goal costs about 2.5 on average; pushed about at random it costs 20.
  EXPECT_LT(first_return, -12);
  EXPECT_GT(report.mean_return, -4.5);
  EXPECT_LT(report.mean_length, 10);
  EXPECT_GT(report.explained_variance, 0.5);
}

TEST(PpoTrainer, KnowsThatACutIsNoEnd) {
  CashOut env(16);
  PpoOptions options = small_options();
  options.discount = 0.9;
  options.normalise_observations = false;
  PpoTrainer trainer = trainer_of(env, options);
  IterationReport report;
  for (int i = 0; i < 40; ++i) {
    const auto done = trainer.iterate();
    ASSERT_TRUE(done) << done.error().what;
    report = *done;
  }
  EXPECT_GT(report.mean_length, 3.7);  // nearly nobody ends it
  EXPECT_NEAR(trainer.policy().value(std::vector<float>{0.3F}), 10, 1.0);
}

TEST(PpoTrainer, ValuesGoOnBehindACut) {
  testing::Level env(16);
  PpoOptions options = small_options();
  options.discount = 0.8;
  PpoTrainer trainer = trainer_of(env, options);
  run(trainer, 40);
  for (const double level : {-0.8, 0.0, 0.5}) {
    EXPECT_NEAR(trainer.policy().value(std::vector<float>{testing::Level::shown(level)}), 5 * level,
                0.3);
  }
}

TEST(PpoTrainer, SameBytesForAnyNumberOfThreads) {
  std::vector<TensorSet> ends;
  std::vector<std::vector<double>> reports;
  for (const int threads : {1, 2, 4}) {
    PointMass env(20);
    PpoOptions options = all_parts();
    options.threads = threads;
    options.actor = {40, 24};  // more than one slice, more than one panel
    PpoTrainer trainer = trainer_of(env, options);
    reports.push_back(run(trainer, 3));
    ends.push_back(trainer.checkpoint());
  }
  EXPECT_EQ(ends[1], ends[0]);
  EXPECT_EQ(ends[2], ends[0]);
  EXPECT_EQ(reports[1], reports[0]);
  EXPECT_EQ(reports[2], reports[0]);
}

TEST(PpoTrainer, ResumedIsTheSameAsNeverStopped) {
  PointMass whole_env(8), first_env(8), second_env(8);
  PpoTrainer whole = trainer_of(whole_env, all_parts());
  const std::vector<double> wanted = run(whole, 6);

  PpoTrainer first = trainer_of(first_env, all_parts());
  std::vector<double> found = run(first, 3);
  const TensorSet checkpoint = first.checkpoint();
  PpoTrainer second = trainer_of(second_env, all_parts());
  run(second, 1);  // what it did before does not matter
  const auto restored = second.restore(checkpoint);
  ASSERT_TRUE(restored) << restored.error().what;
  EXPECT_EQ(second.checkpoint(), checkpoint);
  EXPECT_EQ(second.iterations(), 3);
  const std::vector<double> rest = run(second, 3);
  found.insert(found.end(), rest.begin(), rest.end());
  EXPECT_EQ(found, wanted);
  EXPECT_EQ(second.checkpoint(), whole.checkpoint());
}

TEST(PpoTrainer, OtherSeedsGiveOtherPolicies) {
  PointMass env(4), other_env(4);
  PpoOptions options = small_options(), other = small_options();
  other.seed = 2;
  PpoTrainer a = trainer_of(env, options), b = trainer_of(other_env, other);
  EXPECT_NE(env.seed(), other_env.seed());
  EXPECT_NE(a.policy().tensors(), b.policy().tensors());
}

TEST(PpoTrainer, CheckpointsThatDoNotFitNameTheTensor) {
  PointMass env(4);
  PpoTrainer trainer = trainer_of(env, small_options());
  run(trainer, 1);
  const TensorSet good = trainer.checkpoint();
  for (const auto& [name, tensor] : good.tensors) {
    TensorSet lacks = good, wrong = good;
    lacks.tensors.erase(name);
    wrong.tensors[name] = {{1, 2}, std::vector<float>{1, 2}};
    for (const TensorSet* bad : {&lacks, &wrong}) {
      const auto restored = trainer.restore(*bad);
      ASSERT_FALSE(restored) << name;
      EXPECT_EQ(restored.error().code, Errc::bad_input);
      EXPECT_THAT(restored.error().what, HasSubstr("\"" + name + "\""));
    }
  }
  TensorSet zeros = good;
  zeros.tensors["trainer.rng"].values = std::vector<std::int64_t>(4, 0);
  EXPECT_FALSE(trainer.restore(zeros));
  TensorSet nan = good;
  std::get<std::vector<float>>(nan.tensors["adam.first"].values)[3] = NAN;
  EXPECT_FALSE(trainer.restore(nan));
  TensorSet relu = good;
  relu.metadata["activation"] = "relu";
  EXPECT_FALSE(trainer.restore(relu));
  TensorSet negative = good;
  std::get<std::vector<float>>(negative.tensors["adam.second"].values)[3] = -1;
  EXPECT_FALSE(trainer.restore(negative));
  EXPECT_EQ(trainer.checkpoint(), good);  // none of them changed anything

  PointMass more(5);
  PpoTrainer other = trainer_of(more, small_options());
  EXPECT_FALSE(other.restore(good));
}

TEST(PpoTrainer, ARewardThatIsNoNumberNamesIterationAndCopy) {
  PointMass env(4);
  PpoTrainer trainer = trainer_of(env, small_options());
  run(trainer, 2);
  const TensorSet before = trainer.policy().tensors();
  env.fail_at = 70;  // the sixth step of the third rollout
  const auto report = trainer.iterate();
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, Errc::impossible);
  EXPECT_THAT(report.error().what, HasSubstr("iteration 3"));
  EXPECT_THAT(report.error().what, HasSubstr("copy 3"));
  EXPECT_THAT(report.error().what, HasSubstr("step 5"));
  EXPECT_EQ(trainer.policy().tensors(), before);
  EXPECT_EQ(trainer.iterations(), 2);
}

TEST(PpoTrainer, WhatTheEnvironmentSaysIsPassedOn) {
  PointMass env(4);
  PpoTrainer trainer = trainer_of(env, small_options());
  env.refuse_at = 3;
  const auto report = trainer.iterate();
  ASSERT_FALSE(report);
  EXPECT_THAT(report.error().what, HasSubstr("iteration 1: out of order"));
}

TEST(PpoTrainer, DivergenceLeavesThePolicyAsItWas) {
  PointMass env(4);
  PpoOptions options = small_options();
  PpoTrainer trainer = trainer_of(env, options);
  run(trainer, 1);
  TensorSet sick = trainer.checkpoint();
  // Finite, but its square is not.
  std::get<std::vector<float>>(sick.tensors["critic.2.bias"].values)[0] = 1e30F;
  ASSERT_TRUE(trainer.restore(sick));
  const TensorSet before = trainer.policy().tensors();
  const auto report = trainer.iterate();
  ASSERT_FALSE(report);
  EXPECT_THAT(report.error().what, HasSubstr("iteration 2"));
  EXPECT_THAT(report.error().what, HasSubstr("diverged"));
  EXPECT_EQ(trainer.policy().tensors(), before);
}

TEST(PpoTrainer, StopsAnUpdateThatGoesTooFar) {
  PpoOptions options = small_options();
  options.learning_rate = 0.03;
  const auto first_iteration = [&](double target_kl) {
    PointMass env(8);
    options.target_kl = target_kl;
    PpoTrainer trainer = trainer_of(env, options);
    const std::vector<double> report = run(trainer, 1);
    return std::pair(report, trainer.checkpoint());
  };
  const auto free = first_iteration(0), bound = first_iteration(0.01), far = first_iteration(1e6);
  EXPECT_EQ(free.first.back(), 8);  // epochs
  EXPECT_LT(bound.first.back(), 8);
  EXPECT_EQ(far, free);  // a limit that is never met changes nothing
  const auto steps = [](const TensorSet& set) {
    return std::get<std::vector<std::int64_t>>(set.tensors.at("adam.steps").values)[0];
  };
  EXPECT_EQ(steps(free.second), 8 * 2);
  EXPECT_LT(steps(bound.second), 2 * bound.first.back());  // the last one was not taken
}

TEST(PpoTrainer, LearningRateFallsToTheEnd) {
  PointMass env(8);
  PpoOptions options = small_options();
  options.schedule = Schedule::linear;
  options.total_steps = 4 * 8 * 32;
  PpoTrainer trainer = trainer_of(env, options);
  for (const double share : {1.0, 0.75, 0.5, 0.25, 0.0}) {
    const auto report = trainer.iterate();
    ASSERT_TRUE(report);
    EXPECT_NEAR(report->learning_rate, share * options.learning_rate, 1e-12);
  }
}

TEST(PpoOptions, AreCheckedOneByOne) {
  EXPECT_TRUE(check(PpoOptions{}));
  EXPECT_TRUE(check(small_options()));
  const auto refused = [](auto change) {
    PpoOptions options;
    change(options);
    const auto checked = check(options);
    return checked ? std::string() : checked.error().what;
  };
  EXPECT_EQ(refused([](PpoOptions& o) { o.discount = 1.5; }),
            "discount must be in [0, 1], not 1.5");
  EXPECT_EQ(refused([](PpoOptions& o) { o.clip = 0; }), "clip must be > 0, not 0");
  EXPECT_THAT(refused([](PpoOptions& o) { o.learning_rate = NAN; }), HasSubstr("learning_rate"));
  EXPECT_THAT(refused([](PpoOptions& o) { o.threads = 0; }), HasSubstr("threads"));
  EXPECT_THAT(refused([](PpoOptions& o) { o.minibatch = 1; }), HasSubstr("minibatch"));
  EXPECT_THAT(refused([](PpoOptions& o) { o.actor = {64, 0}; }), HasSubstr("actor"));
  EXPECT_THAT(refused([](PpoOptions& o) { o.value_weight = INFINITY; }), HasSubstr("value_weight"));
  PointMass one(1);
  PpoOptions options;
  options.rollout_steps = 1;
  EXPECT_FALSE(PpoTrainer::create(one, options));
  options.epochs = 0;
  EXPECT_FALSE(PpoTrainer::create(one, options));
}

TEST(PpoOptions, WhatWouldNotFitTheMemoryIsRefusedBeforeItIsMade) {
  PointMass crowd(16);
  const auto refused = [&](const PpoOptions& options) {
    const auto made = PpoTrainer::create(crowd, options);
    return made ? std::string() : made.error().what;
  };
  EXPECT_THAT(refused({.rollout_steps = 1000000}), HasSubstr("16000000 samples"));
  EXPECT_THAT(refused({.actor = {65536, 65536}}), HasSubstr("4.3e+09 weights"));
  EXPECT_EQ(refused({.threads = 1, .rollout_steps = 64, .actor = {512, 512}}), "");
}

/// Threads that stand for processes.
class ThreadRanks : public Ranks {
 public:
  struct Shared {
    explicit Shared(int size) : meeting(size), parts(static_cast<std::size_t>(size)) {}
    std::barrier<> meeting;
    std::vector<std::vector<double>> parts;
  };
  ThreadRanks(Shared& shared, int rank) : shared_(shared), rank_(rank) {}
  [[nodiscard]] int rank() const noexcept override { return rank_; }
  [[nodiscard]] int size() const noexcept override {
    return static_cast<int>(shared_.parts.size());
  }
  void sum(std::span<double> values) override { add(values); }
  void sum(std::span<float> values) override { add(values); }

 private:
  template <class T>
  void add(std::span<T> values) {
    shared_.parts[static_cast<std::size_t>(rank_)].assign(values.begin(), values.end());
    shared_.meeting.arrive_and_wait();
    for (std::size_t i = 0; i < values.size(); ++i) {
      double sum = 0;
      for (const auto& part : shared_.parts) sum += part[i];
      values[i] = static_cast<T>(sum);
    }
    shared_.meeting.arrive_and_wait();
  }
  Shared& shared_;
  int rank_;
};

TEST(PpoRanks, OneRankIsTheSameAsNone) {
  PointMass env(8), alone_env(8);
  ThreadRanks::Shared shared(1);
  ThreadRanks ranks(shared, 0);
  PpoTrainer alone = trainer_of(alone_env, all_parts());
  PpoTrainer ranked = trainer_of(env, all_parts(), &ranks);
  EXPECT_EQ(run(ranked, 3), run(alone, 3));
  EXPECT_EQ(ranked.checkpoint(), alone.checkpoint());
}

/// Two trainers side by side; what each of them did.
template <class Body>
void with_two_ranks(const Body& body) {
  ThreadRanks::Shared shared(2);
  const auto work = [&](int rank) {
    ThreadRanks ranks(shared, rank);
    body(ranks);
  };
  std::thread other(work, 1);
  work(0);
  other.join();
}

TEST(PpoRanks, TwoKeepOnePolicyWithEnvironmentsOfTheirOwn) {
  TensorSet policies[2];
  std::vector<double> states[2];
  std::int64_t steps[2];
  with_two_ranks([&](ThreadRanks& ranks) {
    PointMass env(8);
    PpoTrainer trainer = trainer_of(env, all_parts(), &ranks);
    run(trainer, 3);
    policies[ranks.rank()] = trainer.policy().tensors();
    states[ranks.rank()] = env.state();
    steps[ranks.rank()] = trainer.steps();
  });
  EXPECT_EQ(policies[0], policies[1]);
  EXPECT_NE(states[0], states[1]);
  EXPECT_EQ(steps[0], 2 * 3 * 32 * 8);
  EXPECT_EQ(steps[1], steps[0]);
}

TEST(PpoRanks, OneThatFailsTakesTheOtherAlong) {
  std::string errors[2];
  with_two_ranks([&](ThreadRanks& ranks) {
    PointMass env(8);
    if (ranks.rank() == 1) env.refuse_at = 40;
    PpoTrainer trainer = trainer_of(env, all_parts(), &ranks);
    run(trainer, 1);
    const auto report = trainer.iterate();
    errors[ranks.rank()] = report ? "none" : report.error().what;
  });
  EXPECT_THAT(errors[0], HasSubstr("another of the processes"));
  EXPECT_THAT(errors[1], HasSubstr("out of order"));
}

}  // namespace
}  // namespace mjarm::rl
