#pragma once

#include <string>
#include <vector>

#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm::session {

/// What a page needs to solve the kinematics of an arm by itself (web/src/arm_ik.js): of each joint
/// its name, its places in qpos and qvel, `hinge` or `slide`, X_PJ, axis and limits (null: none);
/// X_JT, the home position, and the bodies that the arm moves. Numbers read back as the same
/// doubles.
///
/// A frame is its position [m], then the columns of its rotation; a body is its number, the joint
/// that moves it, and X_JB as x y z [m], w x y z: those of a gripper as the model starts.
/// @param arm  of `model`
[[nodiscard]] std::string arm_json(const Model& model, const Arm& arm);
/// The same without bodies.
[[nodiscard]] std::string arm_json(const Arm& arm);
/// Places of the joints of an arm in qvel, shape (dof,).
[[nodiscard]] std::vector<int> dofs_of(const Arm& arm);

}  // namespace mjarm::session
