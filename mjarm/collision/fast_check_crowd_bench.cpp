#include <benchmark/benchmark.h>

#include <cmath>
#include <limits>

#include "mjarm/collision/edge_check.hpp"
#include "mjarm/collision/problems_test.hpp"
#include "mjarm/collision/random_scene_test.hpp"

/// Needs MJARM_TEST_DATA (for the Panda's 59 spheres). How checks scale: the argument is the number
/// of boxes, each turned its own way, or of points, on the faces of 30 boxes. Half of the states
/// are random, half along edges of 1 rad, 16 each; `free` is the share of free ones.
namespace mjarm {
namespace {

/// Boxes in the reach of the arm, smaller ones where they are many, none at its base.
Obstacles boxes_round(Rng& rng, int count) {
  Obstacles out;
  const double size = 0.1 / std::cbrt(std::max(1.0, count / 10.0));
  while (std::ssize(out.solids) < count) {
    const Eigen::Vector3d p_W = testing::random_vector(rng, 1.1) + Eigen::Vector3d(0, 0, 0.3);
    if (p_W.norm() < 0.4 || p_W.norm() > 1.1) continue;
    const Eigen::Vector3d half(rng.uniform(0.3, 1), rng.uniform(0.3, 1), rng.uniform(0.3, 1));
    out.solids.push_back(
        {"", {p_W, from_euler(testing::random_vector(rng, 3))}, BoxShape{size * half}});
  }
  return out;
}

/// Points on the faces of boxes.
Obstacles points_round(Rng& rng, int count) {
  const Obstacles boxes = boxes_round(rng, 30);
  Obstacles out;
  out.clouds = {{"", {}, 0.005}};
  for (int i = 0; i < count; ++i) {
    const Obstacle& box = boxes.solids[rng.below(boxes.solids.size())];
    Eigen::Vector3d p = testing::random_vector(rng, 1);
    const auto axis = static_cast<Eigen::Index>(rng.below(3));
    p[axis] = p[axis] > 0 ? 1 : -1;
    const Eigen::Vector3d half = std::get<BoxShape>(box.shape).half;
    out.clouds[0].points_W.push_back(box.X_WO * p.cwiseProduct(half));
  }
  return out;
}

const FastRobot* bench_robot(benchmark::State& state) {
  static const FastRobot* robot = [] {
    const auto file = support::test_data_file("motionbenchmaker/mbm_panda_public.json.gz");
    if (!file) return static_cast<FastRobot*>(nullptr);
    const testing::PlanningProblems all = testing::read_problems(*file);
    return new FastRobot(FastRobot::create(all.arm, all.set).value());
  }();
  if (robot == nullptr) state.SkipWithError("MJARM_TEST_DATA is not set");
  return robot;
}

std::vector<double> states_of(const Arm& arm, Rng& rng) {
  std::vector<double> out;
  for (int k = 0; k < 1024; ++k) {
    const JointVec q = testing::random_q(arm, rng);
    out.insert(out.end(), q.data(), q.data() + q.size());
  }
  for (int k = 0; k < 64; ++k) {
    const JointVec q0 = testing::random_q(arm, rng);
    const JointVec way = testing::random_q(arm, rng) - q0;
    for (int i = 0; i < 16; ++i) {
      const JointVec q = q0 + way * (std::min(1.0, 1 / way.norm()) * i / 15);
      out.insert(out.end(), q.data(), q.data() + q.size());
    }
  }
  return out;
}

void check_states(benchmark::State& state, Obstacles (*world)(Rng&, int)) {
  const FastRobot* const robot = bench_robot(state);
  if (robot == nullptr) return;
  Rng rng(3);
  std::vector<FastChecker> checkers;
  for (int k = 0; k < 4; ++k) {
    checkers.push_back(
        FastChecker::create(*robot, world(rng, static_cast<int>(state.range(0)))).value());
  }
  const std::vector<double> rows = states_of(robot->arm(), rng);
  std::vector<std::uint8_t> free(rows.size() / 7);
  std::int64_t states = 0, found_free = 0;
  for (auto _ : state) {
    for (const FastChecker& checker : checkers) {
      checker.check(rows, free);
      states += std::ssize(free);
      for (const std::uint8_t one : free) found_free += one;
    }
  }
  state.SetItemsProcessed(states);
  state.counters["free"] = static_cast<double>(found_free) / static_cast<double>(states);
}

void fast_check_boxes(benchmark::State& state) { check_states(state, boxes_round); }
BENCHMARK(fast_check_boxes)->RangeMultiplier(10)->Range(1, 1000);

void fast_check_points(benchmark::State& state) { check_states(state, points_round); }
BENCHMARK(fast_check_points)->RangeMultiplier(10)->Range(1000, 100'000);

void make_checker(benchmark::State& state, Obstacles (*world)(Rng&, int)) {
  const FastRobot* const robot = bench_robot(state);
  if (robot == nullptr) return;
  Rng rng(4);
  const Obstacles obstacles = world(rng, static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(FastChecker::create(*robot, obstacles));
}

void fast_check_make_boxes(benchmark::State& state) { make_checker(state, boxes_round); }
BENCHMARK(fast_check_make_boxes)->RangeMultiplier(10)->Range(1, 1000);

void fast_check_make_points(benchmark::State& state) { make_checker(state, points_round); }
BENCHMARK(fast_check_make_points)->RangeMultiplier(10)->Range(1000, 100'000);

}  // namespace
}  // namespace mjarm
