#include "mjarm/rl/evaluate.hpp"

#include <gmock/gmock.h>

#include "mjarm/model/find_arm.hpp"
#include "mjarm/rl/reach_test.hpp"

namespace mjarm::rl {
namespace {

using testing::Expert;
using ::testing::HasSubstr;
using testing::row;
using testing::task_model;

Evaluation evaluate_expert(const ReachOptions& options, const EvaluateOptions& how) {
  const Model model = task_model(options);
  const Expert expert(find_arm(model).value(), options);
  const int size = 32 + (options.orientation ? 3 : 0) + (options.obstacle ? 3 : 0);
  const auto result = evaluate(
      model, options,
      [&](std::span<const float> seen, std::span<float> actions) {
        for (int i = 0; i < how.episodes; ++i) {
          expert.act(row(seen, i, size), row(actions, i, 7));
        }
      },
      how);
  EXPECT_TRUE(result) << (result ? "" : result.error().what);
  return *result;
}

// That one can do it proves that observations, actions and limits allow it.
TEST(Evaluate, AnExpertReachesTheTutorialsGoalsToHalfACentimetre) {
  const Evaluation e = evaluate_expert({.threads = 2}, {.episodes = 100});
  EXPECT_EQ(e.episodes, 100);
  EXPECT_GE(e.within_1cm, 0.95);
  EXPECT_GE(e.within_5mm, 0.95);
  EXPECT_LT(e.median, 0.002);
  EXPECT_EQ(e.steps, 50);
  EXPECT_LT(e.steps_to_2cm, 40);
  EXPECT_EQ(e.touched, 0);
}

TEST(Evaluate, AnExpertReachesMostWideGoals) {
  const Evaluation e = evaluate_expert(
      {.threads = 2, .region = ReachRegion::wide, .episode_steps = 70}, {.episodes = 100});
  EXPECT_GE(e.within_2cm, 0.9) << e.p95;
}

TEST(Evaluate, AnExpertTurnsTheToolDown) {
  const Evaluation e =
      evaluate_expert({.threads = 2, .episode_steps = 60, .orientation = true}, {.episodes = 60});
  EXPECT_GE(e.within_1cm, 0.9);
  EXPECT_LT(e.turn_median, 0.02);
  EXPECT_GT(e.turn_p95, e.turn_median - 1e-12);
}

TEST(Evaluate, IsTheSameForAnyThreadsAndEveryGoalIsItsOwn) {
  const Evaluation one = evaluate_expert({.threads = 1}, {.episodes = 20, .seed = 5});
  const Evaluation four = evaluate_expert({.threads = 4}, {.episodes = 20, .seed = 5});
  EXPECT_EQ(one.distances, four.distances);
  const Evaluation fewer = evaluate_expert({}, {.episodes = 7, .seed = 5});
  EXPECT_TRUE(std::equal(fewer.distances.begin(), fewer.distances.end(), one.distances.begin()));
  const Evaluation other = evaluate_expert({}, {.episodes = 7, .seed = 6});
  EXPECT_NE(other.distances, fewer.distances);
}

TEST(Evaluate, NumbersAreThoseOfTheDistances) {
  const Model model = task_model();
  const auto idle = [](std::span<const float>, std::span<float> actions) {
    std::fill(actions.begin(), actions.end(), 0.0F);
  };
  const auto e = evaluate(model, {.episode_steps = 3}, ActFunction(idle), {.episodes = 21});
  ASSERT_TRUE(e);
  std::vector<double> sorted = e->distances;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(e->median, sorted[10]);
  EXPECT_EQ(e->p95, sorted[19]);
  EXPECT_EQ(e->max, sorted[20]);
  EXPECT_GT(sorted[0], 0.399);
  EXPECT_LT(sorted[20], 0.501);
  EXPECT_EQ(e->within_5cm, 0);
  EXPECT_EQ(e->steps_to_2cm, 0);
  EXPECT_EQ(e->steps, 3);
}

TEST(Evaluate, APolicyIsItsMeanActions) {
  const Model model = task_model();
  Policy policy({.observations = 32, .actions = 7, .actor = {8}, .critic = {8}});
  Rng rng(1);
  for (float& p : policy.parameters()) p = static_cast<float>(rng.uniform(-0.3, 0.3));
  const ReachOptions options{.episode_steps = 5};
  const auto by_policy = evaluate(model, options, policy, {.episodes = 6});
  const auto by_hand = evaluate(model, options,
                                [&](std::span<const float> seen, std::span<float> actions) {
                                  for (int i = 0; i < 6; ++i) {
                                    const Eigen::VectorXf action = policy.act(row(seen, i, 32));
                                    for (int k = 0; k < 7; ++k) actions[7 * i + k] = action[k];
                                  }
                                },
                                {.episodes = 6});
  ASSERT_TRUE(by_policy && by_hand);
  EXPECT_EQ(by_policy->distances, by_hand->distances);

  const auto wrong = evaluate(model, {.orientation = true}, policy, {.episodes = 2});
  ASSERT_FALSE(wrong);
  EXPECT_THAT(wrong.error().what, HasSubstr("35"));
  policy.parameters()[3] = std::nanf("");
  EXPECT_FALSE(evaluate(model, options, policy, {.episodes = 2}));
  EXPECT_FALSE(evaluate(model, options, policy, {.episodes = 0}));
}

TEST(Evaluate, AnEpisodeComesOutTheSameHoweverManyThereAre) {
  ReachOptions task;
  task.episode_steps = 2;
  const Model model = reach_model(task).value();
  const auto still = [](std::span<const float>, std::span<float> actions) {
    std::fill(actions.begin(), actions.end(), 0.0F);
  };
  const auto few = evaluate(model, task, still, {.episodes = 5});
  const auto many = evaluate(model, task, still, {.episodes = 1030});
  ASSERT_TRUE(few && many);
  ASSERT_EQ(many->distances.size(), 1030U);
  EXPECT_TRUE(std::equal(few->distances.begin(), few->distances.end(), many->distances.begin()));
  EXPECT_NE(many->distances[0], many->distances[1024]) << "the next block has goals of its own";
}

}  // namespace
}  // namespace mjarm::rl
