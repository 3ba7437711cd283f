#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>

#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/kinematics/ik_all.hpp"
#include "mjarm/kinematics/track.hpp"

namespace mjarm {
namespace {

struct Problem {
  Pose X_WT;
  JointVec seed;
};

Arm ik_arm_of(const benchmark::State& state) {
  return state.range(0) == 6 ? testing::ur5e() : testing::panda();
}

/// Poses of random configurations; the seed is another one, or the same moved by `step` rad.
std::vector<Problem> problems(const Arm& arm, double step) {
  Rng rng(2);
  std::vector<Problem> out;
  for (int i = 0; i < 4096; ++i) {
    const JointVec q = testing::random_q(arm, rng);
    JointVec seed = testing::random_q(arm, rng);
    if (step > 0) seed = q + step * (seed - q).normalized();
    out.push_back({fk(arm, as_span(q)), seed});
  }
  return out;
}

/// Solves them in turn; besides the mean it shows the median, the 99th percentile and the share
/// solved.
void run(benchmark::State& state, double step) {
  using Clock = std::chrono::steady_clock;
  const Arm arm = ik_arm_of(state);
  const IkSolver ik(arm, {.closed_form = state.range(1) == 1});
  const std::vector<Problem> all = problems(arm, step);
  std::vector<double> us;
  std::size_t i = 0;
  double solved = 0;
  for (auto _ : state) {
    const auto start = Clock::now();
    const auto answer = ik.solve(all[i].X_WT, as_span(all[i].seed));
    us.push_back(std::chrono::duration<double, std::micro>(Clock::now() - start).count());
    solved += answer.has_value() ? 1 : 0;
    i = (i + 1) % all.size();
  }
  std::sort(us.begin(), us.end());
  state.counters["median_us"] = us[us.size() / 2];
  state.counters["p99_us"] = us[us.size() * 99 / 100];
  state.counters["solved"] = solved / static_cast<double>(us.size());
}

/// By the closed form (second argument 1) and by the numeric search alone (0).
void ik_random_seed(benchmark::State& state) { run(state, 0); }
BENCHMARK(ik_random_seed)->ArgsProduct({{6, 7}, {1, 0}});

void ik_near_seed(benchmark::State& state) { run(state, 0.02); }
BENCHMARK(ik_near_seed)->ArgsProduct({{6, 7}, {1, 0}});

void ik_tracked_path(benchmark::State& state) {
  const Arm arm = testing::ur5e();
  IkOptions options;
  options.max_step = 0.1;
  const IkSolver ik(arm, options);
  JointVec q = joint_vec(std::vector<double>{-1.57, -1.34, 2.0, -1.3, 1.55, 0});
  const Pose start = fk(arm, as_span(q));
  double phase = 0;
  for (auto _ : state) {
    phase += 1e-3;
    Pose X = start;
    X.p += Eigen::Vector3d(0.1 * std::cos(phase) - 0.1, 0.1 * std::sin(phase), 0);
    const auto answer = ik.solve(X, as_span(q));
    if (!answer) {
      state.SkipWithError("lost the path");
      break;
    }
    q = answer->q;
  }
}
BENCHMARK(ik_tracked_path);

void ik_servo_step(benchmark::State& state) {
  const Arm arm = ik_arm_of(state);
  const Tracker tracker(arm);
  const std::vector<Problem> all = problems(arm, 0.02);
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(tracker.step(all[i].X_WT, as_span(all[i].seed)));
    i = (i + 1) % all.size();
  }
}
BENCHMARK(ik_servo_step)->Arg(6)->Arg(7);

void ik_out_of_reach(benchmark::State& state) {
  const Arm arm = ik_arm_of(state);
  const IkSolver ik(arm);
  const Pose X_WT{{1.5, 0.3, 0.2}, Eigen::Matrix3d::Identity()};
  for (auto _ : state) benchmark::DoNotOptimize(ik.solve(X_WT, as_span(arm.home)));
}
BENCHMARK(ik_out_of_reach)->Arg(6)->Arg(7);

void ik_all_branches(benchmark::State& state) {
  const Arm arm = ik_arm_of(state);
  const IkSolver ik(arm);
  const std::vector<Problem> all = problems(arm, 0);
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(solve_all(ik, all[i].X_WT, as_span(all[i].seed)));
    i = (i + 1) % all.size();
  }
}
BENCHMARK(ik_all_branches)->Arg(6);

void ik_make_solver(benchmark::State& state) {
  const Arm arm = ik_arm_of(state);
  for (auto _ : state) benchmark::DoNotOptimize(IkSolver(arm));
}
BENCHMARK(ik_make_solver)->Arg(6)->Arg(7);

}  // namespace
}  // namespace mjarm
