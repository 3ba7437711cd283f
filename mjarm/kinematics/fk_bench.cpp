#include <benchmark/benchmark.h>

#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/fk_batch.hpp"

namespace mjarm {
namespace {

Arm arm_of(const benchmark::State& state) {
  return state.range(0) == 6 ? testing::ur5e() : testing::panda();
}

std::vector<JointVec> random_qs(const Arm& arm) {
  Rng rng(1);
  std::vector<JointVec> qs;
  for (int i = 0; i < 1024; ++i) qs.push_back(testing::random_q(arm, rng));
  return qs;
}

template <class Call>
void over_random_q(benchmark::State& state, Call call) {
  const Arm arm = arm_of(state);
  const std::vector<JointVec> qs = random_qs(arm);
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(call(arm, as_span(qs[i])));
    i = (i + 1) % qs.size();
  }
}

void fk_pose(benchmark::State& state) {
  over_random_q(state, [](const Arm& arm, std::span<const double> q) { return fk(arm, q); });
}
BENCHMARK(fk_pose)->Arg(6)->Arg(7);

void fk_with_jacobian(benchmark::State& state) {
  over_random_q(state,
                [](const Arm& arm, std::span<const double> q) { return fk_jacobian(arm, q); });
}
BENCHMARK(fk_with_jacobian)->Arg(6)->Arg(7);

void fk_manipulability(benchmark::State& state) {
  over_random_q(state, [](const Arm& arm, std::span<const double> q) {
    return manipulability(fk_jacobian(arm, q).J_W);
  });
}
BENCHMARK(fk_manipulability)->Arg(6)->Arg(7);

/// Many at a time; the time is that of one configuration.
template <class T, class X>
void batch(benchmark::State& state, std::vector<X>& out) {
  const Arm arm = arm_of(state);
  const Chain chain(arm);
  std::vector<T> rows;
  for (const JointVec& q : random_qs(arm)) rows.insert(rows.end(), q.begin(), q.end());
  for (auto _ : state) {
    fk_batch(chain, std::span<const T>(rows), std::span<X>(out));
    benchmark::DoNotOptimize(out.data());
  }
  state.counters["each"] = benchmark::Counter(
      1024, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void fk_batch_double(benchmark::State& state) {
  std::vector<Pose> X(1024);
  batch<double>(state, X);
}
BENCHMARK(fk_batch_double)->Arg(6)->Arg(7);

void fk_batch_float(benchmark::State& state) {
  std::vector<float> X(12 * 1024);
  batch<float>(state, X);
}
BENCHMARK(fk_batch_float)->Arg(6)->Arg(7);

}  // namespace
}  // namespace mjarm
