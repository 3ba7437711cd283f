#pragma once

#include <span>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// How far each joint of a pure position servo hangs below its command when it rests at `qpos`:
/// (torque of gravity and springs) / (position stiffness) [rad or m], shape (dof,), in the
/// direction command - position. 0 for joints without a servo.
/// @param qpos  full state of the model, (nq,).
[[nodiscard]] JointVec static_sag(const Model& model, const Arm& arm, std::span<const double> qpos);

}  // namespace mjarm
