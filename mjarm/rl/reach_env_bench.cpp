// Environment steps a second beside the bare mjb_step of the same model, in turns within one run:
// 16 copies of 20 simulation steps each. `share` is what of the bare rate is left.
#include <benchmark/benchmark.h>
#include <mujoco/mjbatch.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

#include "mjarm/core/rng.hpp"
#include "mjarm/core/stopwatch.hpp"
#include "mjarm/rl/reach_env.hpp"

namespace mjarm::rl {
namespace {

constexpr int kCopies = 16;

struct DeleteBareBatch {
  void operator()(mjBatch* batch) const { mjb_deleteBatch(batch); }
};
using BareBatch = std::unique_ptr<mjBatch, DeleteBareBatch>;

BareBatch bare_batch(const Model& model, int threads) {
  mjBatchConfig config;
  mjb_defaultConfig(&config);
  config.nthread = threads;
  return BareBatch(mjb_makeBatch(model.raw(), kCopies, &config, nullptr, 0));
}

/// The same motions for both: each step of the environment is followed by one of MuJoCo from the
/// states and with the commands that the environment had.
void reach_steps(benchmark::State& state, ReachGripper gripper) {
  const int threads = static_cast<int>(state.range(0));
  const ReachOptions options{.environments = kCopies, .threads = threads, .gripper = gripper};
  const auto model = reach_model(options);
  if (!model) return state.SkipWithError(model.error().what.c_str());
  auto env = ReachEnv::create(*model, options);
  if (!env) return state.SkipWithError(env.error().what.c_str());
  const BareBatch bare = bare_batch(*model, threads);
  const int nstate = mjb_nstate(bare.get());
  int nctrl = 0;
  double* ctrl = mjb_stateComponent(bare.get(), mjSTATE_CTRL, &nctrl);

  Rng rng(1);
  std::vector<float> actions(kCopies * static_cast<std::size_t>(env->action_size()));
  std::vector<double> before(static_cast<std::size_t>(kCopies) * nstate);
  double own_us = 0, bare_us = 0;
  for (auto _ : state) {
    for (float& a : actions) a = static_cast<float>(rng.uniform(-0.5, 0.5));
    for (int i = 0; i < kCopies; ++i) {
      std::copy_n(env->snapshot(i).state.data(), nstate, before.data() + i * nstate);
    }
    const Stopwatch own;
    if (auto stepped = env->step(actions); !stepped) {
      return state.SkipWithError(stepped.error().what.c_str());
    }
    own_us += own.us();

    std::copy(before.begin(), before.end(), mjb_state(bare.get()));
    const std::ptrdiff_t at = ctrl - mjb_state(bare.get());
    for (int i = 0; i < kCopies; ++i) {
      std::copy_n(env->snapshot(i).state.data() + at, nctrl, ctrl + i * nstate);
    }
    const Stopwatch other;
    mjb_step(bare.get(), nullptr, 0, 20, mjSTAGE_NONE);
    bare_us += other.us();
  }
  const double steps = 1e6 * kCopies * static_cast<double>(state.iterations());
  state.counters["env_steps/s"] = steps / own_us;
  state.counters["mjb_steps/s"] = steps / bare_us;
  state.counters["share"] = bare_us / own_us;
}

#define MJARM_BENCH(name, ...)                      \
  BENCHMARK_CAPTURE(reach_steps, name, __VA_ARGS__) \
      ->Unit(benchmark::kMillisecond)               \
      ->UseRealTime()                               \
      ->Arg(1)                                      \
      ->Arg(2)                                      \
      ->MinTime(3)
MJARM_BENCH(gripper_open, ReachGripper::open);
MJARM_BENCH(as_shipped, ReachGripper::as_model);

}  // namespace
}  // namespace mjarm::rl
