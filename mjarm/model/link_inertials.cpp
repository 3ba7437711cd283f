#include "mjarm/model/link_inertials.hpp"

#include "mjarm/model/moved_bodies.hpp"

namespace mjarm {

std::vector<Inertial> link_inertials(const Model& model, const Arm& arm) {
  std::vector<Inertial> out(static_cast<std::size_t>(arm.dof()));
  for (const MovedBody& body : moved_bodies(model, arm)) {
    Inertial& link = out[static_cast<std::size_t>(body.joint)];
    const Eigen::Vector3d& c = body.center_J;
    link.mass += body.mass;
    link.moment += body.mass * c;
    // Steiner's theorem.
    link.inertia += body.inertia_center_J + point_inertia(body.mass, c);
  }
  return out;
}

}  // namespace mjarm
