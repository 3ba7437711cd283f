#pragma once

#include <span>
#include <string>
#include <vector>

#include "mjarm/collision/contact_rules.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// What stands where beside an arm, and what the arm carries, at one moment of a plan.
struct SceneState {
  /// (nq,) [rad or m] where joints off the arm stand, gripper and free bodies included; empty:
  /// home_configuration().
  std::vector<double> qpos = {};
  std::vector<AttachedBody> attached = {};  ///< to the tool of the arm
};

/// The scene once the gripper has closed, the arm resting at `q`: the fingers go from where they
/// stand along the ways of their joints (and of joints that equality constraints couple to them)
/// and push free bodies before them, until something is between two of them, or between a finger
/// and the hand, with opposite normals; that is attached then, where the fingers have it. Geometry
/// alone, in steps of 1/200 of the way: no mass, no friction. A hand of linkages that close loops
/// (connect and weld constraints) goes as it does in a simulation where it touches nothing.
/// @param q       (dof,) [rad or m]
/// @param before  what is attached already stays so, and then the fingers stand.
/// @return bad_input for sizes that do not fit, rules that are not sound, or an arm without
/// gripper.
[[nodiscard]] Result<SceneState> close_gripper(const Model& model, const Arm& arm,
                                               std::span<const double> q, const SceneState& before);

/// The scene once the gripper has opened: the fingers are at the end of their way, and what was
/// attached stands where it was left.
[[nodiscard]] Result<SceneState> open_gripper(const Model& model, const Arm& arm,
                                              std::span<const double> q, const SceneState& before);

/// The same bodies in the frame of another tool of the same arm.
[[nodiscard]] std::vector<AttachedBody> attached_to(const Arm& other, const Arm& arm,
                                                    std::span<const AttachedBody> attached);

}  // namespace mjarm
