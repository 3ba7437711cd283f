#include <benchmark/benchmark.h>

#include <vector>

#include "mjarm/core/rng.hpp"
#include "mjarm/planning/tree_internal.hpp"

/// How the search of the nearest node scales. Arguments: joints, nodes, all drawn evenly.
namespace mjarm::detail {
namespace {

std::vector<double> random_q(Rng& rng, std::size_t dof) {
  std::vector<double> q(dof);
  for (double& x : q) x = rng.uniform(-3, 3);
  return q;
}

void nearest(benchmark::State& state) {
  const auto dof = static_cast<std::size_t>(state.range(0));
  Rng rng(1, 1);
  Tree tree(dof);
  while (tree.size() < state.range(1)) tree.add(random_q(rng, dof), -1, 0);
  std::vector<std::vector<double>> wanted;
  for (int k = 0; k < 1024; ++k) wanted.push_back(random_q(rng, dof));
  std::size_t at = 0;
  for (auto _ : state) benchmark::DoNotOptimize(tree.nearest(wanted[at++ % wanted.size()]));
}
BENCHMARK(nearest)->ArgsProduct({{3, 6, 7}, {100, 1000, 10'000, 100'000}});

}  // namespace
}  // namespace mjarm::detail
