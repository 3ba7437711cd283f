#include <benchmark/benchmark.h>

#include <cmath>

#include "mjarm/collision/edge_check.hpp"
#include "mjarm/collision/problems_test.hpp"

/// Needs MJARM_TEST_DATA. First argument: 0 baseline, 2 AVX2, 3 AVX-512 (as far as the machine has
/// them). A state is a row of the Panda's public problems; edges are of the length given [rad].
namespace mjarm {
namespace {

constexpr int kEvery = 7;  // one problem in so many

struct Scene {
  FastChecker checker;
  std::vector<double> random;  // rows
  std::vector<double> along;   // rows along straight edges, 16 each
};

std::vector<double> edge_rows(const Arm& arm, Rng& rng, double length) {
  const JointVec q0 = testing::random_q(arm, rng);
  const JointVec way = testing::random_q(arm, rng) - q0;
  std::vector<double> rows;
  for (int k = 0; k < 16; ++k) {
    const JointVec q = q0 + way * (std::min(1.0, length / way.norm()) * k / 15);
    rows.insert(rows.end(), q.data(), q.data() + q.size());
  }
  return rows;
}

std::vector<Scene> scenes(benchmark::State& state) {
  const auto file = support::test_data_file("motionbenchmaker/mbm_panda_public.json.gz");
  if (!file) {
    state.SkipWithError("MJARM_TEST_DATA is not set");
    return {};
  }
  const testing::PlanningProblems all = testing::read_problems(*file);
  const FastRobot robot = FastRobot::make(all.arm, all.set).value();
  const auto level = static_cast<SimdLevel>(state.range(0));
  Rng rng(1);
  std::vector<Scene> out;
  for (std::size_t i = 0; i < all.problems.size(); i += kEvery) {
    out.push_back({FastChecker::make(robot, all.problems[i].obstacles, level).value(), {}, {}});
    for (int k = 0; k < 1024; ++k) {
      const JointVec q = testing::random_q(all.arm, rng);
      out.back().random.insert(out.back().random.end(), q.data(), q.data() + q.size());
    }
    for (int k = 0; k < 64; ++k) {
      const std::vector<double> rows = edge_rows(all.arm, rng, 1);
      out.back().along.insert(out.back().along.end(), rows.begin(), rows.end());
    }
  }
  return out;
}

void over_states(benchmark::State& state, std::vector<double> Scene::* rows) {
  const std::vector<Scene> all = scenes(state);
  std::vector<std::uint8_t> free(1024);
  std::int64_t states = 0;
  for (auto _ : state) {
    for (const Scene& scene : all) {
      scene.checker.check(scene.*rows, free);
      states += static_cast<std::int64_t>(free.size());
    }
    benchmark::DoNotOptimize(free.data());
  }
  state.SetItemsProcessed(states);
}

void fast_check_random_states(benchmark::State& state) { over_states(state, &Scene::random); }
BENCHMARK(fast_check_random_states)->Arg(0)->Arg(2)->Arg(3);

void fast_check_states_of_edges(benchmark::State& state) { over_states(state, &Scene::along); }
BENCHMARK(fast_check_states_of_edges)->Arg(0)->Arg(2)->Arg(3);

/// Edges of that length from free configurations.
void certified_edges(benchmark::State& state) {
  const std::vector<Scene> all = scenes(state);
  const auto length = static_cast<double>(state.range(1));
  Rng rng(2);
  std::vector<std::vector<double>> edges(all.size());
  for (std::size_t s = 0; s < all.size(); ++s) {
    const Arm& arm = all[s].checker.robot().arm();
    while (edges[s].size() < 50 * 16 * 7) {
      const std::vector<double> rows = edge_rows(arm, rng, length);
      if (!all[s].checker.is_free({rows.data(), 7})) continue;
      edges[s].insert(edges[s].end(), rows.begin(), rows.end());
    }
  }
  std::int64_t count = 0, free = 0, stations = 0;
  for (auto _ : state) {
    for (std::size_t s = 0; s < all.size(); ++s) {
      for (std::size_t k = 0; k + 112 <= edges[s].size(); k += 112) {
        const EdgeResult found =
            check_edge(all[s].checker, {&edges[s][k], 7}, {&edges[s][k + 105], 7});
        ++count;
        free += found.verdict == EdgeVerdict::free ? 1 : 0;
        stations += found.stations;
      }
    }
  }
  if (count == 0) return;
  state.SetItemsProcessed(count);
  state.counters["free"] = static_cast<double>(free) / static_cast<double>(count);
  state.counters["stations"] = static_cast<double>(stations) / static_cast<double>(count);
}
BENCHMARK(certified_edges)->ArgsProduct({{2, 3}, {1, 2, 4}});

void fast_check_make(benchmark::State& state) {
  const auto file = support::test_data_file("motionbenchmaker/mbm_panda_public.json.gz");
  if (!file) {
    state.SkipWithError("MJARM_TEST_DATA is not set");
    return;
  }
  const testing::PlanningProblems all = testing::read_problems(*file);
  const FastRobot robot = FastRobot::make(all.arm, all.set).value();
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(FastChecker::make(robot, all.problems[i].obstacles));
    i = (i + 1) % all.problems.size();
  }
}
BENCHMARK(fast_check_make);

}  // namespace
}  // namespace mjarm
