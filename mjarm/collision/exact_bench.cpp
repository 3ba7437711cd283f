#include <benchmark/benchmark.h>

#include "mjarm/collision/exact.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/model/find_arm.hpp"

namespace mjarm {
namespace {

/// Calls `look(checker, q)` at random configurations of a shipped robot (6: UR5e, 7: Panda).
template <class Look>
void over_random_q(benchmark::State& state, const ExactOptions& options, Look look) {
  const char* const name = state.range(0) == 6 ? "ur5e" : "panda";
  const Model model = Model::load(find_model_file(name).value()).value();
  const Arm arm = find_arm(model).value();
  ExactChecker checker(model, arm, options);
  Rng rng(1);
  std::vector<std::vector<double>> qs(1024);
  for (auto& q : qs) {
    for (int i = 0; i < arm.dof(); ++i) {
      q.push_back(rng.uniform(arm.limits.lower[i], arm.limits.upper[i]));
    }
  }
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(look(checker, qs[i]));
    i = (i + 1) % qs.size();
  }
}

void exact_is_free(benchmark::State& state) {
  over_random_q(state, {}, [](ExactChecker& checker, const auto& q) { return checker.is_free(q); });
}
BENCHMARK(exact_is_free)->Arg(6)->Arg(7);

void exact_check(benchmark::State& state) {
  over_random_q(state, {.margin = 0},
                [](ExactChecker& checker, const auto& q) { return checker.check(q); });
}
BENCHMARK(exact_check)->Arg(6)->Arg(7);

void exact_check_with_distance(benchmark::State& state) {
  over_random_q(state, {.margin = 0.1},
                [](ExactChecker& checker, const auto& q) { return checker.check(q); });
}
BENCHMARK(exact_check_with_distance)->Arg(6)->Arg(7);

}  // namespace
}  // namespace mjarm
