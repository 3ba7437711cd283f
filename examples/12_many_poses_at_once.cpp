// Joint values for a grid of tool poses on all cores, then a tool that is led after a moving
// target.
#include <algorithm>
#include <cstdio>
#include <numbers>
#include <vector>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/fk_batch.hpp"
#include "mjarm/kinematics/ik_batch.hpp"
#include "mjarm/kinematics/track.hpp"
#include "mjarm/model/robot.hpp"

int main() {
  const auto robot = mjarm::load_robot("ur5e");
  if (!robot) return std::fprintf(stderr, "%s\n", robot.error().what.c_str()), 1;
  const mjarm::Arm& arm = robot->arm;
  const auto ik = mjarm::IkSolver::create(arm, {.restarts = 20});
  if (!ik) return std::fprintf(stderr, "%s\n", ik.error().what.c_str()), 1;

  std::vector<mjarm::Pose> grid;
  for (int row = 0; row < 50; ++row) {
    for (int col = 0; col < 50; ++col) {
      grid.push_back({{0.3 + 0.01 * row, -0.25 + 0.01 * col, 0.2},
                      mjarm::from_euler({std::numbers::pi, 0, 0})});
    }
  }
  const auto answers = solve_batch(*ik, grid, mjarm::as_span(arm.home), {.threads = 0});
  std::vector<double> q;  // (solved, dof), row by row
  std::vector<std::size_t> solved;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (!answers[i]) continue;
    solved.push_back(i);
    q.insert(q.end(), answers[i]->q.begin(), answers[i]->q.end());
  }
  std::vector<mjarm::Pose> X_WT(solved.size());
  fk_batch(ik->chain(), q, X_WT);
  double worst = 0;  // [m]
  for (std::size_t k = 0; k < solved.size(); ++k) {
    worst = std::max(worst, (X_WT[k].p - grid[solved[k]].p).norm());
  }
  std::printf("%zu of %zu poses solved, at worst %.1e m off\n", solved.size(), grid.size(), worst);

  const mjarm::Tracker tracker(arm, {.dt = 0.01});
  mjarm::JointVec now = arm.home;
  mjarm::Pose target = mjarm::fk(arm, mjarm::as_span(now));
  double behind = 0;  // [m]
  for (int step = 0; step < 100; ++step) {
    target.p.z() -= 0.001;  // 0.1 m/s
    const mjarm::TrackStep next = tracker.step(target, mjarm::as_span(now));
    if (!next.ok) return std::fprintf(stderr, "step %d: no way on\n", step), 1;
    behind = std::max(behind, next.pos_err);
    now = next.q;
  }
  std::printf("followed the target for 1 s, at most %.1f mm behind\n", 1000 * behind);
}
