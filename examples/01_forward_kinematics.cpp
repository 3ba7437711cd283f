// Load a robot, find its arm, and ask where the tool is.
#include <cstdio>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/robot.hpp"

int main() {
  const auto robot = mjarm::load_robot("ur5e");  // or the path of any MJCF or URDF file
  if (!robot) return std::fprintf(stderr, "%s\n", robot.error().what.c_str()), 1;
  const mjarm::Arm& arm = robot->arm;

  const mjarm::FkJacobian tool = mjarm::fk_jacobian(arm, mjarm::as_span(arm.home));
  const mjarm::Quat quat = mjarm::to_quat(tool.X_WT.R);
  std::printf("%s has %d joints; at home its %s is at (%.3f, %.3f, %.3f) m\n", arm.name.c_str(),
              arm.dof(), arm.tip.c_str(), tool.X_WT.p.x(), tool.X_WT.p.y(), tool.X_WT.p.z());
  std::printf("quaternion [w x y z] = [%.4f %.4f %.4f %.4f], manipulability %.4f\n", quat.w(),
              quat.x(), quat.y(), quat.z(), mjarm::manipulability(tool.J_W));
}
