// How often the shipped policy ends within 2 cm of goals it has never seen, beside random actions.
#include <algorithm>
#include <cstdio>
#include <vector>

#include "mjarm/core/rng.hpp"
#include "mjarm/rl/evaluate.hpp"
#include "mjarm/rl/reach_env.hpp"
#include "mjarm/rl/trained_policy.hpp"

int main() {
  using namespace mjarm;
  const auto trained = find_model_file("policies/reach.safetensors").and_then([](const auto& file) {
    return rl::load_policy(file);
  });
  if (!trained) return std::fprintf(stderr, "%s\n", trained.error().what.c_str()), 1;
  rl::ReachOptions task = trained->task;
  const auto model = rl::reach_model(task);
  if (!model) return std::fprintf(stderr, "%s\n", model.error().what.c_str()), 1;
  const auto result = rl::evaluate(*model, task, trained->policy, {.episodes = 100});
  if (!result) return std::fprintf(stderr, "%s\n", result.error().what.c_str()), 1;
  std::printf("shipped policy: %.0f of 100 within 2 cm\n", 100 * result->within_2cm);

  task.environments = 100;  // as many arms, each with a goal of its own
  auto env = rl::ReachEnv::create(*model, task);
  if (!env) return std::fprintf(stderr, "%s\n", env.error().what.c_str()), 1;
  Rng rng(1);
  std::vector<float> actions(static_cast<std::size_t>(env->count() * env->action_size()));
  for (int i = 0; i < task.episode_steps; ++i) {
    for (float& action : actions) action = static_cast<float>(rng.uniform(-1, 1));
    const auto done = env->step(actions);
    if (!done) return std::fprintf(stderr, "%s\n", done.error().what.c_str()), 1;
  }
  const auto met = std::ranges::count_if(env->final_distances(), [](double d) { return d < 0.02; });
  std::printf("random actions: %td of 100\n", met);
  return result->within_2cm == 1 && met == 0 ? 0 : 1;
}
