// Load a robot, find its arm, and ask where the tool is.
#include <cstdio>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/model/model.hpp"

int main() {
  const auto file = mjarm::find_model_file("ur5e");  // or the path of any MJCF or URDF file
  if (!file) return std::fprintf(stderr, "%s\n", file.error().what.c_str()), 1;
  const auto model = mjarm::Model::load(*file);
  if (!model) return std::fprintf(stderr, "%s\n", model.error().what.c_str()), 1;
  const auto arm = mjarm::find_arm(*model);
  if (!arm) return std::fprintf(stderr, "%s\n", arm.error().what.c_str()), 1;

  const mjarm::FkJacobian tool = mjarm::fk_jacobian(*arm, mjarm::view(arm->home));
  const mjarm::Quat quat = mjarm::to_quat(tool.X_WT.R);
  std::printf("%s has %d joints; at home its %s is at (%.3f, %.3f, %.3f) m\n", arm->name.c_str(),
              arm->dof(), arm->tip.c_str(), tool.X_WT.p.x(), tool.X_WT.p.y(), tool.X_WT.p.z());
  std::printf("quaternion [w x y z] = [%.4f %.4f %.4f %.4f], manipulability %.4f\n", quat.w(),
              quat.x(), quat.y(), quat.z(), mjarm::manipulability(tool.J_W));
}
