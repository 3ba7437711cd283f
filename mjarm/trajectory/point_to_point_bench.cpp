#include <benchmark/benchmark.h>

#include <vector>

#include "mjarm/core/rng.hpp"
#include "mjarm/trajectory/point_to_point.hpp"

namespace mjarm {
namespace {

JointVec random_vec(Rng& rng, Eigen::Index dof, double size) {
  JointVec v(dof);
  for (double& x : v) x = rng.uniform(-size, size);
  return v;
}

/// Limits like those of an arm, and 1024 problems within them; all at rest or none.
void solve(benchmark::State& state, bool rest) {
  Rng rng(1);
  const Eigen::Index dof = state.range(0);
  const JointVec ones = JointVec::Ones(dof);
  const JointLimits limits{{}, {}, 3 * ones, 5 * ones, 100 * ones, {}, {}};
  std::vector<std::pair<JointState, JointState>> problems;
  for (int i = 0; i < 1024; ++i) {
    const double v = rest ? 0 : 2.5, a = rest ? 0 : 4;
    problems.push_back({{random_vec(rng, dof, 3), random_vec(rng, dof, v), random_vec(rng, dof, a)},
                        {random_vec(rng, dof, 3), random_vec(rng, dof, v), 0 * ones}});
  }
  std::size_t i = 0;
  for (auto _ : state) {
    const auto motion = PointToPoint::solve(problems[i].first, problems[i].second, limits);
    benchmark::DoNotOptimize(motion.has_value());
    i = (i + 1) % problems.size();
  }
}

void point_to_point_rest(benchmark::State& state) { solve(state, true); }
BENCHMARK(point_to_point_rest)->Arg(6)->Arg(7);

void point_to_point_state(benchmark::State& state) { solve(state, false); }
BENCHMARK(point_to_point_state)->Arg(6)->Arg(7);

void point_to_point_sample(benchmark::State& state) {
  const JointVec ones = JointVec::Ones(7);
  const JointLimits limits{{}, {}, 3 * ones, 5 * ones, 100 * ones, {}, {}};
  const auto motion =
      PointToPoint::solve({0 * ones, 0 * ones, 0 * ones}, {ones, 0 * ones, 0 * ones}, limits);
  double t = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(motion->at(t));
    t = t < motion->duration() ? t + 0.001 : 0;
  }
}
BENCHMARK(point_to_point_sample);

}  // namespace
}  // namespace mjarm
