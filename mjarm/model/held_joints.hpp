#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// A joint that is not the arm's and has to be kept where it stands while the arm moves.
struct HeldJoint {
  std::string name;                     ///< "#ID" where it has none
  int qpos = -1;                        ///< first index in the model's qpos
  int dof = -1;                         ///< first index in the model's qvel
  int dofs = 1;                         ///< 1: hinge, slide; 3: ball; 6: free
  double damping = 0;                   ///< [N m s/rad or N s/m] viscous, >= 0
  std::optional<ArmActuator> actuator;  ///< that can keep it there; none: only a lock can
};

/// The joints of `model` that would fall or drift while `arm` alone is controlled: those of other
/// arms, torso, head, wheels, of fingers that are no Gripper, and the free joint of the arm's own
/// base. In the order of the model.
///
/// Not among them: the arm's joints and its gripper's. What is no robot's: free bodies that do not
/// carry the arm and all that hangs on them, joints in trees without any actuator (doors, drawers).
/// What hangs as its maker meant it: joints without an actuator that an equality, a tendon or a
/// loop of bodies couples, that have a spring, or that hang on the arm's last link.
[[nodiscard]] std::vector<HeldJoint> held_joints(const Model& model, const Arm& arm);

}  // namespace mjarm
