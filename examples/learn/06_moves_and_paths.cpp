// Inverse kinematics at both ends and joints in between: how far the tool is off the straight line,
// and what cures it.
#include <cstdio>
#include <numbers>
#include <vector>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/trajectory/tool_motion.hpp"

namespace {

/// How far a pose is off the straight line of this program [mm]: y = -0.4, z = 0.3.
double off_line(const mjarm::Pose& X_WT) {
  return 1e3 * (X_WT.p - Eigen::Vector3d(X_WT.p.x(), -0.4, 0.3)).norm();
}

}  // namespace

int main() {
  const auto robot = mjarm::load_robot("ur5e");
  if (!robot) return std::fprintf(stderr, "%s\n", robot.error().what.c_str()), 1;
  const mjarm::Arm& arm = robot->arm;
  const mjarm::IkSolver ik(arm);
  const Eigen::Matrix3d down = mjarm::from_euler({std::numbers::pi, 0, 0});

  // Inverse kinematics at n + 1 points of the line, joint values interpolated in between.
  double one_move = 0;
  for (const int n : {1, 2, 4, 8, 16}) {
    double worst = 0;
    mjarm::JointVec before = arm.home;
    for (int k = 0; k <= n; ++k) {
      const auto q = ik.solve({{0.3 - 0.6 * k / n, -0.4, 0.3}, down}, mjarm::as_span(before));
      if (!q) return std::fprintf(stderr, "%s\n", describe(q.error(), arm).c_str()), 1;
      for (int i = 0; k > 0 && i <= 64; ++i) {
        const mjarm::JointVec between = before + i / 64.0 * (q->q - before);
        worst = std::max(worst, off_line(mjarm::fk(arm, mjarm::as_span(between))));
      }
      before = q->q;
    }
    if (n == 1) one_move = worst;
    std::printf("%2d joint moves: off the line by up to %.2f mm\n", n, worst);
  }

  const auto line = mjarm::Curve::line({{0.3, -0.4, 0.3}, down}, {{-0.3, -0.4, 0.3}, down});
  const auto motion = mjarm::plan_tool_motion(ik, *line, mjarm::as_span(arm.home));  // MoveL
  if (!motion) return std::fprintf(stderr, "%s\n", describe(motion.error(), arm).c_str()), 1;
  double straight = 0;
  for (double t = 0; t < motion->trajectory.duration(); t += 0.002) {
    const auto X_WT = mjarm::fk(arm, mjarm::as_span(motion->trajectory.at(t).q));
    straight = std::max(straight, off_line(X_WT));
  }
  std::printf("MoveL: %s\n", straight < 1e-3 ? "under 0.001 mm" : "off the line");
  return straight < 1e-3 && one_move > 99 ? 0 : 1;
}
