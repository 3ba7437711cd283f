// Joint values for a tool pose, and an honest reason where there are none.
#include <cstdio>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/model/robot.hpp"

int main() {
  const auto robot = mjarm::load_robot("ur5e");
  if (!robot) return std::fprintf(stderr, "%s\n", robot.error().what.c_str()), 1;
  const mjarm::Arm& arm = robot->arm;
  const mjarm::IkSolver ik(arm);

  mjarm::Pose goal;
  goal.p = {-0.13, 0.6, 0.1};
  goal.R = mjarm::from_euler({3.14, 0, 1.57});  // about the fixed axes x, y, z
  const auto solution = ik.solve(goal, mjarm::as_span(arm.home));
  if (!solution) return std::fprintf(stderr, "%s\n", describe(solution.error(), arm).c_str()), 1;
  std::printf("q =");
  for (const double q : solution->q) std::printf(" %.4f", q);
  std::printf("  (error %.1e m, %.1e rad)\n", solution->pos_err, solution->rot_err);

  goal.p = {0.0, 0.05, 0.5};  // too near the base axis for this arm
  const auto impossible = ik.solve(goal, mjarm::as_span(arm.home));
  if (impossible) return 1;
  std::printf("(0, 0.05, 0.5): %s\n", describe(impossible.error(), arm).c_str());
}
