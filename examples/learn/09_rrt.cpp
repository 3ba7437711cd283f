// A small RRT (S. LaValle, 1998) round a wall, beside the planner: are its paths free?
#include <algorithm>
#include <cstdio>
#include <vector>

#include "mjarm/collision/exact.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/planning/planning_world.hpp"

using namespace mjarm;

static std::vector<JointVec> rrt(ExactChecker& checker, const JointVec& start, const JointVec& goal,
                                 double step, Rng rng) {
  std::vector<JointVec> tree{start};
  std::vector<std::size_t> parent{0};
  while ((tree.back() - goal).norm() > 1e-6) {
    JointVec target = goal;
    const bool to_goal = rng.uniform() < 0.1;
    for (int i = 0; !to_goal && i < target.size(); ++i) {
      target[i] = rng.uniform(std::min(start[i], goal[i]) - 0.8, std::max(start[i], goal[i]) + 0.8);
    }
    const auto distance = [&](const JointVec& q) { return (q - target).norm(); };
    const auto nearest = std::ranges::min_element(tree, {}, distance);
    JointVec q = *nearest + (target - *nearest) * (step / std::max(distance(*nearest), step));
    if (!checker.is_free(as_span(q))) continue;  // the end of the edge; nobody looks between
    parent.push_back(static_cast<std::size_t>(nearest - tree.begin()));
    tree.push_back(q);
  }
  std::vector<JointVec> path{goal};
  for (std::size_t i = tree.size() - 1; i > 0; i = parent[i]) path.push_back(tree[parent[i]]);
  return path;
}

int main() {
  const auto robot = load_robot("universal_robots_ur5e/wall.xml");
  auto world = PlanningWorld::create(robot.value());
  const JointVec start{{1.9084, -1.2456, 1.9905, -2.3157, -1.5708, 3.4792}};
  const Pose behind{{-0.3, -0.45, 0.2}, from_euler({3.14159265, 0, 0})};
  const auto plan = world->plan(as_span(start), behind);
  if (!plan) return 1;
  ExactChecker checker(robot->model, robot->arm);
  std::vector<int> bad;
  for (const double step : {0.5, 0.1, 0.05}) {
    bad.push_back(0);
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const auto path = rrt(checker, start, plan->q.back(), step, Rng(seed));
      bool free = true;
      for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        for (double t = 0; t < 1; t += 0.05) {
          free = free && checker.is_free(as_span(JointVec(path[i] + (path[i + 1] - path[i]) * t)));
        }
      }
      bad.back() += free ? 0 : 1;
    }
    std::printf("RRT, steps of %.2f rad: %d of 20 go through something\n", step, bad.back());
  }
  std::printf("planner: %.2f rad, every edge proved free\n", plan->cost);
  return bad[0] > bad[1] ? 0 : 1;
}
