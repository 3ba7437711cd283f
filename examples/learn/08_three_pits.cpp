// Three pits of a naive follower: no answer, a flip, a singularity; and what mjarm makes of each.
#include <cstdio>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/trajectory/tool_motion.hpp"

using namespace mjarm;

/// Damped least squares; gives back whatever it has in the end.
static JointVec least_squares(const Arm& arm, const Pose& goal) {
  JointVec q = arm.home;
  for (int i = 0; i < 300; ++i) {
    const auto [X_WT, J_W] = fk_jacobian(arm, as_span(q));
    Eigen::Vector<double, 6> e;
    e << goal.p - X_WT.p, rotation_log(goal.R * X_WT.R.transpose());
    const Eigen::Matrix<double, 6, 6> JJ = J_W * J_W.transpose();
    q += J_W.transpose() * (JJ + 0.1 * JJ.Identity()).ldlt().solve(e);
  }
  return q;
}

/// The largest step of any joint [rad], always with the answer nearest to the one before.
static double largest_step(const IkSolver& ik, const Curve& line, JointVec q) {
  double largest = 0;
  for (int k = 0; k <= 300; ++k) {
    const auto next = ik.solve(line.at(line.end() * k / 300), as_span(q));
    if (!next) return 0;
    if (k > 0) largest = std::max(largest, (next->q - q).cwiseAbs().maxCoeff());
    q = next->q;
  }
  return largest;
}

int main() {
  const auto robot = load_robot("ur5e");
  if (!robot) return std::fprintf(stderr, "%s\n", robot.error().what.c_str()), 1;
  const Arm& arm = robot->arm;
  const IkSolver ik(arm);
  const Pose far{{-0.134, 1.0, 0.2}, fk(arm, as_span(arm.home)).R};
  const double off = (fk(arm, as_span(least_squares(arm, far))).p - far.p).norm();
  const auto none = ik.solve(far, as_span(arm.home));
  std::printf("1 no answer: least squares has one, %.0f mm off\n", 1e3 * off);
  std::printf("  mjarm: %s\n", none ? "has one" : describe(none.error(), arm).c_str());
  const Eigen::Matrix3d down = from_euler({3.14159265, 0, 0});
  const auto level = Curve::line({{-0.1, -0.4, 0.5}, down}, {{0.6, -0.4, 0.5}, down});
  const Eigen::Matrix3d ahead = from_euler({0, 1.60570291, 0});  // 92 degrees
  const auto past = Curve::line({{-0.25, -0.45, 0.45}, ahead}, {{0.35, -0.45, 0.45}, ahead});
  const auto flip = plan_tool_motion(ik, *level, as_span(arm.home));
  const auto slow = plan_tool_motion(ik, *past, as_span(arm.home));
  if (!flip || !slow || slow->dips.empty()) return 1;
  const double jump = largest_step(ik, *level, arm.home);
  const double speed = largest_step(ik, *past, slow->path.q.front()) / 0.008;
  std::printf("2 flip: a joint jumps by %.2f rad\n", jump);
  std::printf("  mjarm: steps of %.4f rad\n", flip->path.max_step());
  std::printf("3 singularity: %.1f rad/s at 0.25 m/s\n", speed);
  std::printf("  mjarm: %s\n", describe(slow->dips[0], arm).c_str());
  return !none && off > 0.09 && jump > 2.6 && speed > 15 ? 0 : 1;
}
