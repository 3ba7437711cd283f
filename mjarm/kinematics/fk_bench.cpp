#include <benchmark/benchmark.h>

#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/link_chain.hpp"

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
    benchmark::DoNotOptimize(call(arm, view(qs[i])));
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

/// The same of a LinkChain, as inner loops call it.
void fk_link_chain_jacobian(benchmark::State& state) {
  const LinkChain chain{Chain(arm_of(state))};
  over_random_q(state,
                [&](const Arm&, std::span<const double> q) { return fk_jacobian(chain, q); });
}
BENCHMARK(fk_link_chain_jacobian)->Arg(6)->Arg(7);

void fk_manipulability(benchmark::State& state) {
  over_random_q(state, [](const Arm& arm, std::span<const double> q) {
    return manipulability(fk_jacobian(arm, q).J_W);
  });
}
BENCHMARK(fk_manipulability)->Arg(6)->Arg(7);

}  // namespace
}  // namespace mjarm
