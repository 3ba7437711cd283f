#include "mjarm/control/reference.hpp"

namespace mjarm {

StepReference hold(std::span<const double> q) {
  const JointVec here = joint_vec(q);
  return {here, here, here};
}

StepReference reference_at(const Trajectory& trajectory, double t, double timestep) {
  return {trajectory.at(t - timestep).q, trajectory.at(t).q, trajectory.at(t + timestep).q};
}

StepReference reference_at(std::span<const JointVec> q, std::size_t i) {
  return {q[i > 0 ? i - 1 : 0], q[i], q[i + 1]};
}

}  // namespace mjarm
