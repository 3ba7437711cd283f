#pragma once

#include <span>
#include <vector>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/dynamics.hpp"

namespace mjarm {

/// Torques of an arm alone, while every other joint of its model stands still as at the start.
/// Owns its scratch memory: one a thread.
class ArmDynamics {
 public:
  ArmDynamics(const Model& model, const Arm& arm);

  /// Torque that the arm's actuators must give, shape (dof,) [N m or N]: inertia, Coriolis forces,
  /// gravity, springs and damping, with the whole dry friction against every joint that moves (what
  /// MuJoCo's soft friction comes to once it slips). No contact, no joint stops.
  /// @param q,v,a  shape (dof,).
  [[nodiscard]] JointVec inverse(const JointVec& q, const JointVec& v, const JointVec& a);

 private:
  Dynamics dynamics_;
  std::vector<int> qpos_, dof_;                  ///< the arm's entries of the full vectors
  JointVec friction_;                            ///< [N m or N] dry, >= 0
  std::vector<double> position_;                 ///< (nq,)
  std::vector<double> velocity_, acceleration_;  ///< (nv,)
};

}  // namespace mjarm
