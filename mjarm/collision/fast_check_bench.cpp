#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "mjarm/collision/edge_check.hpp"
#include "mjarm/collision/problems_test.hpp"
#if defined(MJARM_VAMP)
#include "bench/peers/vamp/vamp_peer.hpp"
#endif

/// Needs MJARM_TEST_DATA. First argument: 0 baseline, 2 AVX2, 3 AVX-512 (as far as the machine has
/// them). A state is a row of the Panda's public problems; edges are of the length given [rad].
namespace mjarm {
namespace {

constexpr int kEvery = 7;              // one problem in so many
constexpr std::size_t kStates = 1024;  // of a scene

struct Scene {
  FastChecker checker;
  std::vector<Obstacle> solids;
  std::vector<double> random;  // rows
  std::vector<double> along;   // rows along straight edges, 16 each
  std::vector<double> free;    // rows without a collision
};

void add_row(const JointVec& q, std::vector<double>& rows) {
  rows.insert(rows.end(), q.data(), q.data() + q.size());
}

std::vector<double> edge_rows(const Arm& arm, Rng& rng, double length) {
  const JointVec q0 = testing::random_q(arm, rng);
  const JointVec way = testing::random_q(arm, rng) - q0;
  std::vector<double> rows;
  for (int k = 0; k < 16; ++k) {
    const JointVec q = q0 + way * (std::min(1.0, length / way.norm()) * k / 15);
    add_row(q, rows);
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
  const FastRobot robot = FastRobot::create(all.arm, all.set).value();
  const auto level = static_cast<SimdLevel>(state.range(0));
  Rng rng(1);
  std::vector<Scene> out;
  for (std::size_t i = 0; i < all.problems.size(); i += kEvery) {
    const Obstacles& obstacles = all.problems[i].obstacles;
    out.push_back(
        {FastChecker::create(robot, obstacles, level).value(), obstacles.solids, {}, {}, {}});
    for (std::size_t k = 0; k < kStates; ++k) {
      add_row(testing::random_q(all.arm, rng), out.back().random);
    }
    while (out.back().free.size() < out.back().random.size()) {
      const JointVec q = testing::random_q(all.arm, rng);
      if (out.back().checker.is_free(as_span(q))) add_row(q, out.back().free);
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
  std::vector<std::uint8_t> free(kStates);
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

void fast_check_free_states(benchmark::State& state) { over_states(state, &Scene::free); }
BENCHMARK(fast_check_free_states)->Arg(0)->Arg(2)->Arg(3);

/// Blocks of a register's width that end with the first state in collision, as VAMP's do.
void fast_check_blocks(benchmark::State& state) {
  const std::vector<Scene> all = scenes(state);
  std::int64_t states = 0;
  for (auto _ : state) {
    for (const Scene& scene : all) {
      const std::span<const double> rows(scene.random);
      const std::size_t block =
          rows.size() / kStates * static_cast<std::size_t>(scene.checker.width());
      for (std::size_t first = 0; first < rows.size(); first += block) {
        benchmark::DoNotOptimize(scene.checker.all_free(rows.subspan(first, block)));
      }
      states += kStates;
    }
  }
  state.SetItemsProcessed(states);
}
BENCHMARK(fast_check_blocks)->Arg(0)->Arg(2);

#if defined(MJARM_VAMP)

peers::VampSolid vamp_solid(const Obstacle& from) {
  peers::VampSolid out{};
  for (int i = 0; i < 3; ++i) {
    out.center[i] = static_cast<float>(from.X_WO.p[i]);
    for (int k = 0; k < 3; ++k) out.axes[3 * k + i] = static_cast<float>(from.X_WO.R(i, k));
  }
  if (const auto* ball = std::get_if<BallShape>(&from.shape)) {
    out.kind = peers::VampSolid::Kind::ball;
    out.size[0] = static_cast<float>(ball->radius);
  } else if (const auto* box = std::get_if<BoxShape>(&from.shape)) {
    out.kind = peers::VampSolid::Kind::box;
    for (int i = 0; i < 3; ++i) out.size[i] = static_cast<float>(box->half[i]);
  } else {
    const auto& capsule = std::get<CapsuleShape>(from.shape);
    out.kind = peers::VampSolid::Kind::capsule;
    out.size[0] = static_cast<float>(capsule.radius);
    out.size[1] = static_cast<float>(capsule.half_length);
  }
  return out;
}

/// Its blocks of eight end with the first state in collision, ours do not. Counters: blocks that
/// are free, by it and by us.
void vamp_states(benchmark::State& state, std::vector<double> Scene::* rows) {
  constexpr std::size_t kLanes = 8, kBlocks = kStates / kLanes;
  const std::vector<Scene> all = scenes(state);
  std::vector<std::shared_ptr<const peers::VampWorld>> worlds;
  std::vector<std::vector<float>> blocks;
  std::size_t ours = 0, theirs = 0;
  for (const Scene& scene : all) {
    std::vector<peers::VampSolid> solids;
    for (const Obstacle& solid : scene.solids) solids.push_back(vamp_solid(solid));
    worlds.push_back(peers::make_vamp_world(solids));
    const std::vector<double>& q = scene.*rows;
    const std::size_t dof = q.size() / kStates;
    std::vector<float>& side_by_side = blocks.emplace_back(q.size());
    for (std::size_t k = 0; k < kStates; ++k) {
      for (std::size_t i = 0; i < dof; ++i) {
        side_by_side[(k / kLanes * dof + i) * kLanes + k % kLanes] =
            static_cast<float>(q[k * dof + i]);
      }
    }
    std::vector<std::uint8_t> free(kStates);
    scene.checker.check(q, free);
    for (std::size_t k = 0; k < kStates; k += kLanes) {
      ours += std::all_of(&free[k], &free[k] + kLanes, [](auto one) { return one != 0; }) ? 1 : 0;
    }
    theirs += peers::count_free_blocks(*worlds.back(), blocks.back().data(), kBlocks);
  }
  std::int64_t states = 0;
  for (auto _ : state) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      benchmark::DoNotOptimize(peers::count_free_blocks(*worlds[i], blocks[i].data(), kBlocks));
      states += kStates;
    }
  }
  state.SetItemsProcessed(states);
  state.counters["free_blocks"] = static_cast<double>(theirs);
  state.counters["free_by_mjarm"] = static_cast<double>(ours);
}

BENCHMARK_CAPTURE(vamp_states, random, &Scene::random)->Arg(0);
BENCHMARK_CAPTURE(vamp_states, of_edges, &Scene::along)->Arg(0);
BENCHMARK_CAPTURE(vamp_states, free, &Scene::free)->Arg(0);

#endif

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
  const FastRobot robot = FastRobot::create(all.arm, all.set).value();
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(FastChecker::create(robot, all.problems[i].obstacles));
    i = (i + 1) % all.problems.size();
  }
}
BENCHMARK(fast_check_make);

}  // namespace
}  // namespace mjarm
