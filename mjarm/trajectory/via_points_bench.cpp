#include <benchmark/benchmark.h>

#include "mjarm/core/rng.hpp"
#include "mjarm/trajectory/via_points.hpp"

namespace mjarm {
namespace {

/// Random waypoints of a seven-axis arm; the argument is their number.
void via_points(benchmark::State& state) {
  constexpr Eigen::Index kDof = 7;
  JointLimits limits;
  limits.velocity = JointVec::Constant(kDof, 2.5);
  limits.acceleration = JointVec::Constant(kDof, 10);
  limits.jerk = JointVec::Constant(kDof, 1000);
  Rng rng(1);
  std::vector<std::vector<JointVec>> cases(32);
  for (std::vector<JointVec>& points : cases) {
    points.push_back(JointVec::Zero(kDof));
    while (static_cast<long>(points.size()) < state.range(0)) {
      JointVec q = points.back();
      for (double& x : q) x += rng.uniform(-0.6, 0.6);
      points.push_back(q);
    }
  }
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(time_via_points(cases[i], limits));
    i = (i + 1) % cases.size();
  }
  state.SetComplexityN(state.range(0));
}
BENCHMARK(via_points)->Arg(3)->Arg(10)->Arg(50)->Arg(200)->Complexity(benchmark::oN);

}  // namespace
}  // namespace mjarm
