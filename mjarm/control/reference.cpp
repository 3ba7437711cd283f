#include "mjarm/control/reference.hpp"

namespace mjarm {

StepReference hold(std::span<const double> q) {
  const JointVec here = joint_vec(q);
  return {here, here, here};
}

StepReference reference_at(const Trajectory& trajectory, double t, double timestep) {
  return {trajectory.at(t - timestep).q, trajectory.at(t).q, trajectory.at(t + timestep).q};
}

}  // namespace mjarm
