#include <benchmark/benchmark.h>

#include <stdexcept>

#include "mjarm/rl/ppo_trainer.hpp"
#include "mjarm/rl/toy_envs_test.hpp"

/// What training costs besides the environment: a task of the sizes of reach that does nothing.
namespace mjarm::rl {
namespace {

class IdleTask : public testing::ToyEnv {
 public:
  explicit IdleTask(int copies) : ToyEnv(copies, 24, 7, 100) {}

 private:
  void start(Rng& rng, std::span<float> observation) override {
    for (float& value : observation) value = static_cast<float>(rng.uniform());
  }
  bool advance(std::span<float> observation, std::span<const float> action,
               float& reward) override {
    for (std::size_t i = 0; i < action.size(); ++i) observation[i] += 0.01F * action[i];
    reward = -observation[0];
    return false;
  }
};

/// Arguments: threads, epochs. "collect" and "update" are the seconds of one step of one copy.
void iterate(benchmark::State& state) {
  IdleTask env(64);
  PpoOptions options;
  options.threads = static_cast<int>(state.range(0));
  options.epochs = static_cast<int>(state.range(1));
  auto trainer = PpoTrainer::create(env, options);
  if (!trainer) throw std::runtime_error(trainer.error().what);
  double collect_us = 0, update_us = 0;
  for (auto _ : state) {
    const auto report = trainer->iterate();
    if (!report) throw std::runtime_error(report.error().what);
    collect_us += report->collect_us;
    update_us += report->update_us;
  }
  const double steps = static_cast<double>(state.iterations()) * options.rollout_steps * 64;
  state.SetItemsProcessed(static_cast<std::int64_t>(steps));
  state.counters["collect"] = 1e-6 * collect_us / steps;
  state.counters["update"] = 1e-6 * update_us / steps;
}
BENCHMARK(iterate)
    ->Args({1, 6})
    ->Args({2, 6})
    ->Args({2, 10})
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace mjarm::rl
