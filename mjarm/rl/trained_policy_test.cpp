#include "mjarm/rl/trained_policy.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "mjarm/core/os.hpp"
#include "mjarm/rl/evaluate.hpp"
#include "mjarm/rl/policy_file_test.hpp"
#include "mjarm/rl/reach_test.hpp"
#include "mjarm/rl/safetensors.hpp"
#include "mjarm/rl/training_config.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::rl {
namespace {

using testing::expect_refused;
using ::testing::HasSubstr;
using testing::task_model;

Policy small_policy(int observations, int actions) {
  return Policy({observations, actions, {8}, {8}, Activation::tanh});
}

TEST(TrainedPolicy, KnowsTheTaskItWasTrainedFor) {
  const support::TempFolder folder;
  const auto file = folder.path() / "p.safetensors";
  TensorSet set = small_policy(32, 7).tensors();
  TrainingOptions options = reach_training(ReachRegion::wide);
  options.task.frame_skip = 11;
  set.metadata["config"] = config_text(options);
  ASSERT_TRUE(save_safetensors(file, set));
  const Result<TrainedPolicy> loaded = load_policy(file);
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->file, file);
  EXPECT_EQ(loaded->policy.shape(), small_policy(32, 7).shape());
  EXPECT_EQ(loaded->task.region, ReachRegion::wide);
  EXPECT_EQ(loaded->task.frame_skip, 11);
}

TEST(TrainedPolicy, OneOfStableBaselinesHasTheDefaultTask) {
  const Result<TrainedPolicy> loaded = load_policy(testing::test_file("sb3_tanh.zip"));
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->task.region, ReachOptions{}.region);
  EXPECT_EQ(loaded->task.episode_steps, ReachOptions{}.episode_steps);
}

TEST(TrainedPolicy, DamagedFilesAreRefusedByName) {
  const support::TempFolder folder;
  const auto at = [&](const char* name) { return (folder.path() / name).string(); };
  expect_refused(load_policy(at("none.safetensors")), at("none.safetensors"));
  expect_refused(load_policy(folder.write("b.zip", "PK")), at("b.zip"));
  expect_refused(load_policy(folder.write("b.safetensors", "12345678")), at("b.safetensors"));
  TensorSet set = small_policy(32, 7).tensors();
  set.tensors.erase("log_std");
  ASSERT_TRUE(save_safetensors(at("half.safetensors"), set));
  expect_refused(load_policy(at("half.safetensors")), at("half.safetensors"), "log_std");
  set = small_policy(32, 7).tensors();
  set.metadata["config"] = "task: {region: moon}";
  ASSERT_TRUE(save_safetensors(at("moon.safetensors"), set));
  expect_refused(load_policy(at("moon.safetensors")), at("moon.safetensors"), "tutorial, wide");
}

TEST(TrainedPolicy, SizesThatDoNotFitTheTaskAreSaid) {
  const ReachEnv env = testing::reach_env();
  EXPECT_TRUE(check_sizes(small_policy(env.observation_size(), env.action_size()), env));
  const Result<void> other = check_sizes(small_policy(31, 7), env);
  ASSERT_FALSE(other);
  EXPECT_THAT(other.error().what, HasSubstr("31"));
  EXPECT_FALSE(check_sizes(small_policy(env.observation_size(), 6), env));
  EXPECT_FALSE(evaluate(task_model(), {}, small_policy(31, 7), {.episodes = 1}));
}

TEST(IsGoodEnough, AsksForNothingUnlessTold) {
  TrainingOptions options;
  EXPECT_TRUE(is_good_enough(options, std::nullopt));
  options.stop_share = 0.9;
  options.stop_within = 0.02;
  EXPECT_FALSE(is_good_enough(options, std::nullopt));
  Evaluation evaluation;
  evaluation.within_5cm = 1;
  evaluation.within_2cm = 0.89;
  EXPECT_FALSE(is_good_enough(options, evaluation));
  evaluation.within_2cm = 0.9;
  EXPECT_TRUE(is_good_enough(options, evaluation));
}

}  // namespace
}  // namespace mjarm::rl
