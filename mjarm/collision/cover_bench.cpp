#include <benchmark/benchmark.h>

#include "mjarm/collision/cover.hpp"
#include "mjarm/collision/fast_check.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/model/find_arm.hpp"

/// First argument 6: the UR5e, 7: the Panda.
namespace mjarm {
namespace {

struct CoveredRobot {
  explicit CoveredRobot(std::int64_t dof)
      : model(Model::load(find_model_file(dof == 6 ? "ur5e" : "panda").value()).value()),
        arm(find_arm(model).value()) {}
  Model model;
  Arm arm;
};

/// Second argument: the bound [mm].
void cover_of_model(benchmark::State& state) {
  const CoveredRobot robot(state.range(0));
  ModelCover cover;
  for (auto _ : state) {
    cover =
        cover_model(robot.model, robot.arm, {.bound = static_cast<double>(state.range(1)) * 1e-3})
            .value();
  }
  state.counters["spheres"] = static_cast<double>(cover.spheres.size());
  state.counters["links"] = static_cast<double>(cover.spheres.links.size());
  state.counters["pairs"] = static_cast<double>(cover.spheres.pairs.size());
  state.counters["apart"] = cover.pairs_apart;
  state.counters["solids"] = static_cast<double>(cover.scene.solids.size());
}
BENCHMARK(cover_of_model)->ArgsProduct({{6, 7}, {5, 8, 12, 16, 20}})->Unit(benchmark::kMillisecond);

void cover_check_random_states(benchmark::State& state) {
  const CoveredRobot robot(state.range(0));
  const ModelCover cover = cover_model(robot.model, robot.arm).value();
  const FastChecker checker =
      FastChecker::create(FastRobot::create(robot.arm, cover.spheres).value(), cover.scene).value();
  Rng rng(1);
  std::vector<double> rows;
  for (int k = 0; k < 4096; ++k) {
    for (int i = 0; i < robot.arm.dof(); ++i) {
      rows.push_back(rng.uniform(robot.arm.limits.lower[i], robot.arm.limits.upper[i]));
    }
  }
  std::vector<std::uint8_t> free(4096);
  for (auto _ : state) {
    checker.check(rows, free);
    benchmark::DoNotOptimize(free.data());
  }
  state.SetItemsProcessed(state.iterations() * 4096);
}
BENCHMARK(cover_check_random_states)->Arg(6)->Arg(7);

}  // namespace
}  // namespace mjarm
